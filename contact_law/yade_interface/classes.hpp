/* How a class becomes one of YADE's: its numbers, the factory that knows it by name, and the macros by which it declares itself: one list of
 * attributes, from which follow members with defaults, Python properties with documentation, the dictionary that pickling uses, and saving
 * and loading. */
#pragma once
// Eigen changes its layouts with these definitions, so they may neither be forgotten nor differ between files: State would be larger.
#if !defined(EIGEN_DONT_VECTORIZE) || !defined(EIGEN_DONT_ALIGN) || !defined(EIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT)
#error "a file that sees a YADE type must be compiled with -DEIGEN_DONT_VECTORIZE -DEIGEN_DONT_ALIGN -DEIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT"
#endif
#include <boost/python.hpp> // first: Python.h wants to be
#include <Eigen/Core>
#include <Eigen/Geometry>
// BOOST_CLASS_EXPORT_* makes code for the archives that were included before it: these four are all that O.save, O.load and their memory slots use.
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/enable_shared_from_this.hpp>
#include <boost/preprocessor.hpp>
#include <boost/python/raw_function.hpp>
#include <boost/scoped_ptr.hpp>
#include <boost/serialization/base_object.hpp>
#include <boost/serialization/export.hpp>
#include <boost/serialization/is_bitwise_serializable.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <boost/shared_ptr.hpp>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// ---- numbers and vectors as YADE has them ----

#define YADE_CAST static_cast

// The one object of a class, in libyade, which exports instance(). Global, not in namespace yade: its mangled name says so.
template <class T> class Singleton {
public:
	static T& instance();
};

namespace yade {

using boost::shared_ptr;
using std::string;

using Real = double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Vector3i = Eigen::Matrix<int, 3, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;
using Quaternionr = Eigen::Quaternion<Real>;

template <class Scalar> struct Se3 {
	Eigen::Matrix<Scalar, 3, 1> position;
	Eigen::Quaternion<Scalar> orientation;
};
using Se3r = Se3<Real>;

// ---- the factory ----

// What YADE makes by class name.
class Factorable : public boost::enable_shared_from_this<Factorable> {
public:
	Factorable() {}
	virtual ~Factorable();
	virtual std::string getBaseClassName(unsigned int = 0) const;
	virtual int getBaseClassNumber() const;
	virtual std::string getClassName() const;
};

// Only these two functions are called: the object's layout doesn't matter here.
class ClassFactory : public Singleton<ClassFactory> {
public:
	bool registerFactorable(
	        std::string name, Factorable* (*create)(), shared_ptr<Factorable> (*createShared)(), void* (*createPureCustom)());
	void registerPluginClasses(const char* fileAndClasses[]);
};

namespace factory {
	template <class T> Factorable* create() { return new T; }
	template <class T> shared_ptr<Factorable> createShared() { return shared_ptr<Factorable>(new T); }
	template <class T> void* createPureCustom() { return new T; }
	template <class T> void add(const char* name)
	{
		ClassFactory::instance().registerFactorable(name, create<T>, createShared<T>, createPureCustom<T>);
	}
	bool isDescribedYade(); // plugin.cpp
} // namespace factory

// Classes that functors are chosen by carry a number each. The order of the virtual functions is that of YADE's tables.
class Indexable {
public:
	virtual void incrementMaxCurrentlyUsedClassIndexOfKin() = 0;
	virtual int& modifyClassIndex() = 0;
	Indexable() {}
	virtual ~Indexable() {}
	virtual const int& getClassIndex() const = 0;
	virtual const int& getBaseClassIndex(int depth) const = 0;
	virtual const int& getMaxCurrentlyUsedClassIndexOfKin() const = 0;

protected:
	void createIndex(); // exported by libpkg_common; every class below the topmost one calls it in its own constructor
};

/* ---- the attributes of a class, ((type, name, default, flags, "documentation")) each, as one list that a visitor is taken through: every use
 * of the list (Python properties, dictionary, saving) is a function here, none is written out per class ---- */

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

// YADE marks it so; an archive written with another mark is not read back.
BOOST_IS_BITWISE_SERIALIZABLE(yade::Vector3r)

// The names become XML tags, and YADE's own libraries hold a function of the same name: it must do the same.
namespace boost {
namespace serialization {
	template <class Archive> void serialize(Archive& archive, yade::Vector3r& v, const unsigned int)
	{
		archive& make_nvp("x", v[0]);
		archive& make_nvp("y", v[1]);
		archive& make_nvp("z", v[2]);
	}
} // namespace serialization
} // namespace boost

// ---- the macros by which a class declares itself ----

#define YADE_INTERFACE_TYPE_(attribute) BOOST_PP_TUPLE_ELEM(5, 0, attribute)
#define YADE_INTERFACE_NAME_(attribute) BOOST_PP_TUPLE_ELEM(5, 1, attribute)
#define YADE_INTERFACE_DEFAULT_(attribute) BOOST_PP_TUPLE_ELEM(5, 2, attribute)

#define YADE_INTERFACE_DECLARE_(r, data, a)                                                                                                \
	YADE_INTERFACE_TYPE_(a) YADE_INTERFACE_NAME_(a) = ::yade::attributes::initial<YADE_INTERFACE_TYPE_(a)>(YADE_INTERFACE_DEFAULT_(a));

// The two roles after the text are those that YADE's documentation shows.
#define YADE_INTERFACE_VISIT_(r, Class, a)                                                                                                 \
	visit(::yade::attributes::Attribute<&Class::YADE_INTERFACE_NAME_(a), ::yade::Attr::join(BOOST_PP_TUPLE_ELEM(5, 3, a))> {           \
	        BOOST_PP_STRINGIZE(YADE_INTERFACE_NAME_(a)),                                                                               \
	                BOOST_PP_TUPLE_ELEM(5, 4, a) " :ydefault:`" BOOST_PP_STRINGIZE(YADE_INTERFACE_DEFAULT_(a)) "` :yattrtype:`" BOOST_PP_STRINGIZE(YADE_INTERFACE_TYPE_(a)) "`" });

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

// The topmost class of a kin: all five are exported by YADE's libraries. (Declared here in the order in which they stand in the main table.)
#define REGISTER_INDEX_COUNTER(SomeClass)                                                                                                  \
public:                                                                                                                                    \
	int& modifyClassIndex() override;                                                                                                  \
	const int& getClassIndex() const override;                                                                                         \
	const int& getBaseClassIndex(int) const override;                                                                                  \
	const int& getMaxCurrentlyUsedClassIndexOfKin() const override;                                                                    \
	void incrementMaxCurrentlyUsedClassIndexOfKin() override

// A class of the plugin.
#define REGISTER_CLASS_INDEX(SomeClass, BaseClass)                                                                                         \
private:                                                                                                                                   \
	inline static int classIndex = -1;                                                                                                 \
                                                                                                                                           \
public:                                                                                                                                    \
	int& modifyClassIndex() override { return classIndex; }                                                                            \
	const int& getClassIndex() const override { return classIndex; }                                                                   \
	const int& getBaseClassIndex(int depth) const override                                                                             \
	{                                                                                                                                  \
		static const boost::scoped_ptr<BaseClass> base(new BaseClass);                                                             \
		return depth == 1 ? base->getClassIndex() : base->getBaseClassIndex(depth - 1);                                            \
	}

#define YADE_INTERFACE_ADD_(r, data, className) ::yade::factory::add<className>(BOOST_PP_STRINGIZE(className));
#define YADE_INTERFACE_NAME_OF_(r, data, className) BOOST_PP_STRINGIZE(className),
#define YADE_INTERFACE_EXPORT_(r, data, className)                                                                                         \
	}                                                                                                                                  \
	BOOST_CLASS_EXPORT_IMPLEMENT(yade::className)                                                                                      \
	namespace yade {

/* Stands in the .cpp file of the classes, inside namespace yade (left for a moment: Boost's macros must stand outside of every namespace).
 * YADE makes an object of every class that is registered, so nothing is when another YADE runs than the one this was compiled for. */
#define YADE_PLUGIN(classes)                                                                                                               \
	namespace {                                                                                                                        \
		__attribute__((constructor)) void registerClasses()                                                                        \
		{                                                                                                                          \
			if (!::yade::factory::isDescribedYade()) return;                                                                   \
			BOOST_PP_SEQ_FOR_EACH(YADE_INTERFACE_ADD_, ~, classes)                                                             \
			const char* fileAndClasses[] = { __FILE__, BOOST_PP_SEQ_FOR_EACH(YADE_INTERFACE_NAME_OF_, ~, classes) nullptr };   \
			::yade::ClassFactory::instance().registerPluginClasses(fileAndClasses);                                            \
		}                                                                                                                          \
	}                                                                                                                                  \
	BOOST_PP_SEQ_FOR_EACH(YADE_INTERFACE_EXPORT_, ~, classes)                                                                          \
	static_assert(true, "")

/* ---- Serializable, the root of all classes that Python sees and O.save writes ----

   Saving a class saves its base first. The bases' own serialize functions are not exported by YADE's libraries; what is exported, for each base and each
   archive, are the functions one layer up, oserializer::save_object_data and iserializer::load_object_data: exactly those are linked to.
   ("extern template class" would claim more than is exported, and fail to link without optimisation.) */
// in the class
#define SAVED_BY_YADE_MEMBER                                                                                                               \
private:                                                                                                                                   \
	friend class boost::serialization::access;                                                                                         \
	template <class Archive> void serialize(Archive&, unsigned int);

#define SAVED_BY_YADE_ARCHIVE_(format, Class)                                                                                              \
	extern template void boost::archive::detail::oserializer<boost::archive::BOOST_PP_CAT(format, _oarchive),                          \
	        yade::Class>::save_object_data(boost::archive::detail::basic_oarchive&, const void*) const;                                \
	extern template void boost::archive::detail::iserializer<boost::archive::BOOST_PP_CAT(format, _iarchive),                          \
	        yade::Class>::load_object_data(boost::archive::detail::basic_iarchive&, void*, unsigned int) const;

// after the class, outside of every namespace
#define SAVED_BY_YADE(Class)                                                                                                               \
	BOOST_CLASS_EXPORT_KEY(yade::Class)                                                                                                \
	SAVED_BY_YADE_ARCHIVE_(xml, Class)                                                                                                 \
	SAVED_BY_YADE_ARCHIVE_(binary, Class)

/* What every YADE class overrides. All are exported by YADE's libraries, so there are no bodies; the first of them also tells the compiler
   that the class's virtual table is elsewhere. */
#define YADE_INTERFACE_OVERRIDES_(Class)                                                                                                   \
public:                                                                                                                                    \
	~Class() override;                                                                                                                 \
	std::string getBaseClassName(unsigned int = 0) const override;                                                                     \
	int getBaseClassNumber() const override;                                                                                           \
	std::string getClassName() const override;                                                                                         \
	void pySetAttr(const std::string& key, const boost::python::object& value) override;                                               \
	boost::python::dict pyDict() const override;                                                                                       \
	void callPostLoad() override;                                                                                                      \
	void pyRegisterClass(boost::python::object) override;                                                                              \
	SAVED_BY_YADE_MEMBER                                                                                                               \
public:
// The second level of indexed classes (ElastMat, Sphere, NormShearPhys, ...).
#define YADE_INTERFACE_INDEX_OVERRIDES_                                                                                                    \
	int& modifyClassIndex() override;                                                                                                  \
	const int& getClassIndex() const override;                                                                                         \
	const int& getBaseClassIndex(int depth) const override;

namespace yade {

namespace py = ::boost::python;

class Serializable : public Factorable {
public:
	Serializable() {}
	~Serializable() override;
	std::string getBaseClassName(unsigned int = 0) const override;
	int getBaseClassNumber() const override;
	std::string getClassName() const override;
	virtual void pySetAttr(const std::string& key, const boost::python::object& value);
	virtual boost::python::dict pyDict() const;
	virtual boost::python::dict pyDictCustom() const;
	virtual void callPostLoad();
	virtual void checkPyClassRegistersItself(const std::string& className) const;
	virtual void pyRegisterClass(boost::python::object scope);
	virtual void pyHandleCustomCtorArgs(boost::python::tuple& positional, boost::python::dict& named);

	void pyUpdateAttrs(const boost::python::dict& attributes); // ends with callPostLoad()

	// found by name lookup when a class has no postLoad of its own
	template <class T> void postLoad(T&) {}
	template <class T> void preSave(T&) {}
	template <class T> void postSave(T&) {}

	SAVED_BY_YADE_MEMBER
};

} // namespace yade

SAVED_BY_YADE(Serializable)

// Stands after a class in its header, inside namespace yade (left for a moment: Boost's macros must stand outside of every namespace).
#define REGISTER_SERIALIZABLE(className)                                                                                                   \
	}                                                                                                                                  \
	BOOST_CLASS_EXPORT_KEY(yade::className)                                                                                            \
	namespace yade {                                                                                                                   \
		static_assert(true, "")

#define YADE_CLASS_BASE_DOC_ATTRS(Class, Base, doc, attributes) YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(Class, Base, doc, attributes, , )
#define YADE_CLASS_BASE_DOC_ATTRS_CTOR(Class, Base, doc, attributes, constructor)                                                          \
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(Class, Base, doc, attributes, constructor, )
