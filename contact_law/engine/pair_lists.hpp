/* Neighbours of a domain's grains, by groups, and when to check whether they touch. A group's pairs hold until its grains and those of
 * groups nearby may have come closer by the skin: then this group's are searched for anew, and no others. The distance of a pair that
 * does not touch is checked again in the step in which its gap, its closing speed and the bound on kicks nearby allow a touch. Nothing
 * here changes a result: whatever the lists, a contact forms in the step in which two grains overlap. */
#pragma once
#include "neighbour_search.hpp"
#include <algorithm>
#include <vector>

namespace contact_law {

struct SharedState;

// ---- groups: stretches of the grains' order that are leaves of a k-d tree (grain_order.cpp) ----

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

/* What the neighbour lists know of a group (pair_lists.hpp). Its own domain writes all of it; other domains read ranges, bounds and
 * boxes, in another part of a step than that in which they are written. */
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

// ---- the lists of a domain's groups ----

// What a step does for the lists, the same in all domains.
struct ListWork {
	bool boxes = false, check = false; // measure boxes and find groups nearby; check the lists
	bool all = false;                  // check the distances of all pairs: velocities have changed otherwise than by kicks
	int steps = 0, stepsToNext = 0;    // since the latest check; to the next
	double moved = 0, across = 0;      // by how much boundaries have moved images since the latest check, and do in a step [m]
};

class PairLists {
public:
	PairLists(SharedState& shared, int begin, int end);

	Group& group(int grain); // that the grain, one of the domain's own, is in

	// ---- searching: measureBoxes of all domains, then findNearby, then search ----

	void measureBoxes();
	void findNearby(const PeriodicCell&, double reach); // groups with boxes closer than this [m]
	void searchAnew(const PeriodicCell&); // for all, of grains in a new order: no pair touches until touch() is called for it

	void check(const PeriodicCell&, const ListWork&); // to hold to the next check (when kicks exceed their bounds, that comes at once)
	bool holdToNext() const { return holds; }         // otherwise one step only
	void clearAfterCheck();                           // ranges and bounds begin anew

	// ---- distance checks ----

	void beginStep()
	{
		if (++step == endOfCount) countAnew();
	}
	// Pairs that overlap and do not touch; they are checked again in the next step unless touch() is called for them.
	const std::vector<NeighbourPair>& overlapping(const PeriodicCell&);
	void touch(int i, int j); // both of some pair of this domain; nothing happens to one that is not listed
	void part(int i, int j);

	// visit(i, j), i < j, for all pairs that do not touch
	template <class Visit> void each(Visit&& visit) const
	{
		for (const Group& group : own())
			for (std::size_t k = 0; k < group.pairs.size(); ++k)
				if (group.next[k] != Group::never) visit(group.pairs[k].first(), group.pairs[k].second());
	}

	long searches = 0, distanceChecks = 0; // groups searched for, distances of pairs checked so far

private:
	struct Stretch {
		Group *from, *to;
		Group* begin() const { return from; }
		Group* end() const { return to; }
	};
	Stretch own() const;
	void countAnew(); // steps from 0 on: runs of more than Group::never steps go on
	Box boxOf(const Group&) const;
	void search(Group&, const PeriodicCell&);
	void gatherCandidates(const Group&, const PeriodicCell&);
	int* nextOf(int i, int j);
	void findScheduled();
	void findScheduled(Group&, int part);
	void fetchAhead(const Group*) const;
	void checkDistance(Group&, int index, const PeriodicCell&);
	int stepsUntilTouch(const Group&, double gap, double closing) const;

	SharedState& s;
	int begin, end, firstGroup, endGroup, firstCluster, endCluster;
	static constexpr int endOfCount = Group::never - 10000;
	int step = endOfCount - 1000; // so that many runs, not only the longest, pass the end
	bool holdsNow = false;        // by the latest check
	bool holds = false; // likewise from clearAfterCheck() on: other threads read it in the part of a step in which check() is called
	Candidates candidates;
	std::vector<NeighbourPair> foundPairs, overlaps;
	struct Scheduled {
		Group* group;
		int index; // of the pair, or of the stretch of pairs
	};
	std::vector<Scheduled> scheduled, scheduledStretches; // pairs to check now, and stretches that have any
	std::vector<int> foundNext, found;
};

} // namespace contact_law
