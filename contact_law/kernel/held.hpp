// The rule of Wada et al. (2007) for displacements beyond their limits: they are returned to the limit with their direction kept, and the work
// that this takes is dissipated. (The rule of Sirono & Ueno 2017 is cut.hpp.) A template over the number type: the fused engine does it by packs.
#pragma once
#include "limit_rule.hpp"

namespace contact_law {

template <class T> struct Displacements {
	Vec3<T> sliding, rolling;
	T twist;
};

/* Return the displacements of `h` that are beyond their limits to them, and book what that dissipates (of lanes that are `counted`);
 * true where pointers moved.
 * `before`: the displacements a step ago, `t`: the way from there. Returning one displacement changes the other a little (second order
 * in the pointers' angles):
 * that too is work, and goes with the slip. */
template <unsigned mechanisms, class T, class History>
inline MaskOf<T> returnToLimits(const PairConstants<T>& c, const Vec3<T>& normal, const Displacements<T>& before, const Turning<T>& t,
        History& h, const MaskOf<T>& counted, DissipationOf<T>& lost)
{
	const T none(0.);
	auto& p = h.pointers;
	if constexpr (bool(mechanisms & Twisting)) {
		const T trial = h.twist;
		h.twist = twisting::returned(c, trial);
		lost.twisting = lost.twisting + choose(counted, twisting::dissipation(c, before.twist, trial, h.twist), none);
	}
	const auto trial = p;
	const Vec3<T> zeta = sliding::displacement(p, c.radius1, c.radius2, normal), xi = rolling::displacement(p, c.reducedRadius);
	MaskOf<T> slid = none < none, rolled = none < none;
	if constexpr (bool(mechanisms & Sliding)) {
		slid = sliding::beyondLimit(c, zeta);
		if (anyOf(slid)) p = choose<T>(slid, sliding::returned(p, c.radius1, c.radius2, zeta, c.criticalSliding), p);
	}
	if constexpr (bool(mechanisms & (Sliding | Rolling))) {
		rolled = rolling::beyondLimit(c, xi);
		const T limit = rollsFreely(mechanisms) ? none : c.criticalRolling;
		if (anyOf(rolled))
			p = choose<T>(
			        rolled, rolling::returned(p, c.radius1, c.radius2, rolling::displacement(p, c.reducedRadius), limit), p);
	}
	const MaskOf<T> pointersMoved = slid | rolled;
	if (!anyOf(pointersMoved)) return pointersMoved;
	const auto moved = way(trial, p);
	T bySliding = none, byRolling = none;
	if constexpr (bool(mechanisms & Sliding)) bySliding = sliding::dissipation(c, normal, before.sliding, zeta, p, moved, t);
	if constexpr (bool(mechanisms & Rolling)) byRolling = rolling::dissipation(c, before.rolling, xi, p, moved, t);
	const T both = bySliding + byRolling;
	if constexpr (rollsFreely(mechanisms)) rolled = none < none;
	lost.sliding = lost.sliding + choose(counted, choose(rolled, choose(slid, bySliding, none), both), none);
	lost.rolling = lost.rolling + choose(counted, choose(rolled, choose(slid, byRolling, both), none), none);
	return pointersMoved;
}

} // namespace contact_law
