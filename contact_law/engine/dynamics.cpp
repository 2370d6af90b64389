#include "exchange.hpp"
#include <algorithm>
#include <omp.h>
#include <stdexcept>

namespace contact_law {

namespace {
	constexpr double stepsOfNearPairs = 16; // that lists of near pairs should last where grains are fast (measured)
}

Dynamics::Dynamics(const Grains& grains, const Materials& materials, const Options& options_)
        : options(options_)
{
	prepare(grains, materials);
	orderGrains(grains);
	loadGrains(grains);
	makeDomains();
	refreshLists(Lists::FarAndNear);
	for (auto& domain : domains)
		setting.neck > 0 ? domain->placeBonds() : domain->placeOverlapping();
	firstForces();
}

Dynamics::Dynamics(const Grains& grains, const Materials& materials, const Options& options_, const Inherited& inherited)
        : options(options_)
{
	prepare(grains, materials);
	setting.necks = inherited.necks();
	orderGrains(grains);
	loadGrains(grains);
	makeDomains();
	inherit(inherited);
}

void Dynamics::prepare(const Grains& grains, const Materials& materials)
{
	if (grains.empty()) throw std::invalid_argument("no grains: at least one sphere is needed");
	count = int(grains.size());
	setting.passes = &instructionSet(options.instructions);
	setting.material = materials;
	setting.linearDamping = options.linearDamping;
	setting.neck = options.neck;
	if (setting.neck > 0) setting.necks = { setting.neck };
	setting.mechanisms = options.mechanisms;
	setting.limit = options.limit;
	setting.dt = options.dt;
	setting.convective = options.convective;
}

void Dynamics::loadGrains(const Grains& grains)
{
	indexHere.resize(count);
	for (int k = 0; k < count; ++k) {
		const GrainInput& g = grains[original[k]];
		indexHere[original[k]] = k;
		setting.grains.push_back(Grain {});
		copyMotion(g, setting.grains.back());
		setting.grainRadius.push_back(g.radius);
		setting.kind.push_back(g.kind);
		setting.blocked.push_back(g.blocked);
		if (options.orientations) setting.orientation.push_back(g.orientation);
		setting.inverseMass.push_back(1 / g.mass);
		setting.inverseInertia.push_back(1 / g.inertia);
		setting.uniform = setting.uniform && g.radius == grains[original[0]].radius && g.kind == grains[original[0]].kind;
	}
	shrinkGrains();
}

void copyMotion(const GrainMotion& g, Grain& grain)
{
	grain.x = g.position[0], grain.y = g.position[1], grain.z = g.position[2];
	grain.vx = g.velocity[0], grain.vy = g.velocity[1], grain.vz = g.velocity[2];
	grain.wx = g.angularVelocity[0], grain.wy = g.angularVelocity[1], grain.wz = g.angularVelocity[2];
}

void copyMotion(const Grain& grain, GrainMotion& g)
{
	g.position[0] = grain.x, g.position[1] = grain.y, g.position[2] = grain.z;
	g.velocity[0] = grain.vx, g.velocity[1] = grain.vy, g.velocity[2] = grain.vz;
	g.angularVelocity[0] = grain.wx, g.angularVelocity[1] = grain.wy, g.angularVelocity[2] = grain.wz;
}

void Dynamics::set(int index, const GrainMotion& now)
{
	const int k = indexHere[index];
	Grain& p = setting.grains[k];
	if (now.blocked != setting.blocked[k]) {
		domainOf(k).constraints.block(setting.grains.data(), k, now.blocked);
		setting.blocked[k] = now.blocked;
	}
	if (options.orientations) setting.orientation[k] = now.orientation;
	const Vec3<double> from = positionOf(p);
	copyMotion(now, p);
	setting.displace(k, positionOf(p) - from);
	kick(setting, p, k, -0.5 * setting.dt);
	travelSinceFar = travelSinceNear = setting.farGap; // whatever the distance: look for neighbours anew
}

void kick(const Setting& setting, Grain& p, int k, double time)
{
	const double m = time * setting.inverseMass[k], i = time * setting.inverseInertia[k];
	const Vec3<double>& c = setting.convective; // grows with the velocity before the kick
	if (time > 0) p.vx *= 1 + time * c.x, p.vy *= 1 + time * c.y, p.vz *= 1 + time * c.z;
	p.vx += m * p.fx, p.vy += m * p.fy, p.vz += m * p.fz;
	p.wx += i * p.tx, p.wy += i * p.ty, p.wz += i * p.tz;
	if (time < 0) p.vx /= 1 - time * c.x, p.vy /= 1 - time * c.y, p.vz /= 1 - time * c.z;
}

void Dynamics::makeDomains()
{
	const int domainCount = std::max(1, std::min(options.domains, count));
	setting.grains.resize(count + 2 * domainCount);
	if (setting.hasDrag()) setting.previous.assign(count + 2 * domainCount, PreviousVelocity {});
	for (int d = 0; d < domainCount; ++d)
		domains.push_back(std::make_unique<Domain>(
		        setting, int(long(count) * d / domainCount), int(long(count) * (d + 1) / domainCount), count + 2 * d));
	for (auto& domain : domains)
		domain->cell = options.cell;
	for (int k = 0; k < count; ++k)
		if (setting.blocked[k]) domainOf(k).constraints.block(setting.grains.data(), k, setting.blocked[k]);
}

Domain& Dynamics::domainOf(int index)
{
	std::size_t d = 0;
	while (index >= domains[d]->end)
		++d;
	return *domains[d];
}

template <class Mine, class Wait> void Dynamics::buildGrid(bool firstThread, Mine&& mine, Wait&& wait)
{
	const Grain* grains = setting.grains.data();
	if (firstThread) grid.begin(int(domains.size()), count);
	wait();
	mine([&](Domain& domain, int d) { grid.measure(d, grains, domain.begin, domain.end); });
	wait();
	if (firstThread) grid.layOut(reach(), cell());
	wait();
	mine([&](Domain&, int d) { grid.countGrains(d, grains); });
	wait();
	mine([&](Domain&, int d) { grid.sum(d); });
	wait();
	mine([&](Domain&, int d) { grid.findStarts(d); });
	wait();
	mine([&](Domain&, int d) { grid.place(d, grains, setting.radius.data()); });
}

void Dynamics::refreshLists(Lists which)
{
	if (which == Lists::FarAndNear) {
		const auto each = [&](auto&& what) {
			for (std::size_t d = 0; d < domains.size(); ++d)
				what(*domains[d], int(d));
		};
		buildGrid(true, each, [] {});
		setMostCells();
		each([&](Domain& domain, int) { domain.findPairs(grid, nearGap); });
		travelSinceFar = 0;
	} else {
		for (auto& domain : domains)
			domain->findNearPairs(nearGap);
	}
	travelSinceNear = 0;
}

/* The forces at the start, of contacts that have just been placed, without moving: a step of zero length books no event and turns nothing.
 * Then velocities go half a step back, where the leapfrog keeps them. */
void Dynamics::firstForces()
{
	refreshLists(Lists::Near);
	for (auto& domain : domains)
		domain->sortContacts();
	const double dt = setting.dt;
	setting.dt = 0;
	if (setting.hasDrag())
		for (int g = 0; g < count; ++g)
			setting.previous[g] = { setting.grains[g].vx, setting.grains[g].vy, setting.grains[g].vz, 0 };
	addForces();
	setting.dt = dt;
	for (int g = 0; g < count; ++g)
		kick(setting, setting.grains[g], g, -0.5 * dt);
}

void Dynamics::addForces()
{
	for (auto& domain : domains)
		domain->addFirstForces();
	for (auto& domain : domains)
		domain->addOtherForces(false);
}

// A run as one of its threads makes it; all threads take the same decisions from the same numbers. Returns the steps made.
long Dynamics::runThread(long steps, const Vec3<double>& growth, const Vec3<double>& sizeAtEnd, int thread, int threads, Barrier& barrier)
{
	const auto mine = [&](auto&& what) {
		for (std::size_t d = thread; d < domains.size(); d += threads)
			what(*domains[d], int(d));
	};
	const auto wait = [&] { barrier.wait(); };
	const Vec3<double> rate = (1 / setting.dt) * growth;
	double sinceFar = travelSinceFar, sinceNear = travelSinceNear, gap = nearGap;
	const double fastest = fastestThatHolds();
	mine([](Domain& domain, int) { domain.integrate(); });
	for (long step = 1; step <= steps; ++step) {
		barrier.wait();
		const VelocityRange range = velocities();
		if (range.fastestComponent() > fastest) return step - 1;
		mine([&](Domain& domain, int) { domain.cell.advance(sizeAtEnd - double(steps - step) * growth, rate); });
		const Vec3<double> across = Images<double>::times(mostCells, growth); // an image moves with its cell
		const double approach = setting.dt * range.diagonal() + std::sqrt(dot(across, across));
		sinceFar += approach;
		sinceNear += approach;
		if (sinceNear > gap) {
			gap = nearGapFor(approach);
			const bool farToo = sinceFar + gap > setting.farGap;
			if (farToo) {
				buildGrid(thread == 0, mine, wait);
				if (thread == 0) setMostCells();
				mine([](Domain& domain, int) { domain.sortContacts(); });
				barrier.wait();
				mine([&](Domain& domain, int) { domain.findPairs(grid, gap); });
				sinceFar = 0;
			} else
				mine([&](Domain& domain, int) { domain.findNearPairs(gap); });
			sinceNear = 0;
			if (thread == 0) ++(farToo ? counted.farRebuilds : counted.nearRebuilds);
		}
		mine([](Domain& domain, int) { domain.addFirstForces(); });
		barrier.wait();
		mine([=](Domain& domain, int) { domain.addOtherForces(step < steps); });
	}
	if (thread == 0) {
		travelSinceFar = sinceFar;
		travelSinceNear = sinceNear;
		nearGap = gap;
	}
	return steps;
}

VelocityRange Dynamics::velocities() const
{
	VelocityRange all;
	for (const auto& domain : domains)
		all.join(domain->velocities);
	return all;
}

/* Looking through the near pairs, each step, and finding them among the far ones, each time the grains may have come closer by the gap, should cost about
 * the same; given: by how much they may in a step. */
double Dynamics::nearGapFor(double approach) const
{
	const double r = setting.smallestRadius;
	return std::max(0.03 * r, std::min(stepsOfNearPairs * approach, 0.25 * r));
}

long Dynamics::run(long steps, const Vec3<double>* sizeAtEnd)
{
	const Vec3<double> from = cell().size, to = sizeAtEnd ? *sizeAtEnd : from;
	if (setting.displaced.empty() || steps == 1) {
		const long made = runEvenly(steps, to);
		setting.displaced.clear();
		return made;
	}
	// what a script has moved is moved for the first step only
	const long first = runEvenly(1, from + (1. / double(steps)) * (to - from));
	setting.displaced.clear();
	return first < 1 ? first : first + runEvenly(steps - 1, to);
}

long Dynamics::runEvenly(long steps, const Vec3<double>& to)
{
	const int threads = threadCount();
	Barrier barrier(threads);
	long made = steps;
	const Vec3<double> growth = (1. / double(steps)) * (to - cell().size);
#pragma omp parallel num_threads(threads)
	{
		const long here = runThread(steps, growth, to, omp_get_thread_num(), threads, barrier);
		if (omp_get_thread_num() == 0) made = here;
	}
	counted.contactUpdates += made * contactCount(*this);
	return made;
}

// In a step a grain may go half the smallest radius: beyond that two of them pass each other unseen, and forces have long lost their meaning.
double Dynamics::fastestThatHolds() const { return 0.5 * setting.smallestRadius / setting.dt; }

void Dynamics::read(std::vector<GrainMotion>& grains) const
{
	grains.resize(count);
#pragma omp parallel for num_threads(threadCount())
	for (int k = 0; k < count; ++k) {
		// they lie anywhere: fetched ahead, the writing waits less (2 % of a run to 0.6 %)
		const char* coming = reinterpret_cast<const char*>(&grains[original[std::min(k + 16, count - 1)]]);
		__builtin_prefetch(coming, 1);
		__builtin_prefetch(coming + 64, 1);
		Grain p = setting.grains[k];
		GrainMotion& g = grains[original[k]];
		kick(setting, p, k, 0.5 * setting.dt);
		copyMotion(p, g);
		g.blocked = setting.blocked[k];
		if (options.orientations) g.orientation = setting.orientation[k];
	}
}

// Domains side by side, then added up in their order: the same bits on any number of threads.
Energies Dynamics::energies()
{
	std::vector<StoredEnergy<double>> stored(domains.size());
	std::vector<double> kinetic(domains.size()), convective(domains.size());
#pragma omp parallel for num_threads(threadCount())
	for (std::size_t d = 0; d < domains.size(); ++d) {
		stored[d] = domains[d]->energies();
		kinetic[d] = domains[d]->kineticEnergy();
		convective[d] = domains[d]->convectiveWork();
	}
	Energies e;
	e.dissipated = dissipated(*this);
	for (std::size_t d = 0; d < domains.size(); ++d) {
		e.stored += stored[d];
		e.kinetic += kinetic[d] + convective[d];
		e.boundaryWork += domains[d]->sums.boundary.done + domains[d]->sums.meanField - convective[d];
		e.constraintWork += domains[d]->constraints.work;
	}
	return e;
}

} // namespace contact_law
