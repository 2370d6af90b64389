// Where YADE learns the names of classes and how to make them; and the archives in which it saves them.
#pragma once
#include <lib/base/Logging.hpp>
#include <lib/base/Singleton.hpp>
#include <lib/factory/Factorable.hpp>
// BOOST_CLASS_EXPORT_* makes code for the archives that were included before it: these four are all that O.save, O.load and their memory slots use.
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/preprocessor.hpp>
#include <boost/serialization/base_object.hpp>
#include <boost/serialization/export.hpp>
#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <vector>

namespace yade {

// The object lives in libyade and only these two functions are called: its layout doesn't matter here.
class ClassFactory : public Singleton<ClassFactory> {
public:
	bool registerFactorable(
	        std::string name, Factorable* (*create)(), shared_ptr<Factorable> (*createShared)(), void* (*createPureCustom)());
	void registerPluginClasses(const char* fileAndClasses[]);
};

/* The classes of this plugin. YADE makes an object of every class that it hears of at once; so it hears of these only after the layouts
   that they are built upon are proven (proof/plugin.cpp). */
std::vector<std::string>& pluginClassesAwaitingProof();

namespace factory {
	template <class T> Factorable* create() { return new T; }
	template <class T> shared_ptr<Factorable> createShared() { return shared_ptr<Factorable>(new T); }
	template <class T> void* createPureCustom() { return new T; }
	template <class T> bool registerClass(const char* name)
	{
		ClassFactory::instance().registerFactorable(name, create<T>, createShared<T>, createPureCustom<T>);
		pluginClassesAwaitingProof().push_back(name);
		return true;
	}
	bool versionAgrees(); // says one line on stderr if it doesn't
	template <class T> void registerIfVersionAgrees(const char* file, const char* name)
	{
		if (!versionAgrees()) return;
		ClassFactory::instance().registerFactorable(name, create<T>, createShared<T>, createPureCustom<T>);
		const char* fileAndClass[] = { file, name, nullptr };
		ClassFactory::instance().registerPluginClasses(fileAndClass);
	}
} // namespace factory

} // namespace yade

#define YADE_INTERFACE_REGISTER_(r, data, className)                                                                                       \
	namespace {                                                                                                                        \
		const bool BOOST_PP_CAT(registered, className) = ::yade::factory::registerClass<className>(BOOST_PP_STRINGIZE(className)); \
	}
#define YADE_INTERFACE_EXPORT_(r, data, className)                                                                                         \
	}                                                                                                                                  \
	BOOST_CLASS_EXPORT_IMPLEMENT(yade::className)                                                                                      \
	namespace yade {

// Stands in the one .cpp file of the classes, inside namespace yade (left for a moment: Boost's macros must stand outside of every namespace).
#define YADE_PLUGIN(classes)                                                                                                               \
	BOOST_PP_SEQ_FOR_EACH(YADE_INTERFACE_REGISTER_, ~, classes)                                                                        \
	BOOST_PP_SEQ_FOR_EACH(YADE_INTERFACE_EXPORT_, ~, classes)                                                                          \
	static_assert(true, "")

/* For the one class that runs the proof: YADE hears of it when the library is loaded, if it is the YADE that is described here. Otherwise one line says so. */
#define YADE_PLUGIN_AT_ONCE(oneClass)                                                                                                      \
	namespace {                                                                                                                        \
		__attribute__((constructor)) void registerAtOnce()                                                                         \
		{                                                                                                                          \
			using Class = BOOST_PP_SEQ_HEAD(oneClass);                                                                         \
			::yade::factory::registerIfVersionAgrees<Class>(__FILE__, BOOST_PP_STRINGIZE(BOOST_PP_SEQ_HEAD(oneClass)));        \
		}                                                                                                                          \
	}                                                                                                                                  \
	BOOST_PP_SEQ_FOR_EACH(YADE_INTERFACE_EXPORT_, ~, oneClass)                                                                         \
	static_assert(true, "")
