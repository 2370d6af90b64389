// When the neighbour lists are checked, and when they are made anew.
#include "dynamics.hpp"

namespace contact_law {

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

/* After a step's drift, before its forces. Groups' ranges since the latest check tell how far each group's grains may have come closer to others; for the steps to come
 * their kicks are bounded, and a kick beyond its bound brings the next check at once. */
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
