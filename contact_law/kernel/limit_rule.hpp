// When a spring is beyond its limit, and the two rules for what happens then: held.hpp and cut.hpp.
#pragma once
#include "contact.hpp"
#include <iterator>
#include <string>

namespace contact_law {

enum class LimitRule {
	Held, // the displacement is returned to the limit, with its direction kept (Wada et al. 2007): returnToLimits() of held.hpp
	Cut   // the spring is cut there, and a new one without strain takes its place (Sirono & Ueno 2017): cutAtLimits() of cut.hpp
};
constexpr const char* limitRuleNames[] = { "held", "cut" };

// Of the rule with a name; -1: there is none.
inline int limitRuleNumber(const std::string& name)
{
	for (int k = 0; k < int(std::size(limitRuleNames)); ++k)
		if (name == limitRuleNames[k]) return k;
	return -1;
}

/* Grains that slide with resistance and roll without: their pointers are freed of the rolling displacement whenever it is beyond the limit
 * of resisted rolling, which takes no force. Pointers that have rolled far from the contact would no longer tell how far grains slid. */
constexpr bool rollsFreely(unsigned mechanisms) { return mechanisms & Sliding && !(mechanisms & Rolling); }

// Whether a displacement is beyond its limit; f: the forces at this instant.
template <unsigned mechanisms, class T>
inline MaskOf<T> beyondLimits(const PairConstants<T>& c, const ContactForces<T>& f, const ContactHistory<T>& h)
{
	MaskOf<T> beyond = T(1.) < T(0.);
	if constexpr (bool(mechanisms & Twisting)) beyond = beyond | twisting::beyondLimit(c, h.twist);
	if constexpr (bool(mechanisms & Sliding)) beyond = beyond | sliding::beyondLimit(c, f.slidingDisplacement);
	if constexpr (bool(mechanisms & Rolling)) beyond = beyond | rolling::beyondLimit(c, f.rollingDisplacement);
	if constexpr (rollsFreely(mechanisms))
		beyond = beyond | rolling::beyondLimit(c, rolling::displacement(h.pointers, c.reducedRadius));
	return beyond;
}

} // namespace contact_law
