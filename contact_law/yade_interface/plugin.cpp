// How the plugin enters YADE: the check that comes before any of its classes, and the functions that contact_law/__init__.py calls.
#include "../kernel/energy_channels.hpp"
#include "yade.hpp"
#include <iostream>
#include <sstream>

#if !defined(CONTACT_LAW_COMMIT) || !defined(CONTACT_LAW_YADE)
#error "the Makefile says from which commit the plugin is compiled, and for which YADE"
#endif

namespace yade {

#ifndef CONTACT_LAW_YADES_OWN_HEADERS
// Version and features of the YADE that runs must be those of the one that was installed when this was compiled. Only Python is read:
// nothing of YADE's objects is known before. Called while the library is loaded; what differs is one line on stderr.
bool factory::isDescribedYade()
{
	static const bool agrees = [] {
		std::string running = "no running YADE";
		try {
			if (Py_IsInitialized()) {
				const py::object config = py::import("yade.config");
				const py::object words = py::make_tuple(config.attr("version")) + py::tuple(config.attr("features"));
				const py::str blank(" "); // one between two words, as the Makefile has it
				running = py::extract<std::string>(blank.join(blank.join(words).attr("split")()));
			}
		} catch (py::error_already_set&) {
			PyErr_Clear();
		}
		if (running == CONTACT_LAW_YADE) return true;
		std::cerr << "contact_law: refusing to load: this is YADE " << running << ", not " << CONTACT_LAW_YADE
		          << ", for which it was compiled; run make again with this one" << std::endl;
		return false;
	}();
	return agrees;
}
#endif

namespace {
	// Omega::buildDynlibDatabase(classNames): makes classes known to YADE and to Python. It is private in YADE's own header, where nothing
	// public does the same for a plugin's classes alone; the language lets an explicit instantiation name it.
	void makeKnown(const std::vector<std::string>& classNames);
	template <void (Omega::*function)(const std::vector<std::string>&)> struct Known {
		friend void makeKnown(const std::vector<std::string>& classNames) { (Omega::instance().*function)(classNames); }
	};
	template struct Known<&Omega::buildDynlibDatabase>;
}

} // namespace yade

extern "C" {

// By ctypes with Python's lock held: takes classes (names with blanks between) to a YADE that has started. Why not, or an empty string.
const char* contact_law_load(const char* classNames)
{
	static std::string refusal;
	std::istringstream words(classNames);
	try {
		yade::makeKnown({ std::istream_iterator<std::string>(words), {} });
	} catch (boost::python::error_already_set&) {
		PyErr_Clear();
		refusal = "Python raised an error";
	} catch (const std::exception& error) {
		refusal = error.what();
	}
	return refusal.c_str();
}

// The git commit of the sources, "unknown" where git didn't know.
const char* contact_law_commit() { return CONTACT_LAW_COMMIT; }

// The energy channels, "name kind" each, with blanks between.
const char* contact_law_channels()
{
	static const std::string all = [] {
		const char* const kinds[] = { "stored", "lost", "work" };
		std::string words;
		for (const contact_law::Channel& channel : contact_law::channels)
			words += std::string(channel.name) + " " + kinds[int(channel.kind)] + " ";
		return words;
	}();
	return all.c_str();
}
}
