// Offsets of members of classes with virtual functions: conditionally supported by the standard, well defined by the compiler that YADE is built with.
#pragma once
#include <cstddef>
#define YADE_INTERFACE_AT_(Class, member, offset)                                                                                          \
	_Pragma("GCC diagnostic push") _Pragma("GCC diagnostic ignored \"-Winvalid-offsetof\"") static_assert(                             \
	        offsetof(Class, member) == (offset), #Class "." #member " doesn't stand where YADE has it");                               \
	_Pragma("GCC diagnostic pop")
