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
	// The pointers with xi returned to the limit and the sliding displacement as it is: each moves by -excess/r_i (Wada's -excess/(2R)
	// for equal radii).
	template <class T> inline Pointers<T> returned(const Pointers<T>& p, const T& r1, const T& r2, const Vec3<T>& xi, const T& limit)
	{
		const T squared = dot(xi, xi), inverse = inverseRoot(squared), excess = squared * inverse - limit;
		const Vec3<T> e = inverse * xi;
		return { movedPointer(p.n1, -excess, r1, e), movedPointer(p.n2, -excess, r2, e) };
	}
	// On a plane (R = r1) the anchor goes with the grain's pointer.
	template <class T>
	inline PlanePointers<T> returned(const PlanePointers<T>& p, const T& r1, const T&, const Vec3<T>& xi, const T& limit)
	{
		const T squared = dot(xi, xi), inverse = inverseRoot(squared), excess = squared * inverse - limit;
		const Vec3<T> e = inverse * xi;
		return { { movedPointer(p.n1, -excess, r1, e), p.n2 }, movedAnchor(p, -excess, e) };
	}
	// The pointers with xi another `by` and the sliding displacement as it is, to first order.
	inline Pointers<double> displaced(const Pointers<double>& p, double r1, double r2, const Vec3<double>& by)
	{
		const double length = std::sqrt(dot(by, by));
		if (length == 0) return p;
		const Vec3<double> e = (1 / length) * by;
		return { movedPointer(p.n1, length, r1, e), movedPointer(p.n2, length, r2, e) };
	}
	inline PlanePointers<double> displaced(const PlanePointers<double>& p, double r1, double, const Vec3<double>& by)
	{
		const double length = std::sqrt(dot(by, by));
		if (length == 0) return p;
		const Vec3<double> e = (1 / length) * by;
		return { { movedPointer(p.n1, length, r1, e), p.n2 }, movedAnchor(p, length, e) };
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
