// Where YADE learns the names of classes and how to make them; and the archives in which it saves them.
#pragma once
#include <lib/base/Math.hpp>
// BOOST_CLASS_EXPORT_* makes code for the archives that were included before it: these four are all that O.save, O.load and their memory slots use.
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/enable_shared_from_this.hpp>
#include <boost/preprocessor.hpp>
#include <boost/serialization/base_object.hpp>
#include <boost/serialization/export.hpp>
#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

// The one object of a class, in libyade, which exports instance(). Global, not in namespace yade: its mangled name says so.
template <class T> class Singleton {
public:
	static T& instance();
};

namespace yade {

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

} // namespace yade

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
