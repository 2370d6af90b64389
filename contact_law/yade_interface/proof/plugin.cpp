#include "plugin.hpp"
#include "../../kernel/energy_channels.hpp"
#include "layouts.hpp"
#include <core/Omega.hpp>
#include <dlfcn.h>
#include <iostream>

#ifndef CONTACT_LAW_COMMIT
#define CONTACT_LAW_COMMIT "unknown"
#endif

#ifdef YADE_PLUGIN_AT_ONCE
#define CONTACT_LAW_WAITS_FOR_PROOF 1
#else
// compiled against YADE's own source, whose YADE_PLUGIN tells YADE of all classes at once
#define CONTACT_LAW_WAITS_FOR_PROOF 0
#define YADE_PLUGIN_AT_ONCE(classes) YADE_PLUGIN(classes)
#endif

namespace yade {

#if CONTACT_LAW_WAITS_FOR_PROOF
std::vector<std::string>& pluginClassesAwaitingProof()
{
	static std::vector<std::string> names;
	return names;
}

bool factory::versionAgrees()
{
	const std::string difference = contact_law::proof::differenceInVersion();
	if (!difference.empty()) std::cerr << difference << std::endl;
	return difference.empty();
}
#endif

namespace {
	// Omega::buildDynlibDatabase(classNames): makes classes known to YADE and to Python. It is private in YADE's own header,
	// where nothing public does the same for a plugin's classes alone; the language lets an explicit instantiation name it.
	void makeKnown(const std::vector<std::string>& classNames);
	template <void (Omega::*function)(const std::vector<std::string>&)> struct Known {
		friend void makeKnown(const std::vector<std::string>& classNames) { (Omega::instance().*function)(classNames); }
	};
	template struct Known<&Omega::buildDynlibDatabase>;

	bool proven = false;     // whether the proof has run
	bool fromPython = false; // loaded by import contact_law, which reports a refusal itself
	std::string whyRefused;

#if !CONTACT_LAW_WAITS_FOR_PROOF
	// by where its virtual functions are
	bool isInThisLibrary(const std::string& className)
	{
		const shared_ptr<Factorable> object = ClassFactory::instance().createShared(className);
		Dl_info there, here;
		return dladdr(*reinterpret_cast<void**>(object.get()), &there) && dladdr(&whyRefused, &here)
		        && there.dli_fbase == here.dli_fbase;
	}
#endif

	std::vector<std::string>& ownClasses()
	{
#if CONTACT_LAW_WAITS_FOR_PROOF
		return pluginClassesAwaitingProof();
#else
		static std::vector<std::string> names = [] {
			std::vector<std::string> own;
			for (const std::string& name : ClassFactory::instance().pluginClasses)
				if (name != "ContactLawPlugin" && isInThisLibrary(name)) own.push_back(name);
			return own;
		}();
		return names;
#endif
	}

	void proveAndLetIn()
	{
		proven = true;
		whyRefused = contact_law::proof::differenceFromRunningYade();
		if (whyRefused.empty()) {
			if (CONTACT_LAW_WAITS_FOR_PROOF || fromPython) makeKnown(ownClasses());
			return;
		}
		if (!fromPython) std::cerr << whyRefused << std::endl;
	}
}

std::string ContactLawPlugin::commit() { return CONTACT_LAW_COMMIT; }
std::string ContactLawPlugin::refusal() { return whyRefused; }

boost::python::list ContactLawPlugin::classNames()
{
	boost::python::list names;
	for (const std::string& name : ownClasses())
		names.append(name);
	return names;
}

boost::python::tuple ContactLawPlugin::channels()
{
	const char* const kinds[] = { "stored", "lost", "work" };
	boost::python::list all;
	for (const contact_law::Channel& channel : contact_law::channels)
		all.append(boost::python::make_tuple(channel.name, kinds[int(channel.kind)]));
	return boost::python::tuple(all);
}

void ContactLawPlugin::checkPyClassRegistersItself(const std::string& className) const
{
	Serializable::checkPyClassRegistersItself(className);
	if (proven) return;
	if (!contact_law::proof::classesAreThere()) {
		// as a class does whose base isn't there yet: YADE, starting, comes back to it
		PyErr_SetString(PyExc_RuntimeError, "contact_law waits for YADE's own classes");
		boost::python::throw_error_already_set();
	}
	proveAndLetIn();
}

YADE_PLUGIN_AT_ONCE((ContactLawPlugin));

} // namespace yade

/* For contact_law/__init__.py, by ctypes with Python's lock held: takes the classes to YADE and returns why not, or an empty string. */
extern "C" const char* contact_law_load()
{
	static std::string result;
	try {
		result = contact_law::proof::differenceInVersion();
		if (!result.empty()) return result.c_str();
		yade::fromPython = true;
		if (!yade::proven) yade::makeKnown({ "ContactLawPlugin" });
		result = yade::whyRefused;
		if (result.empty() && !yade::proven)
			result = contact_law::proof::refusal("the proof of layouts did not run", "contact_law_load");
	} catch (boost::python::error_already_set&) {
		PyErr_Clear();
		result = contact_law::proof::refusal("Python raised an error", "contact_law_load");
	} catch (const std::exception& error) {
		result = contact_law::proof::refusal(error.what(), "contact_law_load");
	}
	return result.c_str();
}
