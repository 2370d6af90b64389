// One row of the proof: a member of a class, where the declarations put it, what is written into it from Python and from C++.
#pragma once
#include <core/Scene.hpp>
#include <lib/serialization/Serializable.hpp>
#include <cstring>
#include <malloc.h>
#include <string>

namespace contact_law {
namespace proof {

	namespace py = boost::python;

	struct Member {
		const char* className;
		const char* name; // in Python
		size_t offset;
		size_t classSize;
		// Writes and reads both ways; number makes the values of all rows different. Empty, or what was found instead.
		std::string (*compare)(const Member&, int number);
	};

	py::object make(const char* className);                                  // an object of a YADE class
	void write(py::object&, const char* attribute, const py::object& value); // read-only attributes too

	// Room that an object has: to look past its end would find other objects, to write there would destroy them.
	inline bool fits(const void* object, size_t end) { return malloc_usable_size(const_cast<void*>(object)) >= end; }

	// Values that are no other row's and not what memory holds by chance.
	inline void sample(int i, double& v) { v = 1.0625e3 + i; }
	inline void sample(int i, int& v) { v = 70001 + i; }
	inline void sample(int i, long& v) { v = 9000001L + i; }
	inline void sample(int i, bool& v) { v = i % 2 != 0; }
	inline void sample(int i, std::string& v) { v = "proof" + std::to_string(i); }
	inline void sample(int i, yade::Vector3r& v) { v = yade::Vector3r(i + 0.5, i + 0.25, i + 0.125); }
	inline void sample(int i, yade::Vector3i& v) { v = yade::Vector3i(i + 11, i + 13, i + 17); }
	inline void sample(int i, yade::Matrix3r& v)
	{
		for (int j = 0; j < 9; ++j)
			v(j / 3, j % 3) = i + 0.03125 * (j + 1) + (j % 4 == 0 ? 5 : 0);
	}
	inline void sample(int i, yade::Quaternionr& v)
	{
		v = i % 2 ? yade::Quaternionr(0.5, -0.5, 0.5, 0.5) : yade::Quaternionr(0.5, 0.5, 0.5, -0.5);
	}

	template <class T> bool equalsAt(const char* at, const T& value) { return std::memcmp(at, &value, sizeof(T)) == 0; }
	template <> inline bool equalsAt(const char* at, const std::string& value)
	{
		// looks like a short string first: a pointer found by chance must not be followed
		const char* text;
		size_t length;
		std::memcpy(&text, at, sizeof text);
		std::memcpy(&length, at + sizeof text, sizeof length);
		return text == at + 16 && length == value.size() && std::memcmp(text, value.data(), length) == 0;
	}

	template <class Class, class T> std::string compareBothWays(const Member& row, int number)
	{
		py::object object = make(row.className);
		char* start = reinterpret_cast<char*>(&py::extract<Class&>(object)());
		if (!fits(start, row.offset + sizeof(T))) return "the object ends before it";
		T fromPython, fromHere;
		// twice, so that a truth value is written both ways too
		for (int round = 0; round < 2; ++round) {
			sample(number + round, fromPython);
			sample(number + round + 1, fromHere);
			write(object, row.name, py::object(fromPython));
			if (!equalsAt(start + row.offset, fromPython)) return "what Python wrote isn't there";
			*reinterpret_cast<T*>(start + row.offset) = fromHere;
			if (!(py::extract<T>(object.attr(row.name))() == fromHere)) return "Python doesn't see what is written there";
		}
		return "";
	}

	// A shared pointer to an object of another class.
	template <class Class, class Target> std::string comparePointer(const Member& row, const char* targetClass)
	{
		py::object object = make(row.className), target = make(targetClass);
		char* start = reinterpret_cast<char*>(&py::extract<Class&>(object)());
		if (!fits(start, row.offset + sizeof(boost::shared_ptr<Target>))) return "the object ends before it";
		write(object, row.name, target);
		const Target* written = &py::extract<Target&>(target)();
		return equalsAt(start + row.offset, written) ? "" : "the pointer that Python wrote isn't there";
	}

} // namespace proof
} // namespace contact_law
