/* The root of all YADE classes that Python sees and O.save writes, and the macros by which a class declares itself: one list of attributes, from which
   follow members with defaults, Python properties with documentation, the dictionary that pickling uses, and saving and loading. */
#pragma once
#include <declare/attributes.hpp> // first: Python.h wants to be
#include <lib/base/Math.hpp>
#include <lib/factory/ClassFactory.hpp>

/* Saving a class saves its base first. The bases' own serialize functions are not exported by YADE's libraries; what is exported, for each base and each
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
