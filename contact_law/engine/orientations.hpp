// Orientations of grains, turned by the angular velocity of each small step as YADE's NewtonIntegrator does; only where a scene asks for them.
#pragma once
#include "arrays.hpp"
#include <cmath>

namespace contact_law {

struct Orientation { // unit quaternion
	double w, x, y, z;
};

// q turned by the angle |turn| about turn [rad], laboratory frame; kept a unit quaternion.
inline Orientation turnedBy(double turnX, double turnY, double turnZ, const Orientation& q)
{
	const double h = 0.25 * (turnX * turnX + turnY * turnY + turnZ * turnZ); // half the angle, squared
	double c, s;                                                             // cos(half), sin(half)/(2 half)
	if (h < 0.01) {                                                          // series of both, cut where the rest is below 1e-16
		c = 1 - h * (1. / 2 - h * (1. / 24 - h * (1. / 720 - h * (1. / 40320 - h * (1. / 3628800)))));
		s = 0.5 * (1 - h * (1. / 6 - h * (1. / 120 - h * (1. / 5040 - h * (1. / 362880)))));
	} else {
		const double half = std::sqrt(h);
		c = std::cos(half);
		s = 0.5 * std::sin(half) / half;
	}
	const double x = s * turnX, y = s * turnY, z = s * turnZ;
	Orientation r { c * q.w - x * q.x - y * q.y - z * q.z, c * q.x + x * q.w + y * q.z - z * q.y, c * q.y + y * q.w + z * q.x - x * q.z,
		c * q.z + z * q.w + x * q.y - y * q.x };
	const double unit = 1.5 - 0.5 * (r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z); // one Newton step, ample against rounding
	return { unit * r.w, unit * r.x, unit * r.y, unit * r.z };
}

inline void turnOrientations(const Grain* begin, const Grain* end, Orientation* orientation, double dt)
{
	for (const Grain* g = begin; g < end; ++g, ++orientation)
		*orientation = turnedBy(dt * g->wx, dt * g->wy, dt * g->wz, *orientation);
}

} // namespace contact_law
