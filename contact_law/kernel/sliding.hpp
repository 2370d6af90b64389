// Sliding: a spring on how far the contact points of two grains have moved past each other (Wada et al. 2007; A24 appendix A, eqs A1, A5,
// A8), with a limit (A22 eq 19).
// k_s: A22 eq 18. n1, n2: contact pointers; n: from grain 2 to grain 1.
#pragma once
#include "pair_constants.hpp"
#include "pointers.hpp"

namespace contact_law {

// c: PairConstants, or a bond's.
struct SlidingSpring {
	static constexpr unsigned mechanism = Sliding;

	template <class Constants> ON_GPU static auto stiffness(const Constants& c) { return c.slidingStiffness; }
	template <class T> ON_GPU static T limit(const PairConstants<T>& c) { return c.criticalSliding; } // zeta_crit (A22 eq 19)

	// zeta0 = r1 n1 - r2 n2; the displacement zeta is its part across the normal (A24 eq A1)
	template <class Constants, class T> ON_GPU static Vec3<T> separation(const Constants& c, const Pointers<T>& p)
	{
		return c.radius1 * p.n1 - c.radius2 * p.n2;
	}
	// Against a plane (r2 infinite): r1 n1 from the grain's centre, less the anchor.
	template <class Constants, class T> ON_GPU static Vec3<T> separation(const Constants& c, const PlanePointers<T>& p)
	{
		return c.radius1 * p.n1 - p.anchor;
	}
	template <class Constants, class SomePointers, class T>
	ON_GPU static Vec3<T> displacement(const Constants& c, const SomePointers& p, const Vec3<T>& n)
	{
		const Vec3<T> zeta0 = separation(c, p);
		return zeta0 - dot(zeta0, n) * n;
	}
	// Part of d(zeta)/dt across the normal n while the grains spin and the normal turns; linear in the pointers.
	template <class T>
	ON_GPU static Vec3<T> rate(const PairConstants<T>& c, const Pointers<T>& p, const Vec3<T>& n, const Turning<T>& t)
	{
		return c.radius1 * cross(t.spin1, p.n1) - c.radius2 * cross(t.spin2, p.n2) - dot(separation(c, p), n) * t.normalRate;
	}
	template <class T>
	ON_GPU static Vec3<T> rate(const PairConstants<T>& c, const PlanePointers<T>& p, const Vec3<T>&, const Turning<T>& t)
	{
		return c.radius1 * cross(t.spin1, p.n1);
	}

	/* Displacement, force (A24 eq A8) and torques (A24 eq A5, any radii). Torques are written without zeta:
	 * M_s1 = -r1 k_s n1 x zeta = r1 k_s (r2 n1 x n2 + z n1 x n_c),  z = zeta0.n_c.  The first part is left to the caller: returned
	 * is its factor of n1 x n2. */
	template <class Constants, class T>
	ON_GPU static T addForces(const Constants& c, const ContactGeometry<T>& g, const Pointers<T>& p, ContactForces<T>& f)
	{
		const Vec3<T>& n = g.normal;
		const Vec3<T> zeta0 = separation(c, p);
		const T z = dot(zeta0, n), kz = c.slidingStiffness * z;
		f.slidingDisplacement = zeta0 - z * n;
		f.sliding = (kz * g.inverseDistance) * f.slidingDisplacement;
		f.torque1 = (kz * c.radius1) * cross(p.n1, n);
		f.torque2 = -((kz * c.radius2) * cross(p.n2, n));
		return c.slidingStiffness * c.radius1 * c.radius2;
	}
	// Against a plane -z/distance is 1: the force is -k_s zeta, and M_s1 = -r1 k_s n1 x zeta.
	template <class Constants, class T>
	ON_GPU static T addForces(const Constants& c, const ContactGeometry<T>& g, const PlanePointers<T>& p, ContactForces<T>& f)
	{
		f.slidingDisplacement = displacement(c, p, g.normal);
		f.sliding = -(c.slidingStiffness * f.slidingDisplacement);
		f.torque1 = c.radius1 * cross(p.n1, f.sliding);
		return T(0.);
	}

	/* The pointers with zeta another `by` along e (a unit vector across the normal) and the rolling displacement as it is, to first order: both
	 * move oppositely by `by` over r1 + r2 (Wada's +-excess/(2 r) for equal radii; MODEL.md on unlike ones), on a plane the anchor alone. */
	template <class T> ON_GPU static Pointers<T> moved(const PairConstants<T>& c, const Pointers<T>& p, const T& by, const Vec3<T>& e)
	{
		return { movedPointer(p.n1, by, c.radius1 + c.radius2, e), movedPointer(p.n2, -by, c.radius1 + c.radius2, e) };
	}
	template <class T>
	ON_GPU static PlanePointers<T> moved(const PairConstants<T>&, const PlanePointers<T>& p, const T& by, const Vec3<T>& e)
	{
		return { p, p.anchor - by * e };
	}
};

} // namespace contact_law
