// O.run(n) steps in a thread of its own: what would read or write the scene meanwhile is refused, and what that thread throws reaches Python.
#pragma once
#include "Refusal.hpp"
#include <core/Omega.hpp>
#include <chrono>
#include <future>
#include <sys/syscall.h>
#include <thread>
#include <unistd.h>

namespace yade {

// Python's main thread may not come in between; PyRunners are called by the loop's own thread, between two engines.
inline void requireLoopAtRest(const std::string& call)
{
	if (Omega::instance().isRunning() && syscall(SYS_gettid) == getpid())
		throw std::runtime_error(call + " while O.run() is under way: call it after O.pause() or O.wait(), or from a PyRunner");
}

/* Before a step of O.run(n, True) throws: O.wait() raises nothing when the loop has ended before it looks. Python holds its lock until it waits, so returns when
 * that was free, or after a second: O.reset() holds it until the loop has ended. */
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
