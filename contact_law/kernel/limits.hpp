// When a spring is beyond its limit, and the rule of Wada et al. (2007) for what happens then: the displacement is returned to the limit with its
// direction kept, and the work that this takes is dissipated. The other rule, of Sirono & Ueno (2017), is cut.hpp.
#pragma once
#include "contact.hpp"

namespace contact_law {

enum class LimitRule {
	Held, // the displacement is returned to the limit, with its direction kept (Wada et al. 2007): returnToLimits()
	Cut   // the spring is cut there, and a new one without strain takes its place (Sirono & Ueno 2017): cutAtLimits() of cut.hpp
};
constexpr const char* limitRuleNames[] = { "held", "cut" };

/* Grains that slide with resistance and roll without: their pointers are freed of the rolling displacement whenever it is beyond the limit
 * of resisted rolling, which takes no force. Pointers that have rolled far from the contact would no longer tell how far grains slid. */
constexpr bool rollsFreely(unsigned mechanisms) { return mechanisms & Sliding && !(mechanisms & Rolling); }

// Whether a displacement is beyond its limit; f: the forces at this instant.
template <unsigned mechanisms, class T, class History>
inline MaskOf<T> beyondLimits(const PairConstants<T>& c, const ContactForces<T>& f, const History& h)
{
	MaskOf<T> beyond = T(1.) < T(0.);
	if constexpr (bool(mechanisms & Twisting)) beyond = beyond | twisting::beyondLimit(c, h.twist);
	if constexpr (bool(mechanisms & Sliding)) beyond = beyond | beyondLimit<SlidingSpring>(c, f.slidingDisplacement);
	if constexpr (bool(mechanisms & Rolling)) beyond = beyond | beyondLimit<RollingSpring>(c, f.rollingDisplacement);
	if constexpr (rollsFreely(mechanisms)) beyond = beyond | beyondLimit<RollingSpring>(c, RollingSpring::displacement(c, h.pointers));
	return beyond;
}

template <class T> struct Displacements {
	Vec3<T> sliding, rolling;
	T twist;
};

/* Return the displacements of `h` that are beyond their limits to them, and book what that dissipates (where `counted`);
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
	const Vec3<T> zeta = SlidingSpring::displacement(c, p, normal), xi = RollingSpring::displacement(c, p);
	MaskOf<T> slid = none < none, rolled = none < none;
	if constexpr (bool(mechanisms & Sliding)) {
		slid = beyondLimit<SlidingSpring>(c, zeta);
		if (anyOf(slid)) p = choose<T>(slid, returned<SlidingSpring>(c, p, zeta, c.criticalSliding), p);
	}
	if constexpr (bool(mechanisms & (Sliding | Rolling))) {
		rolled = beyondLimit<RollingSpring>(c, xi);
		const T limit = rollsFreely(mechanisms) ? none : c.criticalRolling;
		if (anyOf(rolled)) p = choose<T>(rolled, returned<RollingSpring>(c, p, RollingSpring::displacement(c, p), limit), p);
	}
	const MaskOf<T> pointersMoved = slid | rolled;
	if (!anyOf(pointersMoved)) return pointersMoved;
	const auto moved = way(trial, p);
	T bySliding = none, byRolling = none;
	if constexpr (bool(mechanisms & Sliding)) bySliding = slipDissipation<SlidingSpring>(c, normal, before.sliding, zeta, p, moved, t);
	if constexpr (bool(mechanisms & Rolling)) byRolling = slipDissipation<RollingSpring>(c, normal, before.rolling, xi, p, moved, t);
	const T both = bySliding + byRolling;
	if constexpr (rollsFreely(mechanisms)) rolled = none < none;
	lost.sliding = lost.sliding + choose(counted, choose(rolled, choose(slid, bySliding, none), both), none);
	lost.rolling = lost.rolling + choose(counted, choose(rolled, choose(slid, byRolling, both), none), none);
	return pointersMoved;
}

} // namespace contact_law
