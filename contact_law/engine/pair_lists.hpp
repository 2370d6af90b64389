/* Neighbours of a domain's grains, by groups, and when to check whether they touch.
 * A group's pairs hold until its grains and those of groups nearby may have come closer by the skin: then this group's are searched for anew, and no others. The distance of
 * a pair that does not touch is checked again in the step in which its gap, its closing speed and the bound on kicks nearby allow a touch.
 * Nothing here changes a result: whatever the lists, a contact forms in the step in which two grains overlap. */
#pragma once
#include "groups.hpp"
#include "neighbour_search.hpp"

namespace contact_law {

struct SharedState;

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
