// Sliding, rolling and twisting displacements (Wada et al. 2007; A24 appendix A), their limits, and the work lost at a limit.
// n1, n2: contact pointers, unit vectors that ride with the grains from their centres to the contact; n: from grain 2 to grain 1.
#pragma once
#include "number.hpp"
#include "vector3.hpp"

namespace contact_law {

template <class T> struct Pointers {
	Vec3<T> n1, n2;
};

namespace sliding {
	// zeta0 = r1 n1 - r2 n2; the displacement is its part across the normal (A24 eq A1)
	template <class T> inline Vec3<T> separation(const Pointers<T>& p, const T& r1, const T& r2) { return r1 * p.n1 - r2 * p.n2; }
	template <class T> inline Vec3<T> displacement(const Pointers<T>& p, const T& r1, const T& r2, const Vec3<T>& n)
	{
		const Vec3<T> zeta0 = separation(p, r1, r2);
		return zeta0 - dot(zeta0, n) * n;
	}
}

namespace rolling {
	// xi = R (n1 + n2) (A24 eq A2)
	template <class T> inline Vec3<T> displacement(const Pointers<T>& p, const T& reducedRadius) { return reducedRadius * (p.n1 + p.n2); }
}

namespace twisting {
	/* phi grows by (w1 - w2).n dt (A24 eq A4), n taken half-way through the step so that the angle is of second order in dt:
	 * half a step ago the normal was n - dt/2 (v - (v.n) n)/distance, v the velocity of grain 1 past grain 2. */
	template <class T>
	inline T increment(const Vec3<T>& n, const T& inverseDistance, const Vec3<T>& velocity, const Vec3<T>& spin, const T& dt)
	{
		const T along = dot(spin, n);
		return dt * (along - T(0.5) * dt * inverseDistance * (dot(spin, velocity) - along * dot(velocity, n)));
	}
}

/* Renormalising a pointer after a move along the unit vector e takes back (n.e)^2 of it (Wada et al. 2007): move that much further. */
inline Vec3<double> movedPointer(const Vec3<double>& pointer, double move, const Vec3<double>& e)
{
	const double       along = dot(pointer, e);
	const Vec3<double> moved = pointer + (move / (1 - along * along)) * e;
	return (1 / std::sqrt(dot(moved, moved))) * moved;
}

/* Put the sliding displacement zeta back onto its limit, leaving the rolling one as it is (to first order):
 * both pointers move oppositely by the excess over r1 + r2 (Wada's +-excess/(2 r) for equal radii; MODEL.md on unlike ones). */
inline void slideBack(Pointers<double>& p, double r1, double r2, const Vec3<double>& zeta, double limit)
{
	const double       length = std::sqrt(dot(zeta, zeta)), move = (length - limit) / (r1 + r2);
	const Vec3<double> e      = (1 / length) * zeta;
	p.n1                      = movedPointer(p.n1, -move, e);
	p.n2                      = movedPointer(p.n2, move, e);
}

/* Put the rolling displacement xi back onto its limit, leaving the sliding one: each pointer moves by -excess/r_i
 * (Wada's -excess/(2R) for equal radii). */
inline void rollBack(Pointers<double>& p, double r1, double r2, const Vec3<double>& xi, double limit)
{
	const double       length = std::sqrt(dot(xi, xi)), excess = length - limit;
	const Vec3<double> e      = (1 / length) * xi;
	p.n1                      = movedPointer(p.n1, -excess / r1, e);
	p.n2                      = movedPointer(p.n2, -excess / r2, e);
}

/* The energy that a slip takes in one step of a kick-drift-kick integrator. The kicks use the forces before the step (displacement
 * `before`) and after the putting back (`after`), so that the motion loses k/2 (before + after).(trial - before), of which
 * k/2 (after^2 - before^2) is stored. */
inline double slipDissipation(double stiffness, const Vec3<double>& before, const Vec3<double>& trial, const Vec3<double>& after)
{
	return stiffness / 2 * dot(before + after, trial - after);
}

} // namespace contact_law
