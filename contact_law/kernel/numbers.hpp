// Numbers and vectors of three, as templates over the number type: double, or the engine's packs of doubles, which bring the functions of
// the first part for themselves.
#pragma once
#include <cmath>

// A GPU runs the law as well: there nvcc needs marks on member functions and tables. (Free functions: gpu/block.hpp.)
#ifdef __CUDACC__
#define ON_GPU __host__ __device__
#define TABLE_ON_GPU __device__
#else
#define ON_GPU
#define TABLE_ON_GPU
#endif

namespace contact_law {

template <class T> using MaskOf = decltype(T() < T()); // bool, or of a pack one for each of its doubles

inline double root(double x) { return std::sqrt(x); }
inline double inverseRoot(double x) { return 1 / std::sqrt(x); }
inline double choose(bool condition, double yes, double no) { return condition ? yes : no; }
inline bool anyOf(bool condition) { return condition; }
inline double absolute(double x) { return std::fabs(x); }
inline double nearest(double x) { return (x + 0x1.8p52) - 0x1.8p52; } // whole number; of |x| < 2^51, and without a call of a function

// The cube root, rounded to the nearest number: the C library's differs in its last bits between machines and versions.
// A step of Newton's from the library's, whose error y^3 - x is taken without rounding (fma).
inline double cubeRoot(double x)
{
	const double y = std::cbrt(x);
	if (y == 0 || !std::isfinite(y)) return y;
	const double square = y * y, ofSquare = std::fma(y, y, -square);
	const double cube = square * y, ofCube = std::fma(square, y, -cube) + ofSquare * y;
	return y - ((cube - x) + ofCube) / (3 * square);
}

// ---- vectors ----

template <class T> struct Vec3 {
	T x, y, z;
};

template <class T> inline Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) { return { a.x + b.x, a.y + b.y, a.z + b.z }; }
template <class T> inline Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) { return { a.x - b.x, a.y - b.y, a.z - b.z }; }
template <class T> inline Vec3<T> operator-(const Vec3<T>& a) { return { -a.x, -a.y, -a.z }; }
template <class T> inline Vec3<T> operator*(const T& s, const Vec3<T>& a) { return { s * a.x, s * a.y, s * a.z }; }
inline bool operator==(const Vec3<double>& a, const Vec3<double>& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
template <class T> inline T dot(const Vec3<T>& a, const Vec3<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> inline Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b)
{
	return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

// v turned by the angle |turn| about turn.
inline Vec3<double> turned(const Vec3<double>& v, const Vec3<double>& turn)
{
	const double squared = dot(turn, turn);
	if (squared == 0) return v;
	const double angle = std::sqrt(squared), half = std::sin(angle / 2) / angle;
	const Vec3<double> once = cross(turn, v), twice = cross(turn, once);
	return v + (std::sin(angle) / angle) * once + (2 * half * half) * twice;
}

// The same for a small angle: the series of sin(x)/x and (1 - cos x)/x^2, cut where the rest is below 1e-13 up to 0.1 rad.
template <class T> inline Vec3<T> turnedALittle(const Vec3<T>& v, const Vec3<T>& turn)
{
	const T s = dot(turn, turn);
	const T sine = T(1.) - s * (T(1. / 6) - s * (T(1. / 120) - s * T(1. / 5040)));
	const T vers = T(0.5) - s * (T(1. / 24) - s * T(1. / 720));
	const Vec3<T> once = cross(turn, v), twice = cross(turn, once);
	return v + sine * once + vers * twice;
}

} // namespace contact_law
