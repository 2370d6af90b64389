// Looks at memory that may not be there: a wrong layout must give a line of text, not a crash.
#pragma once
#include <cstdint>
#include <string>

namespace contact_law {
namespace proof {

	bool readSafely(const void* from, void* to, size_t bytes);

	// Mangled name of the class of an object with virtual functions, "?" if there is none.
	std::string classOf(const void* object);

	// The function in a slot of the table that is used by the part of the object at an offset. "?" if there is none. Slots count from 0 behind
	// the type information, as the compiler counts.
	std::string functionInSlot(const void* object, size_t offset, int slot);

	// Where the part of the object at an offset says that the whole object begins; 0 if it says none.
	std::ptrdiff_t offsetToTop(const void* object, size_t offset);

} // namespace proof
} // namespace contact_law
