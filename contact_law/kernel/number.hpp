// What the kernel asks of a number type: +, -, *, /, <, and these functions. double has them here; the engine's packs of doubles bring
// their own.
#pragma once
#include <cmath>

namespace contact_law {

template <class T> using MaskOf = decltype(T() < T()); // bool, or one truth a lane

inline double root(double x) { return std::sqrt(x); }
inline double inverseRoot(double x) { return 1 / std::sqrt(x); }
inline double choose(bool condition, double yes, double no) { return condition ? yes : no; }
inline bool anyOf(bool condition) { return condition; }
inline double absolute(double x) { return std::fabs(x); }
inline double nearest(double x) { return (x + 0x1.8p52) - 0x1.8p52; } // whole number; of |x| < 2^51, and without a call of a function

} // namespace contact_law
