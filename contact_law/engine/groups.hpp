// Grains in groups of neighbours: stretches of their order that are leaves of a k-d tree (grain_order.cpp).
#pragma once
#include "arrays.hpp"
#include <algorithm>
#include <vector>

namespace contact_law {

constexpr int grainsInGroup = 128;

struct NeighbourPair {
	int own, other; // a grain of the group, and another one: of the same domain, then with a higher index, or of another domain
	bool operator<(const NeighbourPair& p) const { return own != p.own ? own < p.own : other < p.other; }
	int first() const { return own < other ? own : other; }
	int second() const { return own < other ? other : own; }
};

struct Box { // around grains' centres [m]
	double low[3] { 1e300, 1e300, 1e300 }, high[3] { -1e300, -1e300, -1e300 };

	void include(const double* lowest, const double* highest)
	{
		for (int k = 0; k < 3; ++k)
			low[k] = std::min(low[k], lowest[k]), high[k] = std::max(high[k], highest[k]);
	}
	void include(const double* x) { include(x, x); }
	void include(const Box& other) { include(other.low, other.high); }
	double edge(int axis) const { return high[axis] - low[axis]; }
	Vec3<double> centre() const { return { 0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2]) }; }
};

// Some groups of a domain that follow each other, with a box around theirs: one comparison tells that all of them are far away.
struct alignas(64) GroupCluster {
	static constexpr int most = 8;
	int first, last; // groups, the last one not among them
	Box box;
};

/* What the neighbour lists know of a group (pair_lists.hpp). Its own domain writes all of it; other domains read ranges, bounds and boxes, in another part of a step
 * than that in which they are written. */
struct alignas(64) Group {
	VelocityRange sinceCheck; // of its grains since the latest check
	VelocityRange sinceTrial; // since the bounds were last tried for being too wide
	VelocityRange bound;      // in which all velocities of its grains have been; widened at once when one leaves it
	double kickBound = 0;     // likewise for kicks [m/s]
	int checksSinceTrial = 0;
	int first, last;                  // grains, the last one not among them
	Box box;                          // when boxes were measured
	std::vector<int> nearby;          // groups whose grains may be neighbours of its own, itself among them, by rising number
	double kickNearby = 0;            // largest of their bounds on kicks at the latest check
	double speedNearby = 0;           // bound on the relative velocity of its grains and theirs, likewise [m/s]
	double approach = 0;              // bound on how far its grains and theirs have come closer since its pairs were found [m]
	std::vector<NeighbourPair> pairs; // with a gap below SharedState::skin when they were found, in order
	std::vector<int> next;            // by pair: the step of its next distance check; never: it touches
	std::vector<int> soonestOf;       // of these, by stretch of pairs
	int soonest = 0;                  // of all

	static constexpr int never = 2147483647, stretch = 16;

	int endOfStretch(int part) const { return std::min((part + 1) * stretch, int(next.size())); } // the pair behind its last one

	// A pair's distance is to be checked in a step, at the latest.
	void schedule(int pair, int step)
	{
		next[pair] = step;
		soonestOf[pair / stretch] = std::min(soonestOf[pair / stretch], step);
		soonest = std::min(soonest, step);
	}
	void scheduleAll()
	{
		for (int& step : next)
			if (step != never) step = 0;
		std::fill(soonestOf.begin(), soonestOf.end(), 0);
		soonest = 0;
	}

	// After a step: its grains' velocities and kicks in it. Returns whether they keep within the bounds.
	bool keepsWithin(const VelocityRange& latest)
	{
		sinceCheck.join(latest);
		const double kick = latest.largestKick();
		if (kick <= kickBound && bound.holds(latest)) return true;
		kickBound = std::max(kickBound, 2 * kick);
		bound.join(sinceCheck);
		widen();
		return false;
	}
	// Bounds that have become far too wide are narrowed, and widened in no direction: other groups still rely on those that they know.
	void clearAfterCheck(double leastKick)
	{
		sinceTrial.join(sinceCheck);
		sinceCheck.clear();
		if (++checksSinceTrial < 16) return;
		checksSinceTrial = 0;
		kickBound = std::min(kickBound, std::max({ leastKick, 0.5 * kickBound, 2 * sinceTrial.largestKick() }));
		if (bound.diagonal() > 4 * sinceTrial.diagonal() + 8 * kickBound) {
			const VelocityRange wide = bound;
			bound = sinceTrial;
			widen();
			for (int k = 0; k < 3; ++k)
				bound.least[k] = std::max(bound.least[k], wide.least[k]),
				bound.most[k] = std::min(bound.most[k], wide.most[k]);
		}
		sinceTrial.clear();
	}

private:
	// To twice the range, and by what kicks may add.
	void widen()
	{
		for (int k = 0; k < 3; ++k) {
			const double by = 0.5 * (bound.most[k] - bound.least[k]) + kickBound;
			bound.least[k] -= by, bound.most[k] += by;
		}
	}
};

} // namespace contact_law
