// The cube root, rounded to the nearest number: the C library's differs in its last bits between machines and versions.
#pragma once
#include <cmath>

namespace contact_law {

// A step of Newton's from the library's, whose error y^3 - x is taken without rounding (fma).
inline double cubeRoot(double x)
{
	const double y = std::cbrt(x);
	if (y == 0 || !std::isfinite(y)) return y;
	const double square = y * y, ofSquare = std::fma(y, y, -square);
	const double cube = square * y, ofCube = std::fma(square, y, -cube) + ofSquare * y;
	return y - ((cube - x) + ofCube) / (3 * square);
}

} // namespace contact_law
