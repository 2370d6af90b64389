// Rolling: a spring on how far two grains have rolled on each other (Wada et al. 2007; A24 appendix A, eqs A2, A6), with a limit, the
// material's xi_crit.
// k_r: A22 eq 14. n1, n2: contact pointers.
#pragma once
#include "pair_constants.hpp"
#include "pointers.hpp"

namespace contact_law {
namespace rolling {

	// xi = R (n1 + n2) (A24 eq A2)
	template <class T> inline Vec3<T> displacement(const Pointers<T>& p, const T& reducedRadius)
	{
		return reducedRadius * (p.n1 + p.n2);
	}
	template <class T> inline Vec3<T> rate(const Pointers<T>& p, const T& reducedRadius, const Turning<T>& t)
	{
		return reducedRadius * (cross(t.spin1, p.n1) + cross(t.spin2, p.n2));
	}

	/* Displacement, and torques M_r1 = -R k_r n1 x xi = -R^2 k_r n1 x n2 (A24 eq A6); there is no force. With the constants of c
	 * (PairConstants, or a bond's).
	 * Adding the torques is left to the caller: returned is the factor of n1 x n2. */
	template <class Constants, class T> inline T addForces(const Constants& c, const Pointers<T>& p, ContactForces<T>& f)
	{
		f.rollingDisplacement = displacement(p, c.reducedRadius);
		return -(c.reducedRadius * c.reducedRadius * c.rollingStiffness);
	}

	// U_r = k_r xi^2/2
	template <class Constants, class T> inline T energy(const Constants& c, const Vec3<T>& xi)
	{
		return T(0.5) * c.rollingStiffness * dot(xi, xi);
	}

	// Limit: |xi| > xi_crit
	template <class T> inline MaskOf<T> beyondLimit(const PairConstants<T>& c, const Vec3<T>& xi)
	{
		return c.criticalRolling * c.criticalRolling < dot(xi, xi);
	}
	/* The pointers with xi another `by` along e and the sliding displacement as it is, to first order: each moves by `by` over r_i (Wada's
	 * -excess/(2R) for equal radii), and the anchor on a plane by `by`. */
	template <class T> inline Pointers<T> moved(const Pointers<T>& p, const T& by, const T& r1, const T& r2, const Vec3<T>& e)
	{
		return { movedPointer(p.n1, by, r1, e), movedPointer(p.n2, by, r2, e) };
	}
	template <class T> inline PlanePointers<T> moved(const PlanePointers<T>& p, const T& by, const T& r1, const T&, const Vec3<T>& e)
	{
		return { { movedPointer(p.n1, by, r1, e), p.n2 }, movedAnchor(p, by, e) };
	}
	// With xi returned to the limit.
	template <class SomePointers, class T>
	inline SomePointers returned(const SomePointers& p, const T& r1, const T& r2, const Vec3<T>& xi, const T& limit)
	{
		const T squared = dot(xi, xi), inverse = inverseRoot(squared), excess = squared * inverse - limit;
		return moved(p, -excess, r1, r2, inverse * xi);
	}
	// With xi another `by`.
	template <class SomePointers> inline SomePointers displaced(const SomePointers& p, double r1, double r2, const Vec3<double>& by)
	{
		const double length = std::sqrt(dot(by, by));
		return length == 0 ? p : moved(p, length, r1, r2, (1 / length) * by);
	}
	// What the return of displacement `trial` to pointers p, which moved them by `moved`, dissipates; `before`: the displacement a step
	// ago.
	template <class T>
	inline T dissipation(const PairConstants<T>& c, const Vec3<T>& before, const Vec3<T>& trial, const Pointers<T>& p,
	        const Pointers<T>& moved, const Turning<T>& t)
	{
		const Vec3<T> further = t.dt * rate(moved, c.reducedRadius, t);
		return slipDissipation(c.rollingStiffness, before, trial, displacement(p, c.reducedRadius), further);
	}

} // namespace rolling
} // namespace contact_law
