#include "domain.hpp"
#include <algorithm>
#include <tuple>

namespace contact_law {

namespace {
	void write(const Vec3<double>& v, double (*to)[lanes], int k) { to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z; }
}

Domain::Domain(Setting& setting, int begin_, int end_, int dummy_)
        : begin(begin_)
        , end(end_)
        , lists(setting, begin_, end_)
        , contacts { { setting.uniform, setting.hasDrag(), dummy_ }, { setting.uniform, setting.hasDrag(), dummy_ },
	        { setting.uniform, setting.hasDrag(), dummy_ } }
        , bonds { { setting.uniformBonds(), dummy_ }, { setting.uniformBonds(), dummy_ }, { setting.uniformBonds(), dummy_ } }
        , s(setting)
        , dummy(dummy_)
{
	for (int sort = 0; sort < 3; ++sort)
		eventCalls[sort] = { this, sort };
	placeDummies();
	for (ContactList& list : contacts)
		list.setDeadConstants(s.common);
	for (BondList& list : bonds)
		list.setDead(s.commonBond, s.grains[dummy].x);
}

void Domain::placeDummies()
{
	s.grains[dummy] = Grain {};
	s.grains[dummy + 1] = Grain {};
	s.grains[dummy].x = s.common.radius1 + s.common.radius2 - s.common.equilibriumOverlap;
}

ForcePass Domain::passFor(int sort)
{
	ContactList& list = contacts[sort];
	const bool books = sort != Second; // both domains of a border contact compute it; the first grain's books it
	return { s.grains.data(), list.data(), list.constantsData(), &s.common, list.dragData(), &cell, 0, list.blockCount(),
		sort != Second, sort != First, dummy, s.dt, books ? &sums.dissipated : &ignoredDissipation,
		books ? &events : &ignoredEvents, books ? &sums.boundary.kicks : &ignoredCrossing, &eventCalls[sort], &Domain::eventsOf,
		nullptr, s.limit == LimitRule::Cut };
}

void Domain::addForces(int sort, int firstBlock, int endBlock, bool behind)
{
	ForcePass pass = passFor(sort);
	pass.firstBlock = firstBlock;
	pass.endBlock = endBlock;
	if (behind) pass.batchDone = &Domain::moveBehind;
	s.passes->forces[s.mechanisms][s.uniform][cell.on](pass);
}

void Domain::addFirstForces()
{
	sums.eventWork = 0;
	lists.beginStep();
	sortIfWorthwhile();
	early.clear();
	if (cell.on) sums.boundary.arrive(cell, s.dt);
	outside.begin();
	constraints.begin();
	addForces(First, 0, contacts[First].blockCount(), false);
	addForces(Second, 0, contacts[Second].blockCount(), false);
	addForces(Both, sortedBlocks, contacts[Both].blockCount(), false);
	addBondForces();
	formContacts();
}

void Domain::addOtherForces(bool behind)
{
	if (behind) beginMoving();
	addForces(Both, 0, sortedBlocks, behind);
	if (cell.on) sums.boundary.complete(cell, s.dt);
	if (behind)
		completeAndIntegrateUpTo(end);
	else
		completeForces(end);
}

void Domain::moveBehind(void* owner, int batch)
{
	Domain& domain = *static_cast<EventCall*>(owner)->domain;
	domain.completeAndIntegrateUpTo(domain.completed[batch]);
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

// The part of the convective acceleration in the kick to come, and its work: the impulse times the mean of the velocities before and after the kick.
void Domain::convect(int first, int last)
{
	Vec3<double> kicked { 0, 0, 0 };
	for (int k = first; k < last; ++k) {
		Grain& g = s.grains[k];
		const Vec3<double> before = velocityOf(g), gain = s.dt * Images<double>::times(s.convective, before);
		const Vec3<double> after = before + gain + (s.dt * s.inverseMass[k]) * Vec3<double> { g.fx, g.fy, g.fz };
		sums.meanField -= 0.5 / s.inverseMass[k] * dot(gain, before + after);
		g.vx += gain.x, g.vy += gain.y, g.vz += gain.z;
		kicked.x = std::max(kicked.x, std::abs(gain.x)), kicked.y = std::max(kicked.y, std::abs(gain.y)),
		kicked.z = std::max(kicked.z, std::abs(gain.z));
	}
	movedLatest.kick[0] += kicked.x, movedLatest.kick[1] += kicked.y, movedLatest.kick[2] += kicked.z;
}

ContactMotion Domain::motionOf(int i, int j, Image& image) const
{
	const Grain &a = s.grains[i], &b = s.grains[j];
	Vec3<double> separation = positionOf(a) - positionOf(b);
	image = nearestImage(cell, separation);
	const double inverseMass =
	        inverseMassAlong(separation, s.inverseMass[i], s.blocked[i]) + inverseMassAlong(separation, s.inverseMass[j], s.blocked[j]);
	return { separation, velocityOf(a) - velocityOf(b) + image.velocity, spinOf(a), spinOf(b), s.dt, inverseMass, image.velocity,
		inverseInertiaOf(s.inverseInertia[i], s.blocked[i]), inverseInertiaOf(s.inverseInertia[j], s.blocked[j]) };
}

// Positions move by velocity * dt, and by where a script has put the grains since.
Vec3<double> Domain::separationAStepAgo(int i, int j, const ContactMotion& m) const
{
	Vec3<double> then = m.separation - m.dt * m.velocity;
	if (s.displaced.empty()) return then;
	then = then - (s.displaced[i] - s.displaced[j]);
	nearestImage(cell, then);
	return then;
}

void Domain::book(const ContactStepResult& r, const ContactMotion& m, const Image& image, int sort)
{
	if (sort == Second) return;
	sums.dissipated += r.dissipated;
	sums.eventWork += r.workBefore - 0.5 * contact_law::events::work(m, r.force, r.torque1, r.torque2);
	if (cell.on) sums.boundary.addEarly(image.shift, r.force, r.forceBefore);
	++events;
}

void Domain::keepEarly(int i, int j, const ContactStepResult& r)
{
	const Vec3<double> force = r.forceBefore - 0.5 * r.force;
	if (owns(i)) early.push_back({ i, force, r.torqueBefore1 - 0.5 * r.torque1 });
	if (owns(j)) early.push_back({ j, -force, r.torqueBefore2 - 0.5 * r.torque2 });
}

void Domain::addAlone(int sort, int i, int j, const ContactStepResult& r, const Image& image)
{
	if (sort != Second) {
		addToGrain(s.grains[i], r.force, r.torque1);
		if (cell.on) sums.boundary.add(image.shift, r.force);
	}
	if (sort != First) addToGrain(s.grains[j], -r.force, r.torque2);
}

void Domain::eventsOf(void* owner, int block, unsigned which, const ContactBlock& before, LaneForces& forces)
{
	const EventCall& call = *static_cast<EventCall*>(owner);
	for (int k = 0; k < lanes; ++k)
		if (which & (1u << k)) call.domain->eventOf(call.sort, block * lanes + k, before, forces);
}

void Domain::eventOf(int sort, int lane, const ContactBlock& old, LaneForces& forces)
{
	ContactList& list = contacts[sort];
	const int k = lane % lanes;
	const int i = list.first(lane), j = list.second(lane);
	Image image;
	const ContactMotion m = motionOf(i, j, image);
	const PairConstants<double> constants = s.constantsOf(i, j);
	ContactHistory<double> h = ContactList::history(old, k);

	ContactBefore before = aStepAgo(constants, constants.radius1 + constants.radius2, separationAStepAgo(i, j, m), h);
	if (s.hasDrag()) {
		before.velocity = list.velocityBefore(lane);
		before.drag = list.drag(lane);
	}

	h.pointers = { turnedALittle(h.pointers.n1, m.dt * m.spin1), turnedALittle(h.pointers.n2, m.dt * m.spin2) };
	const ContactStepResult r = contactStepWith[s.mechanisms](constants, s.limit, m, before, h);
	book(r, m, image, sort);
	keepEarly(i, j, r);
	write(r.force, forces.force, k);
	write(r.torque1, forces.torque1, k);
	write(r.torque2, forces.torque2, k);
	if (r.touching) {
		list.writeHistory(lane, h);
		list.writeDrag(lane, r.now.drag, r.geometry.overlap, m.velocity);
		return;
	}
	// this lane's kicks still go to its grains (scattered by index): add them here, and leave nothing for the dead lane's dummies
	addAlone(sort, i, j, r, image);
	write({ 0, 0, 0 }, forces.force, k);
	write({ 0, 0, 0 }, forces.torque1, k);
	write({ 0, 0, 0 }, forces.torque2, k);
	list.kill(lane);
	if (sort != Second) ++broke;
	++changed;
	lists.part(i, j);
}

void Domain::formContacts()
{
	std::vector<NeighbourPair> forming = lists.overlapping(cell);
	const auto key = [this](const NeighbourPair& p) { return std::make_tuple(sortOf(p.first(), p.second()), p.first(), p.second()); };
	std::sort(forming.begin(), forming.end(), [&](const NeighbourPair& a, const NeighbourPair& b) { return key(a) < key(b); });
	for (const NeighbourPair& pair : forming)
		if (formContact(pair)) lists.touch(pair.first(), pair.second());
}

// Returns whether it did.
bool Domain::formContact(const NeighbourPair& pair)
{
	const int i = pair.first(), j = pair.second(), sort = sortOf(i, j);
	Image image;
	const ContactMotion m = motionOf(i, j, image);
	Contact c { i, j, {}, s.constantsOf(i, j) };
	const auto r = contactStepWith[s.mechanisms](c.constants, s.limit, m, ContactBefore {}, c.history);
	if (!r.touching) return false;
	c.drag = r.now.drag;
	c.overlap = r.geometry.overlap;
	c.velocity = m.velocity;
	if (sort != Second) ++formed;
	++changed;
	book(r, m, image, sort);
	keepEarly(i, j, r);
	addAlone(sort, i, j, r, image);
	contacts[sort].append(c);
	return true;
}

StoredEnergy<double> Domain::energies()
{
	StoredEnergy<double> total { 0, 0, 0, 0 };
	for (int sort = Both; sort <= First; ++sort) {
		StoredEnergy<double> part { 0, 0, 0, 0 };
		s.passes->energies[s.mechanisms][s.uniform](passFor(sort), part);
		total += part;
	}
	addBondEnergies(total);
	return total;
}

double Domain::kineticEnergy() const
{
	double sum = sums.eventWork;
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

int Domain::contactCount() const
{
	int count = bonds[Both].aliveCount() + bonds[First].aliveCount();
	for (int sort = Both; sort <= First; ++sort)
		count += contacts[sort].aliveCount();
	return count;
}

} // namespace contact_law
