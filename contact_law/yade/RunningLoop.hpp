// O.run(n) steps in a thread of its own: what would read or write the scene meanwhile is refused.
#pragma once
#include "Refusal.hpp"
#include <core/Omega.hpp>
#include <sys/syscall.h>
#include <unistd.h>

namespace yade {

// Python's main thread may not come in between; PyRunners are called by the loop's own thread, between two engines.
inline void requireLoopAtRest(const std::string& call)
{
	if (Omega::instance().isRunning() && syscall(SYS_gettid) == getpid())
		throw std::runtime_error(call + " while O.run() is under way: call it after O.pause() or O.wait(), or from a PyRunner");
}

} // namespace yade
