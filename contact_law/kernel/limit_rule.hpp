// What happens to a spring whose displacement passes its limit, by the names that scripts use.
#pragma once
#include <iterator>
#include <string>

namespace contact_law {

enum class LimitRule {
	Held, // the displacement is returned to the limit, with its direction kept (Wada et al. 2007): returnToLimits() of contact.hpp
	Cut   // the spring is cut there, and a new one without strain takes its place (Sirono & Ueno 2017): cut.hpp
};
constexpr const char* limitRuleNames[] = { "held", "cut" };

// Of the rule with a name; -1: there is none.
inline int limitRuleNumber(const std::string& name)
{
	for (int k = 0; k < int(std::size(limitRuleNames)); ++k)
		if (name == limitRuleNames[k]) return k;
	return -1;
}

} // namespace contact_law
