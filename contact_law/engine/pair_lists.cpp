#include "pair_lists.hpp"
#include "dynamics.hpp"
#include <algorithm>

namespace contact_law {

PairLists::PairLists(SharedState& shared, int begin_, int end_)
        : s(shared)
        , begin(begin_)
        , end(end_)
        , firstGroup(int(shared.groups.size()))
        , firstCluster(int(shared.clusters.size()))
{
	for (int first = begin; first < end; first += grainsInGroup) {
		s.groups.emplace_back();
		s.groups.back().first = first;
		s.groups.back().last = std::min(first + grainsInGroup, end);
		s.groups.back().kickBound = s.leastKick;
	}
	endGroup = int(s.groups.size());
	for (int first = firstGroup; first < endGroup; first += GroupCluster::most)
		s.clusters.push_back({ first, std::min(first + GroupCluster::most, endGroup), {} });
	endCluster = int(s.clusters.size());
}

PairLists::Stretch PairLists::own() const { return { s.groups.data() + firstGroup, s.groups.data() + endGroup }; }
Group& PairLists::group(int grain) { return s.groups[firstGroup + (grain - begin) / grainsInGroup]; }

Box PairLists::boxOf(const Group& group) const
{
	Box box;
	for (int i = group.first; i < group.last; ++i)
		box.include(&s.grains[i].x);
	return box;
}

void PairLists::measureBoxes()
{
	for (int c = firstCluster; c < endCluster; ++c) {
		GroupCluster& cluster = s.clusters[c];
		cluster.box = {};
		for (int g = cluster.first; g < cluster.last; ++g) {
			s.groups[g].box = boxOf(s.groups[g]);
			cluster.box.include(s.groups[g].box);
		}
	}
}

namespace {
	// Whether two boxes, or images of them, are within reach of each other.
	bool areNear(const Box& a, const Box& b, const PeriodicCell& cell, double reach)
	{
		Vec3<double> centres = a.centre() - b.centre();
		nearestImage(cell, centres);
		double squared = 0;
		for (int k = 0; k < 3; ++k) {
			const double apart = std::abs((&centres.x)[k]) - 0.5 * (a.edge(k) + b.edge(k));
			if (apart > 0) squared += apart * apart;
		}
		return squared <= reach * reach;
	}
}

void PairLists::findNearby(const PeriodicCell& cell, double reach)
{
	for (Group& group : own()) {
		group.nearby.clear();
		for (const GroupCluster& cluster : s.clusters) {
			if (!areNear(group.box, cluster.box, cell, reach)) continue;
			for (int g = cluster.first; g < cluster.last; ++g)
				if (areNear(group.box, s.groups[g].box, cell, reach)) group.nearby.push_back(g);
		}
	}
}

void PairLists::gatherCandidates(const Group& group, const PeriodicCell& cell)
{
	const Box box = boxOf(group); // now, not when boxes were measured
	const double reach = 2 * s.largestRadius + s.skin;
	const Vec3<double> half { 0.5 * box.edge(0) + reach, 0.5 * box.edge(1) + reach, 0.5 * box.edge(2) + reach };
	candidates.clear();
	for (const int g : group.nearby) {
		const Group& its = s.groups[g];
		candidates.makeRoomFor(its.last - its.first);
		s.passes->addInBox[cell.on](
		        { s.grains.data(), s.radius.data(), cell, box.centre(), half, its.first, its.last }, candidates);
	}
}

void PairLists::search(Group& group, const PeriodicCell& cell)
{
	gatherCandidates(group, cell);
	found.resize(std::max(found.size(), std::size_t(candidates.count + lanes)));
	foundPairs.clear();
	int lower = 0, above = 0; // candidates of domains before this one; up to the grain
	while (lower < candidates.count && candidates.grain[lower] < begin)
		++lower;
	for (int i = group.first; i < group.last; ++i) {
		while (above < candidates.count && candidates.grain[above] <= i)
			++above;
		const auto compare = [&](int first, int last) {
			const int count = s.passes->closeGrains[cell.on](
			        { candidates, cell, s.grains[i], s.radius[i] + s.skin, first, last }, found.data());
			for (int k = 0; k < count; ++k)
				foundPairs.push_back({ i, found[k] });
		};
		if (lower > 0) compare(0, lower);
		compare(above, candidates.count);
	}
	foundNext.assign(foundPairs.size(), step);
	std::size_t at = 0; // pairs that touch keep doing so
	for (std::size_t k = 0; k < group.pairs.size(); ++k) {
		if (group.next[k] != Group::never) continue;
		while (at < foundPairs.size() && foundPairs[at] < group.pairs[k])
			++at;
		if (at < foundPairs.size() && !(group.pairs[k] < foundPairs[at])) foundNext[at] = Group::never;
	}
	group.pairs.swap(foundPairs);
	group.next.swap(foundNext);
	group.soonestOf.assign((group.next.size() + Group::stretch - 1) / Group::stretch, 0);
	group.soonest = 0;
	group.approach = 0;
	++searches;
}

void PairLists::searchAnew(const PeriodicCell& cell)
{
	for (Group& group : own()) {
		group.pairs.clear();
		group.next.clear();
		search(group, cell);
	}
}

void PairLists::check(const PeriodicCell& cell, const ListWork& work)
{
	holdsNow = true;
	for (Group& group : own()) {
		VelocityRange around, bound;
		double kicks = 0;
		for (const int g : group.nearby) {
			around.join(s.groups[g].sinceCheck);
			bound.join(s.groups[g].bound);
			kicks = std::max(kicks, s.groups[g].kickBound);
		}
		const double speed = bound.diagonal() + work.across / s.dt;
		const double perStep = s.dt * around.diagonal();
		const double ahead = (work.stepsToNext - 1) * (perStep + work.across + s.dt * 2 * work.stepsToNext * kicks);
		group.approach += work.steps * perStep + work.moved;
		if (group.approach + ahead > s.skin)
			search(group, cell);
		else if (work.all || kicks > group.kickNearby || speed > group.speedNearby)
			group.scheduleAll();
		group.kickNearby = kicks;
		group.speedNearby = speed;
		holdsNow = holdsNow && ahead <= s.skin;
	}
}

void PairLists::countAnew()
{
	step = 0;
	for (Group& group : own())
		group.scheduleAll();
}

void PairLists::clearAfterCheck()
{
	holds = holdsNow;
	for (Group& group : own())
		group.clearAfterCheck(s.leastKick);
}

const std::vector<NeighbourPair>& PairLists::overlapping(const PeriodicCell& cell)
{
	constexpr std::size_t ahead = 8;
	findScheduled();
	overlaps.clear();
	for (std::size_t k = 0; k < scheduled.size(); ++k) {
		if (k + ahead < scheduled.size()) {
			const NeighbourPair& coming = scheduled[k + ahead].group->pairs[scheduled[k + ahead].index];
			__builtin_prefetch(&s.grains[coming.own]);
			__builtin_prefetch(&s.grains[coming.other]);
			__builtin_prefetch(&s.radius[coming.own]);
			__builtin_prefetch(&s.radius[coming.other]);
		}
		checkDistance(*scheduled[k].group, scheduled[k].index, cell);
	}
	distanceChecks += long(scheduled.size());
	return overlaps;
}

// What findScheduled() will read of groups behind this one: with 100,000 grains they are not in the cache.
void PairLists::fetchAhead(const Group* group) const
{
	const Group* end = own().end();
	if (end - group > 4) {
		__builtin_prefetch(&group[4].soonest);
		__builtin_prefetch(&group[4].soonestOf);
	}
	if (end - group > 2) __builtin_prefetch(group[2].soonestOf.data());
}

// Stretches of pairs first: the steps of their pairs are fetched from memory in the meantime.
void PairLists::findScheduled()
{
	scheduledStretches.clear();
	for (Group& group : own()) {
		fetchAhead(&group);
		if (group.soonest > step) continue;
		group.soonest = Group::never;
		for (int part = 0; part < int(group.soonestOf.size()); ++part)
			if (group.soonestOf[part] <= step) {
				scheduledStretches.push_back({ &group, part });
				__builtin_prefetch(&group.next[part * Group::stretch]);
				__builtin_prefetch(&group.next[group.endOfStretch(part) - 1]);
			} else
				group.soonest = std::min(group.soonest, group.soonestOf[part]);
	}
	scheduled.clear();
	for (const auto& [group, part] : scheduledStretches)
		findScheduled(*group, part);
}

void PairLists::findScheduled(Group& group, int part)
{
	const int last = group.endOfStretch(part);
	int soonest = Group::never;
	for (int k = part * Group::stretch; k < last; ++k)
		if (group.next[k] <= step) {
			scheduled.push_back({ &group, k });
			__builtin_prefetch(&group.pairs[k]); // for overlapping()
		} else
			soonest = std::min(soonest, group.next[k]);
	group.soonestOf[part] = soonest;
	group.soonest = std::min(group.soonest, soonest);
}

void PairLists::checkDistance(Group& group, int index, const PeriodicCell& cell)
{
	const NeighbourPair p = group.pairs[index];
	Vec3<double> separation = separationOf(s.grains[p.own], s.grains[p.other]);
	const Image image = nearestImage(cell, separation);
	const Vec3<double> velocity = velocityOf(s.grains[p.own]) - velocityOf(s.grains[p.other]) + image.velocity;
	const double squared = dot(separation, separation), reach = s.radius[p.own] + s.radius[p.other];
	int next = step + 1;
	if (squared <= reach * reach)
		overlaps.push_back(p);
	else {
		const double distance = std::sqrt(squared);
		next = step + stepsUntilTouch(group, distance - reach, -dot(separation, velocity) / distance);
	}
	group.schedule(index, next);
}

/* In k steps two grains come closer by k closing dt + k (k + 1) a dt at most, when no kick changes a velocity by more than a: the
 * distance of two straight lines is convex in time, so the closing speed now is the largest there is without kicks. And by no more than
 * their largest relative velocity allows, to which a periodic cell's rate may add leastKick a step, from one O.step to the next. */
int PairLists::stepsUntilTouch(const Group& group, double gap, double closing) const
{
	constexpr double most = 1000;
	if (s.dt == 0) return 1; // the forces at the start
	const double a = (group.kickNearby + s.leastKick) * s.dt, b = a + closing * s.dt;
	const double root = std::sqrt(b * b + 4 * a * gap), byKicks = b > 0 ? 2 * gap / (b + root) : (root - b) / (2 * a);
	const double bySpeed = gap / (s.dt * (group.speedNearby + most * s.leastKick));
	return std::max(1, int(0.999999 * std::min(most, std::max(byKicks, bySpeed))));
}

int* PairLists::nextOf(int i, int j)
{
	const bool ownFirst = i >= begin && i < end;
	Group& g = group(ownFirst ? i : j);
	const NeighbourPair pair = ownFirst ? NeighbourPair { i, j } : NeighbourPair { j, i };
	const auto at = std::lower_bound(g.pairs.begin(), g.pairs.end(), pair);
	if (at == g.pairs.end() || pair < *at) return nullptr;
	return &g.next[at - g.pairs.begin()];
}

void PairLists::touch(int i, int j)
{
	if (int* next = nextOf(i, j)) *next = Group::never;
}

void PairLists::part(int i, int j)
{
	int* next = nextOf(i, j);
	if (!next) return;
	Group& g = group(i >= begin && i < end ? i : j);
	g.schedule(int(next - g.next.data()), step + 1);
}

// ---- when lists are checked, and when they are made anew ----

namespace {
	constexpr double mostStepsToCheck = 8; // from one check of the neighbour lists to the next
	constexpr double boxMargin = 3;        // how much further groups are taken for nearby than they need be, over the largest radius
}

void Dynamics::makeLists()
{
	for (auto& domain : domains)
		domain->lists.measureBoxes();
	setMostCells();
#pragma omp parallel for num_threads(threadCount())
	for (auto& domain : domains) {
		domain->lists.findNearby(cell(), reach() + boxMargin * shared.largestRadius);
		domain->lists.searchAnew(cell());
		domain->touching.markIn(domain->lists);
		domain->planes.outdate();
	}
	listAge = {};
}

void Dynamics::outdateLists()
{
	if (listAge.outdated) return; // a script may set every grain
	for (Group& group : shared.groups)
		group.approach = 2 * shared.skin;
	for (auto& domain : domains)
		domain->planes.outdate();
	listAge.outdated = true;
}

/* After a step's drift, before its forces. Groups' ranges since the latest check tell how far each group's grains may have come closer
 * to others; for the steps to come their kicks are bounded, and a kick beyond its bound brings the next check at once. */
ListWork Dynamics::listWork(ListAge& age, const VelocityRange& range, const Vec3<double>& growth) const
{
	const Vec3<double> moved = Images<double>::times(mostCells, growth);
	ListWork work;
	work.across = std::sqrt(dot(moved, moved));
	const double approach = shared.dt * range.diagonal() + work.across; // an image moves with its cell
	age.sinceBoxes += approach;
	++age.sinceCheck;
	age.moved += work.across; // step by step: the cell's rate may change between two checks
	const bool early = std::any_of(domains.begin(), domains.end(), [](const auto& domain) { return domain->mustCheck(); });
	if (!(age.outdated || early || age.sinceCheck >= age.checkAfter)) return work;
	work.check = true;
	work.all = age.outdated;
	work.steps = age.sinceCheck;
	work.moved = age.moved;
	work.stepsToNext = int(std::max(1., std::min(mostStepsToCheck, 0.2 * shared.skin / approach)));
	work.boxes = age.outdated || age.sinceBoxes > 0.5 * boxMargin * shared.largestRadius;
	if (work.boxes) age.sinceBoxes = 0;
	age.sinceCheck = 0;
	age.moved = 0;
	age.checkAfter = work.stepsToNext;
	age.outdated = false;
	return work;
}

void Dynamics::keepLists(int d, const ListWork& work)
{
	Domain& domain = *domains[d];
	if (work.boxes) {
		if (d == 0) setMostCells();
		domain.lists.findNearby(domain.cell, reach() + boxMargin * shared.largestRadius);
	}
	if (work.check) domain.lists.check(domain.cell, work);
}

} // namespace contact_law
