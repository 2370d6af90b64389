// Grains in groups of neighbours: stretches of their order that are leaves of a k-d tree (grain_order.cpp).
#pragma once
#include "arrays.hpp"
#include <vector>

namespace contact_law {

constexpr int grainsInGroup = 128;

struct NeighbourPair {
	int own, other; // a grain of the group, and another one: of the same domain, then with a higher index, or of another domain
	bool operator<(const NeighbourPair& p) const { return own != p.own ? own < p.own : other < p.other; }
	int first() const { return own < other ? own : other; }
	int second() const { return own < other ? other : own; }
};

/* What the neighbour lists know of a group (pair_lists.hpp). Its own domain writes all of it; other domains read ranges, bounds and boxes, in another part of a step
 * than that in which they are written. */
struct alignas(64) Group {
	VelocityRange sinceCheck; // of its grains since the latest check
	double kickBound = 0;     // no kick of its grains has been larger [m/s]; raised at once when one is
	int first, last;          // grains, the last one not among them
	double low[3], high[3];   // around the grains' centres when boxes were measured
	std::vector<int> nearby;  // groups whose grains may be neighbours of its own, itself among them, by rising number
	double kickNearby = 0;    // largest of their bounds at the latest check
	double approach = 0;      // bound on how far its grains and theirs have come closer since its pairs were found [m]
	std::vector<NeighbourPair> pairs; // with a gap below Setting::farGap when they were found, in order
	std::vector<int> next;            // by pair: the step in which to look at it again; never: it touches
	int soonest = 0;                  // of these

	static constexpr int never = 2147483647;
};

} // namespace contact_law
