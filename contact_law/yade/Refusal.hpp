// One line for what the fused engine cannot do, and numbers in it; and how a refusal reaches Python.
#pragma once
#include "../engine/shared_state.hpp"
#include "../yade_interface/yade.hpp"
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <future>
#include <stdexcept>
#include <string>
#include <sys/syscall.h>
#include <thread>
#include <unistd.h>

namespace yade {

[[noreturn]] inline void refuseInEngine(const std::string& what) { throw std::runtime_error("JKRWadaEngine: " + what); }
inline void refuseIfAny(const std::string& fault) // empty: there is none
{
	if (!fault.empty()) refuseInEngine(fault);
}

// As in Python: numbers by as many digits as they have, strings in quotes.
inline std::string text(double number) { return contact_law::textOf(number); }
inline std::string text(int number) { return std::to_string(number); }
inline std::string text(bool is) { return is ? "True" : "False"; }
inline std::string text(const std::string& string) { return "'" + string + "'"; }

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

inline std::string tooDeep(int id, int other, double overlap) // over the smaller radius
{
	return bodyName(std::min(id, other)) + " and " + bodyName(std::max(id, other)) + " overlap by " + rounded(overlap)
	        + " of the smaller radius";
}

// In both: springs, and what a material is changed by.
constexpr const char* dampedWithoutSprings = "springDamping: must be 0 without the springs of sliding, rolling or twisting";
constexpr const char* changedMaterial = " was changed during the run: contact_law.set_material() does that";

// ---- O.run(n) steps in a thread of its own ----

// What would read or write the scene meanwhile is refused to Python's main thread; PyRunners are called by the loop's own thread, between
// two engines.
inline void requireLoopAtRest(const std::string& call)
{
	if (Omega::instance().isRunning() && syscall(SYS_gettid) == getpid())
		throw std::runtime_error(call + " while O.run() is under way: call it after O.pause() or O.wait(), or from a PyRunner");
}

/* Before a step of O.run(n, True) throws: O.wait() raises nothing when the loop has ended before it looks. Python holds its lock until
 * it waits, so returns when that was free, or after a second: O.reset() holds it until the loop has ended. */
inline void letPythonWait()
{
	if (PyGILState_Check()) return; // O.step(): Python itself makes this step
	std::promise<void> free;
	const auto waits = free.get_future();
	std::thread([free = std::move(free)]() mutable {
		PyGILState_Release(PyGILState_Ensure());
		free.set_value();
	}).detach();
	waits.wait_for(std::chrono::seconds(1));
}

} // namespace yade
