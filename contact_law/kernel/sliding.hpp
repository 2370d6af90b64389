// Sliding: a spring on how far the contact points of two grains have moved past each other (Wada et al. 2007; A24 appendix A, eqs A1, A5,
// A8), with a limit (A22 eq 19).
// k_s: A22 eq 18. n1, n2: contact pointers; n: from grain 2 to grain 1.
#pragma once
#include "pair_constants.hpp"
#include "pointers.hpp"

namespace contact_law {
namespace sliding {

	// zeta0 = r1 n1 - r2 n2; the displacement zeta is its part across the normal (A24 eq A1)
	template <class T> inline Vec3<T> separation(const Pointers<T>& p, const T& r1, const T& r2) { return r1 * p.n1 - r2 * p.n2; }
	// Against a plane (r2 infinite): r1 n1 from the grain's centre, less the anchor.
	template <class T> inline Vec3<T> separation(const PlanePointers<T>& p, const T& r1, const T&) { return r1 * p.n1 - p.anchor; }
	template <class SomePointers, class T>
	inline Vec3<T> displacement(const SomePointers& p, const T& r1, const T& r2, const Vec3<T>& n)
	{
		const Vec3<T> zeta0 = separation(p, r1, r2);
		return zeta0 - dot(zeta0, n) * n;
	}
	// Part of d(zeta)/dt across the normal n while the grains spin and the normal turns; linear in the pointers.
	template <class T> inline Vec3<T> rate(const Pointers<T>& p, const T& r1, const T& r2, const Vec3<T>& n, const Turning<T>& t)
	{
		return r1 * cross(t.spin1, p.n1) - r2 * cross(t.spin2, p.n2) - dot(separation(p, r1, r2), n) * t.normalRate;
	}
	template <class T> inline Vec3<T> rate(const PlanePointers<T>& p, const T& r1, const T&, const Vec3<T>&, const Turning<T>& t)
	{
		return r1 * cross(t.spin1, p.n1);
	}

	/* Displacement, force (A24 eq A8) and torques (A24 eq A5, any radii), with the radii and stiffness of c (PairConstants, or a
	 * bond's). Torques are written without zeta:
	 * M_s1 = -r1 k_s n1 x zeta = r1 k_s (r2 n1 x n2 + z n1 x n_c),  z = zeta0.n_c.  The first part is left to the caller: returned
	 * is its factor of n1 x n2. */
	template <class Constants, class T>
	inline T addForces(const Constants& c, const ContactGeometry<T>& g, const Pointers<T>& p, ContactForces<T>& f)
	{
		const Vec3<T>& n = g.normal;
		const Vec3<T> zeta0 = separation(p, c.radius1, c.radius2);
		const T z = dot(zeta0, n), kz = c.slidingStiffness * z;
		f.slidingDisplacement = zeta0 - z * n;
		f.sliding = (kz * g.inverseDistance) * f.slidingDisplacement;
		f.torque1 = (kz * c.radius1) * cross(p.n1, n);
		f.torque2 = -((kz * c.radius2) * cross(p.n2, n));
		return c.slidingStiffness * c.radius1 * c.radius2;
	}
	// Against a plane -z/distance is 1: the force is -k_s zeta, and M_s1 = -r1 k_s n1 x zeta.
	template <class Constants, class T>
	inline T addForces(const Constants& c, const ContactGeometry<T>& g, const PlanePointers<T>& p, ContactForces<T>& f)
	{
		f.slidingDisplacement = displacement(p, c.radius1, c.radius2, g.normal);
		f.sliding = -(c.slidingStiffness * f.slidingDisplacement);
		f.torque1 = c.radius1 * cross(p.n1, f.sliding);
		return T(0.);
	}

	// U_s = k_s zeta^2/2
	template <class Constants, class T> inline T energy(const Constants& c, const Vec3<T>& zeta)
	{
		return T(0.5) * c.slidingStiffness * dot(zeta, zeta);
	}

	// Limit: |zeta| > zeta_crit (A22 eq 19)
	template <class T> inline MaskOf<T> beyondLimit(const PairConstants<T>& c, const Vec3<T>& zeta)
	{
		return c.criticalSliding * c.criticalSliding < dot(zeta, zeta);
	}
	/* The pointers with zeta another `by` along e (a unit vector across the normal) and the rolling displacement as it is, to first order: both
	 * move oppositely by `by` over r1 + r2 (Wada's +-excess/(2 r) for equal radii; MODEL.md on unlike ones), on a plane the anchor alone. */
	template <class T> inline Pointers<T> moved(const Pointers<T>& p, const T& by, const T& r1, const T& r2, const Vec3<T>& e)
	{
		return { movedPointer(p.n1, by, r1 + r2, e), movedPointer(p.n2, -by, r1 + r2, e) };
	}
	template <class T> inline PlanePointers<T> moved(const PlanePointers<T>& p, const T& by, const T&, const T&, const Vec3<T>& e)
	{
		return { p, p.anchor - by * e };
	}
	// With zeta returned to the limit.
	template <class SomePointers, class T>
	inline SomePointers returned(const SomePointers& p, const T& r1, const T& r2, const Vec3<T>& zeta, const T& limit)
	{
		const T squared = dot(zeta, zeta), inverse = inverseRoot(squared), excess = squared * inverse - limit;
		return moved(p, -excess, r1, r2, inverse * zeta);
	}
	// With zeta another `by`, a vector across the normal.
	template <class SomePointers> inline SomePointers displaced(const SomePointers& p, double r1, double r2, const Vec3<double>& by)
	{
		const double length = std::sqrt(dot(by, by));
		return length == 0 ? p : moved(p, length, r1, r2, (1 / length) * by);
	}
	// What the return of displacement `trial` to pointers p, which moved them by `moved`, dissipates; `before`: the displacement a step
	// ago.
	template <class SomePointers, class T>
	inline T dissipation(const PairConstants<T>& c, const Vec3<T>& normal, const Vec3<T>& before, const Vec3<T>& trial,
	        const SomePointers& p, const SomePointers& moved, const Turning<T>& t)
	{
		const Vec3<T> further = t.dt * rate(moved, c.radius1, c.radius2, normal, t);
		return slipDissipation(c.slidingStiffness, before, trial, displacement(p, c.radius1, c.radius2, normal), further);
	}

} // namespace sliding
} // namespace contact_law
