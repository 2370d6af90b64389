// Goes through the table of members, and through the versions.
#include "layouts.hpp"
#include <algorithm>
#include <set>

#ifndef CONTACT_LAW_YADE_VERSION
#error "the Makefile says which version of YADE the plugin is compiled for"
#endif

namespace contact_law {
namespace proof {

	namespace {
		// Of the YADE that was installed when this was compiled.
		const char* const describedVersion = CONTACT_LAW_YADE_VERSION;

		py::object wrapper() { return py::import("yade.wrapper"); }

		// One line from whatever Python raised; the error is cleared.
		std::string pythonError()
		{
			PyObject *type, *value, *trace;
			PyErr_Fetch(&type, &value, &trace);
			py::handle<> ownedType(py::allow_null(type)), ownedValue(py::allow_null(value)), ownedTrace(py::allow_null(trace));
			if (!value) return "an error in Python";
			std::string text = py::extract<std::string>(py::str(py::object(ownedValue)));
			return text.substr(0, text.find('\n'));
		}

		// A class may have grown a member that the table doesn't name.
		std::string differenceInSize(const Member& row)
		{
			const py::object object = make(row.className);
			const void* start = &py::extract<yade::Serializable&>(object)();
			const size_t room = malloc_usable_size(const_cast<void*>(start));
			// an allocator rounds up: by less than 32 bytes the usual one, by up to a quarter others
			const size_t most = row.classSize + std::max<size_t>(48, row.classSize / 4);
			if (room >= row.classSize && room <= most) return "";
			return "has room for " + std::to_string(room) + " bytes, declared are " + std::to_string(row.classSize);
		}
	}

	std::string refusal(const std::string& what, const std::string& where)
	{
		return "contact_law: refusing to load: " + what + " (" + where + "). It was compiled for YADE " + describedVersion
		        + "; run make again with this one, or compile against its source: make YADE_INCLUDE=/path/to/its/source "
		          "YADE_VERSION=its-version.";
	}

	py::object make(const char* className) { return wrapper().attr(className)(); }

	void write(py::object& object, const char* attribute, const py::object& value)
	{
		py::dict change;
		change[attribute] = value;
		object.attr("updateAttrs")(change);
	}

	std::string differenceInVersion()
	{
		if (!Py_IsInitialized())
			return "contact_law: refusing to load: this is no running YADE (no Python here). Run it inside yade.";
		try {
			const std::string version = py::extract<std::string>(py::import("yade.config").attr("version"));
			if (version != describedVersion)
				return refusal("this is YADE " + version + ", not " + describedVersion, "yade.config.version");
			return "";
		} catch (py::error_already_set&) {
			return refusal("cannot tell YADE's version: " + pythonError(), "yade.config.version");
		}
	}

	bool classesAreThere()
	{
		const py::object everything = wrapper();
		std::set<std::string> needed { "Omega", "ForceResetter", "Law2_ScGeom_FrictPhys_CundallStrack",
			"Ip2_FrictMat_FrictMat_FrictPhys", "GlobalEngine", "LawFunctor", "IPhysFunctor" };
		for (const Member& row : members())
			needed.insert(row.className);
		for (const std::string& name : needed)
			if (!PyObject_HasAttrString(everything.ptr(), name.c_str())) return false;
		return true;
	}

	std::string differenceInMembers(const std::vector<Member>& rows)
	{
		int number = 1;
		for (const Member& row : rows) {
			const std::string where = "byte " + std::to_string(row.offset) + " of " + std::to_string(row.classSize);
			const std::string name = std::string(row.className) + "." + row.name;
			try {
				const std::string size = differenceInSize(row);
				if (!size.empty()) return refusal(std::string(row.className) + " " + size, where);
				const std::string found = row.compare(row, number);
				if (!found.empty()) return refusal(name + " isn't where this plugin has it: " + found, where);
			} catch (py::error_already_set&) {
				return refusal(name + " cannot be proven: " + pythonError(), where);
			}
			number += 3;
		}
		return "";
	}

	std::string differenceFromRunningYade()
	{
		std::string difference = differenceInVersion();
		if (!difference.empty()) return difference;
		try {
			py::import("yade.minieigenHP"); // bring vectors and lists to Python; a starting YADE does so only later
			py::import("yade._customConverters");
			difference = differenceInVirtualTables();
			if (difference.empty()) difference = differenceInMembers(members());
			if (difference.empty()) difference = differenceInScenes();
		} catch (py::error_already_set&) {
			difference = refusal("the proof could not run: " + pythonError(), "contact_law/yade_interface/proof");
		} catch (const std::exception& error) {
			difference = refusal(std::string("the proof could not run: ") + error.what(), "contact_law/yade_interface/proof");
		}
		return difference;
	}

} // namespace proof
} // namespace contact_law
