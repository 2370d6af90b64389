#include "domain.hpp"
#include <algorithm>

namespace contact_law {

Domain::Domain(SharedState& shared, int begin_, int end_, int dummy_)
        : begin(begin_)
        , end(end_)
        , lists(shared, begin_, end_)
        , touching(shared, begin_, end_, dummy_)
        , ledger(cell)
        , planes(shared, ledger, begin_, end_)
        , s(shared)
        , dummy(dummy_)
        , events(shared, cell, lists, touching, ledger)
        , callers { { this, Interior }, { this, FirstOwned }, { this, SecondOwned } }
{
}

// ---- forces ----

template <class Pass, class List> Pass Domain::passOver(List& list, Ownership o)
{
	Pass pass {};
	pass.grains = s.grains.data();
	pass.cell = &cell;
	pass.endBlock = list.blockCount();
	pass.addFirst = ownsFirst(o);
	pass.addSecond = ownsSecond(o);
	pass.dummy = dummy;
	pass.dt = s.dt;
	pass.crossing = ledger.sumsFor(o).crossing;
	pass.owner = &callers[o];
	pass.blocks = list.data();
	pass.constants = list.constantsData();
	return pass;
}

ForcePass Domain::passFor(Ownership o)
{
	ForcePass pass = passOver<ForcePass>(touching.contacts[o], o);
	pass.uniform = &s.common;
	pass.drags = touching.contacts[o].dragData();
	pass.dampings = touching.contacts[o].dampingData();
	pass.springDamping = s.pairs.springDamping;
	pass.dissipated = ledger.sumsFor(o).dissipated;
	pass.slips = ledger.sumsFor(o).slips;
	pass.events = &Domain::eventsOf<ContactBlock>;
	pass.cut = s.limit == LimitRule::Cut || !s.displaced.empty(); // slips after a script's move, like events, know what it was
	return pass;
}

BondPass Domain::bondPassFor(Ownership o)
{
	BondPass pass = passOver<BondPass>(touching.bonds[o], o);
	pass.uniform = &s.commonBond;
	pass.breaking = &Domain::eventsOf<BondBlock>;
	return pass;
}

template <class Block> void Domain::eventsOf(void* caller, int block, unsigned which, const Block& before, LaneForces& out)
{
	const Caller& c = *static_cast<Caller*>(caller);
	c.domain->events.of(c.ownership, block, which, before, out);
}

void Domain::moveBehind(void* caller, int batch)
{
	Domain& domain = *static_cast<Caller*>(caller)->domain;
	domain.completeAndIntegrateUpTo(domain.touching.completedBy(batch));
}

void Domain::addForces(Ownership o, int firstBlock, int endBlock, bool behind)
{
	ForcePass pass = passFor(o);
	pass.firstBlock = firstBlock;
	pass.endBlock = endBlock;
	if (behind) pass.batchDone = &Domain::moveBehind;
	s.passes->forces[s.mechanisms][s.uniform][cell.on](pass);
}

void Domain::addBondForces()
{
	for (const Ownership o : ownerships)
		if (touching.bonds[o].blockCount()) s.passes->bondForces[cell.on](bondPassFor(o));
}

void Domain::addFirstForces()
{
	lists.beginStep();
	touching.sortIfWorthwhile();
	ledger.beginStep(s.dt);
	outside.begin();
	constraints.begin();
	addForces(FirstOwned, 0, touching.contacts[FirstOwned].blockCount(), false);
	addForces(SecondOwned, 0, touching.contacts[SecondOwned].blockCount(), false);
	addForces(Interior, touching.order.sortedBlocks, touching.contacts[Interior].blockCount(), false);
	addBondForces();
	events.formContacts();
	planes.addForces(velocities);
}

void Domain::addOtherForces(bool behind)
{
	if (behind) beginMoving();
	addForces(Interior, 0, touching.order.sortedBlocks, behind);
	ledger.completeStep(s.dt);
	if (behind)
		completeAndIntegrateUpTo(end);
	else
		completeForces(end);
}

void Domain::completeForces(int grain)
{
	outside.add(s.grains.data(), s.dt, grain);
	constraints.withhold(s.grains.data(), s.dt, grain);
}

// Group by group, while its grains are in the cache.
void Domain::completeAndIntegrateUpTo(int grain)
{
	while (moved < grain) {
		const int to = std::min(grain, lists.group(moved).last);
		completeForces(to);
		integrateUpTo(to);
	}
}

// ---- kick and drift ----

void Domain::beginMoving()
{
	velocities.clear(), movedLatest.clear();
	boundExceeded = false;
	moved = begin;
}

void Domain::integrate()
{
	beginMoving();
	integrateUpTo(end);
}

void Domain::integrateUpTo(int grain)
{
	while (moved < grain) {
		Group& group = lists.group(moved);
		const int to = std::min(grain, group.last);
		if (s.convects()) convect(moved, to);
		s.passes->integrate(s.grains.data() + moved, s.grains.data() + to, s.inverseMass.data() + moved,
		        s.inverseInertia.data() + moved, s.dt, movedLatest);
		if (!s.orientation.empty())
			turnOrientations(s.grains.data() + moved, s.grains.data() + to, s.orientation.data() + moved, s.dt);
		moved = to;
		if (to == group.last) finishGroup(group);
	}
}

void Domain::finishGroup(Group& group)
{
	if (!group.keepsWithin(movedLatest)) boundExceeded = true;
	velocities.join(movedLatest);
	movedLatest.clear();
}

// The part of the convective acceleration in the kick to come, and its work: the impulse times the mean of the velocities before and after
// the kick.
void Domain::convect(int first, int last)
{
	Vec3<double> kicked { 0, 0, 0 };
	for (int k = first; k < last; ++k) {
		Grain& g = s.grains[k];
		const Vec3<double> before = velocityOf(g), gain = s.dt * Images<double>::times(s.convective, before);
		const Vec3<double> after = before + gain + (s.dt * s.inverseMass[k]) * Vec3<double> { g.fx, g.fy, g.fz };
		ledger.meanField -= 0.5 / s.inverseMass[k] * dot(gain, before + after);
		g.vx += gain.x, g.vy += gain.y, g.vz += gain.z;
		kicked.x = std::max(kicked.x, std::abs(gain.x)), kicked.y = std::max(kicked.y, std::abs(gain.y)),
		kicked.z = std::max(kicked.z, std::abs(gain.z));
	}
	movedLatest.kick[0] += kicked.x, movedLatest.kick[1] += kicked.y, movedLatest.kick[2] += kicked.z;
}

// ---- in another order ----

namespace {
	template <class OfGrain> void sortByGrain(std::vector<OfGrain>& all)
	{
		std::sort(all.begin(), all.end(), [](const OfGrain& a, const OfGrain& b) { return a.grain < b.grain; });
	}
	template <class OfGrain> std::vector<OfGrain> renumbered(std::vector<OfGrain> all, const std::vector<int>& to)
	{
		for (OfGrain& one : all)
			one.grain = to[one.grain];
		return all;
	}
}

Domain::Contents Domain::takeOut()
{
	Contents all;
	all.touching = touching.takeOut();
	all.constrained.swap(constraints.grains);
	all.outside.swap(outside.grains);
	all.onPlanes.swap(planes.contacts);
	return all;
}

void Domain::place(const Contents& all, const std::vector<int>& to)
{
	touching.place(all.touching, to);
	for (const Constrained& c : renumbered(all.constrained, to))
		if (touching.owns(c.grain)) constraints.grains.push_back(c);
	sortByGrain(constraints.grains);
	place(renumbered(all.outside, to));
	for (const PlaneContact& c : renumbered(all.onPlanes, to))
		planes.place(c);
}

void Domain::place(const std::vector<OutsideForce>& all)
{
	for (const OutsideForce& f : all)
		if (touching.owns(f.grain)) outside.grains.push_back(f);
	sortByGrain(outside.grains);
}

// ---- energies ----

StoredEnergy<double> Domain::energies()
{
	StoredEnergy<double> total { 0, 0, 0, 0 };
	for (const Ownership o : counted) {
		StoredEnergy<double> part { 0, 0, 0, 0 };
		s.passes->energies[s.mechanisms][s.uniform](passFor(o), part);
		total += part;
	}
	for (const Ownership o : counted) {
		if (!touching.bonds[o].blockCount()) continue;
		StoredEnergy<double> part { 0, 0, 0, 0 };
		s.passes->bondEnergies(bondPassFor(o), part);
		total += part;
	}
	total += planes.energies();
	return total;
}

double Domain::kineticEnergy() const
{
	double sum = ledger.eventWork;
	for (int k = begin; k < end; ++k)
		sum += kineticEnergyOf(k);
	return sum;
}

double Domain::kineticEnergyOf(int k) const
{
	const Grain& p = s.grains[k];
	return 0.5 / s.inverseMass[k] * (p.vx * p.vx + p.vy * p.vy + p.vz * p.vz)
	        + 0.5 / s.inverseInertia[k] * (p.wx * p.wx + p.wy * p.wy + p.wz * p.wz)
	        + 0.5 * s.dt * (p.fx * p.vx + p.fy * p.vy + p.fz * p.vz + p.tx * p.wx + p.ty * p.wy + p.tz * p.wz);
}

double Domain::convectiveWork() const
{
	double sum = 0;
	for (int k = begin; k < end && s.convects(); ++k) {
		const Vec3<double> v = velocityOf(s.grains[k]);
		sum += 0.5 * s.dt / s.inverseMass[k] * dot(v, Images<double>::times(s.convective, v));
	}
	return sum;
}

} // namespace contact_law
