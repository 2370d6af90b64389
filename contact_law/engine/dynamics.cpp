#include "contacts.hpp"
#include <algorithm>
#include <numeric>
#include <omp.h>
#include <set>
#include <stdexcept>

namespace contact_law {

namespace {
	std::vector<Vec3<double>> positionsOf(const std::vector<GrainInput>& grains)
	{
		std::vector<Vec3<double>> positions;
		for (const GrainInput& g : grains)
			positions.push_back(g.position);
		return positions;
	}

	constexpr long stepsBetweenTrials = 2000;              // of the grains' order; a new one takes the time of some twenty-five steps
	constexpr double reorderThreshold = 1.1;               // groups are put in order again when their edges have grown by this
	constexpr int grainsInDomain = 6000, mostDomains = 64; // at least, and at most, where the scene decides
}

Dynamics::Dynamics(const Grains& grains, const Materials& materials, const Options& options_)
{
	prepare(grains, materials, options_);
	orderGrains(positionsOf(grains));
	loadGrains(grains);
	makeDomains();
	makeLists();
	sizesWhenOrdered = groupSizes();
	for (auto& domain : domains)
		shared.neck > 0 ? domain->touching.placeBonds(domain->lists, cell())
		                : domain->touching.placeOverlapping(domain->lists, cell());
	firstForces();
}

Dynamics::Dynamics(const Grains& grains, const Materials& materials, const Options& options_, const Inherited& inherited)
{
	prepare(grains, materials, options_);
	std::set<double> necks;
	for (const Inherited::Pair& one : inherited.contacts)
		if (one.neck > 0) necks.insert(one.neck);
	shared.necks.assign(necks.begin(), necks.end());
	orderGrains(positionsOf(grains));
	loadGrains(grains);
	makeDomains();
	inherit(inherited);
	sizesWhenOrdered = groupSizes();
}

void Dynamics::prepare(const Grains& grains, const Materials& materials, const Options& options_)
{
	if (grains.empty()) throw std::invalid_argument("no grains: at least one sphere is needed");
	options = options_;
	count = int(grains.size());
	for (const GrainInput& g : grains)
		ids.push_back(g.id);
	indexHere.resize(count);
	shared.passes = &instructionSet(options.instructions);
	shared.material = materials;
	shared.planes = options.planes;
	shared.pairs = options.pairs;
	shared.neck = options.neck;
	if (shared.neck > 0) shared.necks = { shared.neck };
	shared.mechanisms = options.mechanisms;
	shared.limit = options.limit;
	shared.dt = options.dt;
	shared.convective = options.convective;
}

void Dynamics::loadGrains(const Grains& grains)
{
	for (int k = 0; k < count; ++k) {
		const GrainInput& g = grains[original[k]];
		shared.grains.push_back(Grain {});
		copyMotion(g, shared.grains.back());
		shared.grainRadius.push_back(g.radius);
		shared.kind.push_back(g.kind);
		shared.blocked.push_back(g.blocked);
		if (options.orientations) shared.orientation.push_back(g.orientation);
		shared.inverseMass.push_back(1 / g.mass);
		shared.inverseInertia.push_back(1 / g.inertia);
		shared.uniform = shared.uniform && g.radius == grains[original[0]].radius && g.kind == grains[original[0]].kind;
	}
	shrinkGrains();
}

// The radii that ordinary contacts see, and all that follows from them and from the necks.
void Dynamics::shrinkGrains()
{
	const double shrunk = neck::shrunkRadius(shared.neck);
	shared.radius.resize(count);
	for (int k = 0; k < count; ++k)
		shared.radius[k] = shrunk * shared.grainRadius[k];
	const auto [smallest, largest] = std::minmax_element(shared.radius.begin(), shared.radius.end());
	shared.smallestRadius = *smallest;
	shared.largestRadius = *largest;
	shared.setLeastKick();
	const Material& m = shared.material[shared.kind[0]];
	const double r = shared.grainRadius[0];
	shared.common = deriveShrunkPair(m, r, m, r, shared.pairs, shared.neck);
	if (shared.neck > 0)
		shared.commonBond = deriveBond(m, r, m, r, shared.pairs, shared.necks.size() == 1 ? shared.necks[0] : shared.neck);
	shared.skin = std::max(0.8 * shared.smallestRadius, 1.1 * mostStretched(*this));
}

int Dynamics::domainCount() const
{
	if (options.domains > 0) return std::min(options.domains, count);
	int domains = 2;
	while (domains < mostDomains && count / (2 * domains) >= grainsInDomain)
		domains *= 2;
	return std::min(domains, count);
}

void Dynamics::makeDomains()
{
	shared.grains.resize(count + 2 * domainCount());
	for (int d = 0; d < domainCount(); ++d)
		domains.push_back(std::make_unique<Domain>(shared, beginOf(d), beginOf(d + 1), count + 2 * d));
	for (auto& domain : domains)
		domain->cell = options.cell;
	for (int k = 0; k < count; ++k)
		if (shared.blocked[k]) domainOf(k).constraints.block(shared.grains.data(), k, shared.blocked[k]);
}

Domain& Dynamics::domainOf(int index)
{
	std::size_t d = 0;
	while (index >= domains[d]->end)
		++d;
	return *domains[d];
}

Dynamics::Counters Dynamics::counters() const
{
	Counters c = countedBefore;
	c.contactUpdates += contactUpdates;
	c.orders += orders;
	for (const auto& domain : domains) {
		c.searches += double(domain->lists.searches) / double(shared.groups.size());
		c.distanceChecks += domain->lists.distanceChecks;
	}
	return c;
}

// Until grains have moved by more than a radius or two.
void Dynamics::setMostCells()
{
	if (!cell().on) return;
	Box all;
	for (const Group& group : shared.groups)
		all.include(group.box);
	const Vec3<double>& size = cell().size;
	mostCells = { all.edge(0) / size.x + 1, all.edge(1) / size.y + 1, all.edge(2) / size.z + 1 };
}

/* The forces at the start, of contacts that have just been placed, without moving: a step of zero length turns nothing.
 * Then velocities go half a step back, where the leapfrog keeps them. */
void Dynamics::firstForces()
{
	for (auto& domain : domains)
		domain->touching.sort();
	takeVelocities();
	const double dt = shared.dt;
	shared.dt = 0;
	addForces();
	shared.dt = dt;
	kickAll(-0.5 * dt);
	takeVelocities();
}

void Dynamics::takeVelocities()
{
	for (auto& domain : domains)
		domain->touching.takeVelocities(cell()), domain->planes.takeVelocities();
	velocitiesSet = false;
}

void Dynamics::addForces()
{
	for (auto& domain : domains)
		domain->addFirstForces();
	for (auto& domain : domains)
		domain->addOtherForces(false);
}

// A run as one of its threads makes it; all threads take the same decisions from the same numbers. Returns the steps made.
long Dynamics::runThread(long steps, const Vec3<double>& growth, const Vec3<double>& sizeAtEnd, Shares shares, Barrier& barrier)
{
	const Vec3<double> rate = (1 / shared.dt) * growth;
	ListAge age = listAge;
	if (std::sqrt(dot(mostCells, mostCells)) * std::sqrt(dot(rate - cell().rate, rate - cell().rate)) > shared.leastKick)
		age.outdated = true;
	const double fastest = fastestThatHolds();
	shares.each([&](int d) { domains[d]->integrate(); });
	for (long step = 1; step <= steps; ++step) {
		barrier.wait(shares.threads);
		const VelocityRange range = velocities();
		if (range.fastestComponent() > fastest || isTooDeep()) return step - 1;
		const ListWork lists = listWork(age, range, growth);
		if (lists.boxes) {
			shares.each([&](int d) { domains[d]->lists.measureBoxes(); });
			barrier.wait(shares.threads);
		}
		shares.each([&](int d) {
			domains[d]->cell.advance(sizeAtEnd - double(steps - step) * growth, rate);
			domains[d]->planes.advance();
			keepLists(d, lists);
			domains[d]->addFirstForces();
		});
		barrier.wait(shares.threads);
		shares.each([&](int d) {
			if (lists.check) domains[d]->lists.clearAfterCheck();
			domains[d]->addOtherForces(step < steps);
		});
	}
	if (shares.thread == 0) listAge = age;
	return steps;
}

VelocityRange Dynamics::velocities() const
{
	VelocityRange all;
	for (const auto& domain : domains)
		all.join(domain->latestVelocities());
	return all;
}

long Dynamics::run(long steps, const Vec3<double>* sizeAtEnd)
{
	const Vec3<double> from = cell().size, to = sizeAtEnd ? *sizeAtEnd : from;
	for (long made = 0; made < steps;) {
		if (stepsSinceTrial >= stepsBetweenTrials) {
			stepsSinceTrial = 0;
			if (groupSizes() > reorderThreshold * sizesWhenOrdered) reorder();
		}
		// what a script has moved is moved for the first step only
		const long most = shared.displaced.empty() ? stepsBetweenTrials - stepsSinceTrial : 1, asked = std::min(most, steps - made);
		const long here = runEvenly(asked, from + (double(made + asked) / double(steps)) * (to - from));
		shared.displaced.clear();
		stepsSinceTrial += here, made += here;
		if (here < asked) return made;
	}
	return steps;
}

long Dynamics::runEvenly(long steps, const Vec3<double>& to)
{
	if (velocitiesSet) takeVelocities();
	Barrier barrier;
	std::vector<Share> all(domains.size());
	long made = steps;
	const Vec3<double> growth = (1. / double(steps)) * (to - cell().size);
#pragma omp parallel num_threads(threadCount())
	{ // of fewer threads where OpenMP has no more (OMP_THREAD_LIMIT, OMP_DYNAMIC)
		const long here = runThread(steps, growth, to, Shares(all, omp_get_thread_num(), omp_get_num_threads()), barrier);
		if (omp_get_thread_num() == 0) made = here;
	}
	contactUpdates += made * contactCount(*this);
	return made;
}

// In a step a grain may go half the smallest radius along an axis: beyond that two of them pass each other unseen, and forces have long
// lost their meaning.
double Dynamics::fastestThatHolds() const { return 0.5 * shared.smallestRadius / shared.dt; }

void Dynamics::read(std::vector<GrainMotion>& grains) const
{
	grains.resize(count);
#pragma omp parallel for num_threads(threadCount())
	for (int k = 0; k < count; ++k) {
		// they lie anywhere: fetched ahead, the writing waits less (2 % of a run to 0.6 %)
		const char* coming = reinterpret_cast<const char*>(&grains[original[std::min(k + 16, count - 1)]]);
		__builtin_prefetch(coming, 1);
		__builtin_prefetch(coming + 64, 1);
		Grain p = shared.grains[k];
		GrainMotion& g = grains[original[k]];
		kick(shared, p, k, 0.5 * shared.dt);
		copyMotion(p, g);
		g.blocked = shared.blocked[k];
		if (options.orientations) g.orientation = shared.orientation[k];
	}
	for (const auto& domain : domains)
		for (const EarlyKick& early : domain->ledger.early) {
			Grain change {};
			contact_law::kickEarly(shared, early, change, shared.dt);
			GrainMotion& g = grains[original[early.grain]];
			g.velocity = g.velocity + velocityOf(change);
			g.angularVelocity = g.angularVelocity + spinOf(change);
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
	const Booked all = booked(*this);
	e.dissipated = all.lost;
	e.constraintWork = all.constraintWork;
	e.externalWork = all.externalWork;
	for (std::size_t d = 0; d < domains.size(); ++d) {
		e.stored += stored[d];
		e.kinetic += kinetic[d] + convective[d];
		e.boundaryWork += domains[d]->ledger.boundaryWork() - convective[d];
	}
	return e;
}

double Dynamics::totalEnergy()
{
	const auto values = byChannel(energies());
	return std::accumulate(values.begin(), values.end(), 0.);
}

} // namespace contact_law
