// Displacements beyond their limits are put back onto them, and the work that this takes is booked (Wada et al. 2007; A24 appendix A; MODEL.md).
#pragma once
#include "contact.hpp"

namespace contact_law {

/* A pointer moved along the unit vector e by move/radius. Renormalising takes back (n.e)^2 of a move (Wada et al. 2007): it goes that much further;
 * both are done at once, and without a division. */
template <class T> inline Vec3<T> movedPointer(const Vec3<T>& pointer, const T& move, const T& radius, const Vec3<T>& e)
{
	const T along = dot(pointer, e);
	const Vec3<T> moved = (radius * (T(1.) - along * along)) * pointer + move * e;
	return inverseRoot(dot(moved, moved)) * moved;
}

/* The pointers with the sliding displacement zeta back on its limit and the rolling one as it is (to first order):
 * both pointers move oppositely by the excess over r1 + r2 (Wada's +-excess/(2 r) for equal radii; MODEL.md on unlike ones). */
template <class T> inline Pointers<T> slidBack(const Pointers<T>& p, const T& r1, const T& r2, const Vec3<T>& zeta, const T& limit)
{
	const T squared = dot(zeta, zeta), inverse = inverseRoot(squared), excess = squared * inverse - limit;
	const Vec3<T> e = inverse * zeta;
	return { movedPointer(p.n1, -excess, r1 + r2, e), movedPointer(p.n2, excess, r1 + r2, e) };
}

/* The pointers with the rolling displacement xi back on its limit and the sliding one as it is: each pointer moves by -excess/r_i
 * (Wada's -excess/(2R) for equal radii). */
template <class T> inline Pointers<T> rolledBack(const Pointers<T>& p, const T& r1, const T& r2, const Vec3<T>& xi, const T& limit)
{
	const T squared = dot(xi, xi), inverse = inverseRoot(squared), excess = squared * inverse - limit;
	const Vec3<T> e = inverse * xi;
	return { movedPointer(p.n1, -excess, r1, e), movedPointer(p.n2, -excess, r2, e) };
}

/* The energy that a slip takes in one step of a kick-drift-kick integrator. The kicks use the forces before the step (displacement
 * `before`) and after the putting back (`after`), so that the motion loses k/2 (before + after).(trial - before), of which
 * k/2 (after^2 - before^2) is stored. The last kick's lever arms are those of the pointers put back: over the step their displacement would have
 * changed by `further` more than the one that was put back, and that too the kick takes. */
template <class T>
inline T slipDissipation(const T& stiffness, const Vec3<T>& before, const Vec3<T>& trial, const Vec3<T>& after, const Vec3<T>& further)
{
	return T(0.5) * stiffness * (dot(before + after, trial - after) + dot(after, further));
}

// How the grains moved through the step.
template <class T> struct Turning {
	Vec3<T> normalRate, spin1, spin2; // dn/dt, angular velocities
	T dt;
};

template <class T> inline Vec3<T> normalRate(const Vec3<T>& normal, const T& inverseDistance, const Vec3<T>& velocity)
{
	return inverseDistance * (velocity - dot(velocity, normal) * normal);
}

template <class T> struct Displacements {
	Vec3<T> sliding, rolling;
	T twist;
};

template <class T> struct Slip {
	T sliding, rolling, twisting; // energies dissipated
	MaskOf<T> pointersMoved;
};

template <class T> inline Pointers<T> choose(const MaskOf<T>& m, const Pointers<T>& yes, const Pointers<T>& no)
{
	const auto each = [&](const Vec3<T>& a, const Vec3<T>& b) {
		return Vec3<T> { choose(m, a.x, b.x), choose(m, a.y, b.y), choose(m, a.z, b.z) };
	};
	return { each(yes.n1, no.n1), each(yes.n2, no.n2) };
}

/* Put the displacements of `h` that are beyond their limits back onto them; `before`: the displacements a step ago, `t`: the way from there.
 * Putting one displacement back changes the other a little (second order in the pointers' angles): that too is work, and goes with the slip. */
template <unsigned mechanisms, class T>
inline Slip<T> slip(
        const PairConstants<T>& c, const Vec3<T>& normal, const Displacements<T>& before, const Turning<T>& t, ContactHistory<T>& h)
{
	const T none(0.);
	Slip<T> lost { none, none, none, none < none };
	const T &r1 = c.radius1, &r2 = c.radius2;
	Pointers<T>& p = h.pointers;
	if constexpr (bool(mechanisms & Twisting)) {
		const T trial = h.twist, limit = choose(trial < none, -c.criticalTwisting, c.criticalTwisting);
		h.twist = choose(c.criticalTwisting < absolute(trial), limit, trial);
		lost.twisting = T(0.5) * c.twistingStiffness * (before.twist + h.twist) * (trial - h.twist);
	}
	const Pointers<T> trial = p;
	const Vec3<T> zeta = sliding::displacement(p, r1, r2, normal), xi = rolling::displacement(p, c.reducedRadius);
	MaskOf<T> slid = none < none, rolled = none < none;
	if constexpr (bool(mechanisms & Sliding)) {
		slid = c.criticalSliding * c.criticalSliding < dot(zeta, zeta);
		if (anyOf(slid)) p = choose<T>(slid, slidBack(p, r1, r2, zeta, c.criticalSliding), p);
	}
	if constexpr (bool(mechanisms & Rolling)) {
		rolled = c.criticalRolling * c.criticalRolling < dot(xi, xi);
		if (anyOf(rolled))
			p = choose<T>(rolled, rolledBack(p, r1, r2, rolling::displacement(p, c.reducedRadius), c.criticalRolling), p);
	}
	lost.pointersMoved = slid | rolled;
	if (!anyOf(lost.pointersMoved)) return lost;
	const Pointers<T> moved { p.n1 - trial.n1, p.n2 - trial.n2 };
	T bySliding = none, byRolling = none;
	if constexpr (bool(mechanisms & Sliding)) {
		const Vec3<T> further = t.dt * sliding::rate(moved, r1, r2, normal, t.normalRate, t.spin1, t.spin2);
		bySliding = slipDissipation(c.slidingStiffness, before.sliding, zeta, sliding::displacement(p, r1, r2, normal), further);
	}
	if constexpr (bool(mechanisms & Rolling)) {
		const Vec3<T> further = t.dt * rolling::rate(moved, c.reducedRadius, t.spin1, t.spin2);
		byRolling = slipDissipation(c.rollingStiffness, before.rolling, xi, rolling::displacement(p, c.reducedRadius), further);
	}
	const T both = bySliding + byRolling;
	lost.sliding = choose(rolled, choose(slid, bySliding, none), both);
	lost.rolling = choose(rolled, choose(slid, byRolling, both), none);
	return lost;
}

} // namespace contact_law
