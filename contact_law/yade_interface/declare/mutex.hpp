// The room that a mutex of YADE's takes. It is never locked from here; its alignment counts (an array of char would move what follows).
#pragma once
#include <pthread.h>
namespace yade {
namespace declare {
	constexpr size_t mutex = sizeof(pthread_mutex_t); // bytes: 40 on x86, 48 on 64-bit ARM
	struct Mutex {
		long room[mutex / 8];
	};
	static_assert(sizeof(Mutex) == mutex && alignof(Mutex) == 8, "mutex");
} // namespace declare
} // namespace yade
