/* The attributes of a class, ((type, name, default, flags, "documentation")) each, as one list that a visitor is taken through:
   every use of the list (Python properties, dictionary, saving) is a function here, none is written out per class. */
#pragma once
#include <boost/python.hpp>
#include <boost/preprocessor.hpp>
#include <boost/python/raw_function.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/shared_ptr.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace yade {

namespace Attr {
	// readonly: Python cannot assign; triggerPostLoad: assigning from Python calls callPostLoad; hidden: Python doesn't see it.
	enum flags { readonly = 2, triggerPostLoad = 4, hidden = 8 };
	constexpr int join(int given = 0) { return given; } // flags may be left empty
} // namespace Attr

namespace attributes {

	template <auto Member, int Flags> struct Attribute {
		static constexpr auto member = Member;
		static constexpr int flags = Flags;
		const char* name;
		const char* documentation;
	};

	// The default may be left empty. Not T(value) written out: unsigned int(0) is no expression.
	template <class T, class... Values> T initial(Values&&... values) { return T(std::forward<Values>(values)...); }

	template <class T> void assign(T& attribute, const boost::python::object& value) { attribute = boost::python::extract<T>(value)(); }

	template <class Class> bool setByName(Class& self, const std::string& key, const boost::python::object& value)
	{
		bool found = false;
		Class::visitAttributes([&](auto attribute) {
			if (found || key != attribute.name) return;
			assign(self.*decltype(attribute)::member, value);
			found = true;
		});
		return found;
	}

	template <class Class> void addToDict(const Class& self, boost::python::dict& dict)
	{
		Class::visitAttributes([&](auto attribute) {
			using A = decltype(attribute);
			if constexpr (!(A::flags & Attr::hidden)) dict[attribute.name] = boost::python::object(self.*A::member);
		});
	}

	template <class Archive, class Class> void serialize(Archive& archive, Class& self)
	{
		Class::visitAttributes([&](auto attribute) {
			archive& boost::serialization::make_nvp(attribute.name, self.*decltype(attribute)::member);
		});
	}

	// By value: YADE's converters for vectors are already there, references into an object would outlive it.
	template <class Class, auto Member> boost::python::object get(const Class& self) { return boost::python::object(self.*Member); }

	template <class Class, auto Member, bool callPostLoad> void set(Class& self, const boost::python::object& value)
	{
		const auto before = self.*Member;
		assign(self.*Member, value);
		if (!callPostLoad) return;
		try {
			self.callPostLoad();
		} catch (...) { // a refused value is not kept
			self.*Member = before;
			throw;
		}
	}

	template <class Class, class PythonClass> void addProperties(PythonClass& pythonClass)
	{
		using Getter = boost::python::object (*)(const Class&);
		using Setter = void (*)(Class&, const boost::python::object&);
		Class::visitAttributes([&](auto attribute) {
			using A = decltype(attribute);
			if constexpr (A::flags & Attr::hidden) return;
			const Getter getter = &get<Class, A::member>;
			const Setter setter = &set<Class, A::member, bool(A::flags & Attr::triggerPostLoad)>;
			if constexpr (bool(A::flags & Attr::readonly))
				pythonClass.add_property(attribute.name, getter, attribute.documentation);
			else
				pythonClass.add_property(attribute.name, getter, setter, attribute.documentation);
		});
	}

	// YADE's objects are made from keywords only, except where a class takes its positional arguments itself (pyHandleCustomCtorArgs).
	template <class T> boost::shared_ptr<T> construct(boost::python::tuple positional, boost::python::dict named)
	{
		boost::shared_ptr<T> instance(new T);
		instance->pyHandleCustomCtorArgs(positional, named);
		if (boost::python::len(positional) > 0)
			throw std::runtime_error(instance->getClassName() + ": takes attributes by name only, " + instance->getClassName()
			        + "(attribute=value, ...)");
		if (boost::python::len(named) > 0) instance->pyUpdateAttrs(named);
		return instance;
	}

	template <class T> boost::python::object initialize(boost::python::tuple arguments, boost::python::dict named)
	{
		const boost::python::object constructor = boost::python::make_constructor(&construct<T>);
		return constructor(boost::python::object(arguments[0]), boost::python::tuple(arguments.slice(1, boost::python::_)), named);
	}

} // namespace attributes
} // namespace yade

#define YADE_INTERFACE_TYPE_(attribute) BOOST_PP_TUPLE_ELEM(5, 0, attribute)
#define YADE_INTERFACE_NAME_(attribute) BOOST_PP_TUPLE_ELEM(5, 1, attribute)
#define YADE_INTERFACE_DEFAULT_(attribute) BOOST_PP_TUPLE_ELEM(5, 2, attribute)
#define YADE_INTERFACE_FLAGS_(attribute) BOOST_PP_TUPLE_ELEM(5, 3, attribute)
#define YADE_INTERFACE_DOC_(attribute) BOOST_PP_TUPLE_ELEM(5, 4, attribute)

#define YADE_INTERFACE_DECLARE_(r, data, a)                                                                                                \
	YADE_INTERFACE_TYPE_(a) YADE_INTERFACE_NAME_(a) = ::yade::attributes::initial<YADE_INTERFACE_TYPE_(a)>(YADE_INTERFACE_DEFAULT_(a));

// The two roles after the text are those that YADE's documentation shows.
#define YADE_INTERFACE_VISIT_(r, Class, a)                                                                                                 \
	visit(::yade::attributes::Attribute<&Class::YADE_INTERFACE_NAME_(a), ::yade::Attr::join(YADE_INTERFACE_FLAGS_(a))> {               \
	        BOOST_PP_STRINGIZE(YADE_INTERFACE_NAME_(a)),                                                                               \
	                YADE_INTERFACE_DOC_(a) " :ydefault:`" BOOST_PP_STRINGIZE(YADE_INTERFACE_DEFAULT_(a)) "` :yattrtype:`" BOOST_PP_STRINGIZE(YADE_INTERFACE_TYPE_(a)) "`" });

#define YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(Class, Base, doc, attributeList, constructor, pythonExtras)                                      \
public:                                                                                                                                    \
	BOOST_PP_SEQ_FOR_EACH(YADE_INTERFACE_DECLARE_, ~, attributeList)                                                                   \
	Class() { constructor; }                                                                                                           \
	template <class Visitor> static void visitAttributes(Visitor&& visit)                                                              \
	{                                                                                                                                  \
		(void)visit;                                                                                                               \
		BOOST_PP_SEQ_FOR_EACH(YADE_INTERFACE_VISIT_, Class, attributeList)                                                         \
	}                                                                                                                                  \
	std::string getClassName() const override { return #Class; }                                                                       \
	std::string getBaseClassName(unsigned int i = 0) const override { return i == 0 ? #Base : ""; }                                    \
	int getBaseClassNumber() const override { return 1; }                                                                              \
	void pySetAttr(const std::string& key, const boost::python::object& value) override                                                \
	{                                                                                                                                  \
		if (!::yade::attributes::setByName<Class>(*this, key, value)) Base::pySetAttr(key, value);                                 \
	}                                                                                                                                  \
	boost::python::dict pyDict() const override                                                                                        \
	{                                                                                                                                  \
		boost::python::dict all;                                                                                                   \
		::yade::attributes::addToDict<Class>(*this, all);                                                                          \
		all.update(Base::pyDict());                                                                                                \
		return all;                                                                                                                \
	}                                                                                                                                  \
	void callPostLoad() override                                                                                                       \
	{                                                                                                                                  \
		Base::callPostLoad();                                                                                                      \
		postLoad(*this);                                                                                                           \
	}                                                                                                                                  \
	void pyRegisterClass(boost::python::object yadeScope) override                                                                     \
	{                                                                                                                                  \
		checkPyClassRegistersItself(#Class);                                                                                       \
		const boost::python::scope inside(yadeScope);                                                                              \
		const boost::python::docstring_options show(true, true, false);                                                            \
		boost::python::class_<Class, boost::shared_ptr<Class>, boost::python::bases<Base>, boost::noncopyable> pythonClass(        \
		        #Class, doc, boost::python::no_init);                                                                              \
		pythonClass.def("__init__", boost::python::raw_function(&::yade::attributes::initialize<Class>, 1));                       \
		::yade::attributes::addProperties<Class>(pythonClass);                                                                     \
		(void)pythonClass pythonExtras;                                                                                            \
	}                                                                                                                                  \
                                                                                                                                           \
private:                                                                                                                                   \
	friend class boost::serialization::access;                                                                                         \
	template <class Archive> void serialize(Archive& archive, const unsigned int)                                                      \
	{                                                                                                                                  \
		if (Archive::is_saving::value) preSave(*this);                                                                             \
		archive& boost::serialization::make_nvp(#Base, boost::serialization::base_object<Base>(*this));                            \
		::yade::attributes::serialize(archive, *this);                                                                             \
		if (Archive::is_saving::value) postSave(*this);                                                                            \
		if (Archive::is_loading::value) postLoad(*this); /* O.load doesn't call callPostLoad() of a plugin's classes */            \
	}                                                                                                                                  \
                                                                                                                                           \
public:                                                                                                                                    \
	static_assert(true, "")
