// Those attributes of JKRWadaEngine that a run keeps from its start to its end.
#pragma once
#include "Refusal.hpp"
#include <string>

namespace yade {

constexpr const char* otherEngine = "; a new JKRWadaEngine takes the contacts over";

struct EngineSettings {
	int domains;
	std::string instructions;
	double linearDamping, slidingStiffnessFactor, neck;
	bool sliding, rolling, twisting;
	std::string limit;
	bool orientations;

	// visit(name, value before, value now), of each
	template <class Visit> static void each(const EngineSettings& before, const EngineSettings& now, Visit&& visit)
	{
		visit("domains", before.domains, now.domains);
		visit("instructions", before.instructions, now.instructions);
		visit("linearDamping", before.linearDamping, now.linearDamping);
		visit("slidingStiffnessFactor", before.slidingStiffnessFactor, now.slidingStiffnessFactor);
		visit("neck", before.neck, now.neck);
		visit("sliding", before.sliding, now.sliding);
		visit("rolling", before.rolling, now.rolling);
		visit("twisting", before.twisting, now.twisting);
		visit("limit", before.limit, now.limit);
		visit("orientations", before.orientations, now.orientations);
	}
	// Throws std::runtime_error for one that has been changed.
	void requireSame(const EngineSettings& now) const
	{
		each(*this, now, [](const char* name, const auto& was, const auto& is) {
			if (was != is)
				refuseInEngine(std::string(name) + " was changed after the start: it must stay " + text(was) + ", not "
				        + text(is) + otherEngine);
		});
	}
};

} // namespace yade
