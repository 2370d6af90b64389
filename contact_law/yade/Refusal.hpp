// One line for what the fused engine cannot do, and numbers in it.
#pragma once
#include "../engine/number_text.hpp"
#include <cstdio>
#include <stdexcept>
#include <string>

namespace yade {

[[noreturn]] inline void refuseInEngine(const std::string& what) { throw std::runtime_error("JKRWadaEngine: " + what); }

// As in Python: numbers by as many digits as they have, strings in quotes.
inline std::string text(double number) { return contact_law::textOf(number); }
inline std::string text(int number) { return std::to_string(number); }
inline std::string text(bool is) { return is ? "True" : "False"; }
inline std::string text(const std::string& string) { return "'" + string + "'"; }

// Of what was computed.
inline std::string rounded(double number, int digits = 4)
{
	char buffer[32];
	std::snprintf(buffer, sizeof buffer, "%.*g", digits, number);
	return buffer;
}

// step: its name; unstable: from where on no packing of the grains allows it [s].
inline std::string tooLong(const std::string& step, double seconds, double unstable)
{
	return "the " + step + " is " + text(seconds) + " s: must be above 0 and below " + text(unstable)
	        + " s, where every packing of these grains is unstable (dense ones, and drag, want less)";
}

inline std::string bodyName(std::size_t id) { return "body " + std::to_string(id); }

} // namespace yade
