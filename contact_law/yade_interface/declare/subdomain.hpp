// Where YADE is built with MPI (Makefile, YADE_FEATURES), its scenes and its container of bodies have room for subdomains.
#pragma once
#include <cstddef>
namespace yade {
namespace declare {
#ifdef YADE_MPI
	constexpr size_t subdomain = 24; // bytes in each
#else
	constexpr size_t subdomain = 0;
#endif
} // namespace declare
} // namespace yade
