// The room that a mutex of YADE's takes. It is never locked from here; its alignment counts (an array of char would move what follows).
#pragma once
namespace yade {
namespace declare {
	struct Mutex {
		long room[5];
	};
	static_assert(sizeof(Mutex) == 40 && alignof(Mutex) == 8, "mutex");
} // namespace declare
} // namespace yade
