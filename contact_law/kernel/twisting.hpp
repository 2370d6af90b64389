// Twisting: a spring on the angle phi by which two grains have turned against each other about the normal (A24 appendix A, eqs A4, A7),
// with a limit (A22 eq 24).
// k_t: A22 eq 23.
#pragma once
#include "pair_constants.hpp"
#include "pointers.hpp"

namespace contact_law {
namespace twisting {

	/* phi grows by (w1 - w2).n dt (A24 eq A4), n taken half-way through the step so that the angle is of second order in dt:
	 * half a step ago the normal was n - dt/2 (v - (v.n) n)/distance, v the velocity of grain 1 past grain 2. */
	template <class T>
	inline T increment(const Vec3<T>& n, const T& inverseDistance, const Vec3<T>& velocity, const Vec3<T>& spin, const T& dt)
	{
		const T along = dot(spin, n);
		return dt * (along - T(0.5) * dt * inverseDistance * (dot(spin, velocity) - along * dot(velocity, n)));
	}

	// Torques -+k_t phi n (A24 eq A7)
	template <class Constants, class T>
	inline void addTorques(const Constants& c, const ContactGeometry<T>& g, const T& twist, ContactForces<T>& f)
	{
		const Vec3<T> torque = (c.twistingStiffness * twist) * g.normal;
		f.torque1 = f.torque1 - torque;
		f.torque2 = f.torque2 + torque;
	}

	// U_t = k_t phi^2/2 (A22 eq 22, where k_r is a misprint)
	template <class Constants, class T> inline T energy(const Constants& c, const T& twist)
	{
		return T(0.5) * c.twistingStiffness * twist * twist;
	}

	// Limit: |phi| > phi_crit (A22 eq 24)
	template <class T> inline MaskOf<T> beyondLimit(const PairConstants<T>& c, const T& twist)
	{
		return c.criticalTwisting < absolute(twist);
	}
	// The angle returned to the limit where it is beyond.
	template <class T> inline T returned(const PairConstants<T>& c, const T& twist)
	{
		const T limit = choose(twist < T(0.), -c.criticalTwisting, c.criticalTwisting);
		return choose(beyondLimit(c, twist), limit, twist);
	}
	// What the return from `trial` to `after` dissipates; `before`: the angle a step ago. As slipDissipation(), without pointers.
	template <class T> inline T dissipation(const PairConstants<T>& c, const T& before, const T& trial, const T& after)
	{
		return T(0.5) * c.twistingStiffness * (before + after) * (trial - after);
	}

} // namespace twisting
} // namespace contact_law
