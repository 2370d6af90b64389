// Rotation of vectors that ride with a grain.
#pragma once
#include "number.hpp"
#include "vector3.hpp"

namespace contact_law {

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
