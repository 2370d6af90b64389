// Numbers in messages.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <string>

namespace contact_law {

// The fewest digits that read back as the same number.
inline std::string textOf(double number)
{
	char buffer[32];
	for (int digits = 6; digits <= 17; ++digits) {
		std::snprintf(buffer, sizeof buffer, "%.*g", digits, number);
		if (std::strtod(buffer, nullptr) == number) break;
	}
	return buffer;
}

} // namespace contact_law
