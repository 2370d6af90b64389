/* The root of all YADE classes that Python sees and O.save writes, and the macros by which a class declares itself: one list of attributes, from which
   follow members with defaults, Python properties with documentation, the dictionary that pickling uses, and saving and loading. */
#pragma once
#include <declare/python.hpp> // first: Python.h wants to be
#include <declare/attributes.hpp>
#include <declare/saved_by_yade.hpp>
#include <lib/base/Logging.hpp>
#include <lib/base/Math.hpp>
#include <lib/factory/ClassFactory.hpp>
#include <string>
#include <vector>

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
static_assert(sizeof(Serializable) == 24, "Serializable");

} // namespace yade

SAVED_BY_YADE(Serializable)

// Stands after a class in its header, inside namespace yade (left for a moment: Boost's macros must stand outside of every namespace).
#define REGISTER_SERIALIZABLE(className)                                                                                                   \
	}                                                                                                                                  \
	BOOST_CLASS_EXPORT_KEY(yade::className)                                                                                            \
	namespace yade {                                                                                                                   \
		static_assert(true, "")

#define YADE_CLASS_BASE_DOC(Class, Base, doc) YADE_CLASS_BASE_DOC_ATTRS_DEPREC_INIT_CTOR_PY(Class, Base, doc, , , , , )
#define YADE_CLASS_BASE_DOC_ATTRS(Class, Base, doc, attributes)                                                                            \
	YADE_CLASS_BASE_DOC_ATTRS_DEPREC_INIT_CTOR_PY(Class, Base, doc, attributes, , , , )
#define YADE_CLASS_BASE_DOC_ATTRS_CTOR(Class, Base, doc, attributes, constructor)                                                          \
	YADE_CLASS_BASE_DOC_ATTRS_DEPREC_INIT_CTOR_PY(Class, Base, doc, attributes, , , constructor, )
#define YADE_CLASS_BASE_DOC_ATTRS_PY(Class, Base, doc, attributes, python)                                                                 \
	YADE_CLASS_BASE_DOC_ATTRS_DEPREC_INIT_CTOR_PY(Class, Base, doc, attributes, , , , python)
#define YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(Class, Base, doc, attributes, constructor, python)                                               \
	YADE_CLASS_BASE_DOC_ATTRS_DEPREC_INIT_CTOR_PY(Class, Base, doc, attributes, , , constructor, python)
#define YADE_CLASS_BASE_DOC_ATTRS_INIT_CTOR_PY(Class, Base, doc, attributes, initializers, constructor, python)                            \
	YADE_CLASS_BASE_DOC_ATTRS_DEPREC_INIT_CTOR_PY(Class, Base, doc, attributes, , initializers, constructor, python)
