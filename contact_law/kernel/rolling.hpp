// Rolling: a spring on how far two grains have rolled on each other (Wada et al. 2007; A24 appendix A, eqs A2, A6), with a limit, the
// material's xi_crit.
// k_r: A22 eq 14. n1, n2: contact pointers.
#pragma once
#include "pair_constants.hpp"
#include "pointers.hpp"

namespace contact_law {

// c: PairConstants, or a bond's.
struct RollingSpring {
	static constexpr unsigned mechanism = Rolling;

	template <class Constants> ON_GPU static auto stiffness(const Constants& c) { return c.rollingStiffness; }
	template <class T> ON_GPU static T limit(const PairConstants<T>& c) { return c.criticalRolling; } // xi_crit

	// xi = R (n1 + n2) (A24 eq A2)
	template <class Constants, class T> ON_GPU static Vec3<T> displacement(const Constants& c, const Pointers<T>& p)
	{
		return c.reducedRadius * (p.n1 + p.n2);
	}
	// As SlidingSpring's.
	template <class Constants, class T> ON_GPU static Vec3<T> displacement(const Constants& c, const Pointers<T>& p, const Vec3<T>&)
	{
		return displacement(c, p);
	}
	template <class T> ON_GPU static Vec3<T> rate(const PairConstants<T>& c, const Pointers<T>& p, const Vec3<T>&, const Turning<T>& t)
	{
		return c.reducedRadius * (cross(t.spin1, p.n1) + cross(t.spin2, p.n2));
	}

	// Displacement, and torques M_r1 = -R k_r n1 x xi = -R^2 k_r n1 x n2 (A24 eq A6); there is no force. Adding the torques is left to
	// the caller: returned is the factor of n1 x n2.
	template <class Constants, class T> ON_GPU static T addForces(const Constants& c, const Pointers<T>& p, ContactForces<T>& f)
	{
		f.rollingDisplacement = displacement(c, p);
		return -(c.reducedRadius * c.reducedRadius * c.rollingStiffness);
	}

	/* The pointers with xi another `by` along e and the sliding displacement as it is, to first order: each moves by `by` over r_i (Wada's
	 * -excess/(2R) for equal radii), and the anchor on a plane by `by`. */
	template <class T> ON_GPU static Pointers<T> moved(const PairConstants<T>& c, const Pointers<T>& p, const T& by, const Vec3<T>& e)
	{
		return { movedPointer(p.n1, by, c.radius1, e), movedPointer(p.n2, by, c.radius2, e) };
	}
	template <class T>
	ON_GPU static PlanePointers<T> moved(const PairConstants<T>& c, const PlanePointers<T>& p, const T& by, const Vec3<T>& e)
	{
		return { { movedPointer(p.n1, by, c.radius1, e), p.n2 }, movedAnchor(p, by, e) };
	}
};

} // namespace contact_law
