// Sliding, rolling and twisting displacements (Wada et al. 2007; A24 appendix A).
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
	// Part of d(zeta)/dt across the normal n while the grains spin and the normal turns at normalRate; linear in the pointers.
	template <class T>
	inline Vec3<T> rate(const Pointers<T>& p, const T& r1, const T& r2, const Vec3<T>& n, const Vec3<T>& normalRate,
	        const Vec3<T>& spin1, const Vec3<T>& spin2)
	{
		return r1 * cross(spin1, p.n1) - r2 * cross(spin2, p.n2) - dot(separation(p, r1, r2), n) * normalRate;
	}
}

namespace rolling {
	// xi = R (n1 + n2) (A24 eq A2)
	template <class T> inline Vec3<T> displacement(const Pointers<T>& p, const T& reducedRadius)
	{
		return reducedRadius * (p.n1 + p.n2);
	}
	template <class T> inline Vec3<T> rate(const Pointers<T>& p, const T& reducedRadius, const Vec3<T>& spin1, const Vec3<T>& spin2)
	{
		return reducedRadius * (cross(spin1, p.n1) + cross(spin2, p.n2));
	}
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

} // namespace contact_law
