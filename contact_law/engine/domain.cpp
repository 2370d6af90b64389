#include "domain.hpp"
#include <algorithm>

namespace contact_law {

namespace {

	void add(Grain& g, const Vec3<double>& force, const Vec3<double>& torque)
	{
		g.fx += force.x, g.fy += force.y, g.fz += force.z;
		g.tx += torque.x, g.ty += torque.y, g.tz += torque.z;
	}
	void write(const Vec3<double>& v, double (*to)[lanes], int k) { to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z; }
}

Domain::Domain(Setting& setting, int begin_, int end_, int dummy_)
        : begin(begin_)
        , end(end_)
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
	return { s.grains.data(), list.data(), list.constantsData(), &s.common, list.dragData(), s.previous.data(), &cell, 0,
		list.blockCount(), sort != Second, sort != First, dummy, s.dt, books ? &sums.dissipated : &ignoredDissipation,
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
	early.clear();
	if (cell.on) sums.boundary.arrive(cell, s.dt);
	constraints.begin();
	addForces(First, 0, contacts[First].blockCount(), false);
	addForces(Second, 0, contacts[Second].blockCount(), false);
	addForces(Both, sortedBlocks, contacts[Both].blockCount(), false);
	addBondForces();
	formContacts();
}

void Domain::addOtherForces(bool behind)
{
	if (behind) velocities.clear(), moved = begin;
	addForces(Both, 0, sortedBlocks, behind);
	if (cell.on) sums.boundary.complete(cell, s.dt);
	constraints.withhold(s.grains.data(), s.dt, end);
	if (behind) integrateUpTo(end);
}

void Domain::moveBehind(void* owner, int batch)
{
	Domain& domain = *static_cast<EventCall*>(owner)->domain;
	const int complete = domain.completed[batch];
	domain.constraints.withhold(domain.s.grains.data(), domain.s.dt, complete);
	domain.integrateUpTo(complete);
}

void Domain::integrate()
{
	velocities.clear(), moved = begin;
	integrateUpTo(end);
}

void Domain::integrateUpTo(int grain)
{
	if (s.hasDrag())
		for (int g = moved; g < grain; ++g)
			s.previous[g] = { s.grains[g].vx, s.grains[g].vy, s.grains[g].vz, 0 };
	if (s.convects()) convect(moved, grain);
	s.passes->integrate(s.grains.data() + moved, s.grains.data() + grain, s.inverseMass.data() + moved, s.inverseInertia.data() + moved,
	        s.dt, velocities);
	if (!s.orientation.empty()) turnOrientations(s.grains.data() + moved, s.grains.data() + grain, s.orientation.data() + moved, s.dt);
	moved = grain;
}

// The part of the convective acceleration in the kick to come, and its work: the impulse times the mean of the velocities before and after the kick.
void Domain::convect(int first, int last)
{
	for (int k = first; k < last; ++k) {
		Grain& g = s.grains[k];
		const Vec3<double> before = velocityOf(g), gain = s.dt * Images<double>::times(s.convective, before);
		const Vec3<double> after = before + gain + (s.dt * s.inverseMass[k]) * Vec3<double> { g.fx, g.fy, g.fz };
		sums.meanField -= 0.5 / s.inverseMass[k] * dot(gain, before + after);
		g.vx += gain.x, g.vy += gain.y, g.vz += gain.z;
	}
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
		add(s.grains[i], r.force, r.torque1);
		if (cell.on) sums.boundary.add(image.shift, r.force);
	}
	if (sort != First) add(s.grains[j], -r.force, r.torque2);
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
		const PreviousVelocity &a = s.previous[i], &b = s.previous[j];
		before.velocity = Vec3<double> { a.x - b.x, a.y - b.y, a.z - b.z } + image.velocityBefore;
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
		list.writeDrag(lane, r.now.drag, r.geometry.overlap);
		return;
	}
	// this lane's kicks still go to its grains (scattered by index): add them here, and leave nothing for the dead lane's dummies
	addAlone(sort, i, j, r, image);
	write({ 0, 0, 0 }, forces.force, k);
	write({ 0, 0, 0 }, forces.torque1, k);
	write({ 0, 0, 0 }, forces.torque2, k);
	list.kill(lane);
	if (sort != Second) ++broke;
	const int pair = pairIndex(sort, i, j);
	if (pair < 0) return;
	touching[sort][pair] = 0;
	near[sort].push_back(pair);
}

void Domain::formContacts()
{
	for (int sort = 0; sort < 3; ++sort) {
		std::vector<int> forming;
		for (const int index : near[sort]) {
			if (!touching[sort][index] && closerThan(far[sort][index].i, far[sort][index].j, 0)) forming.push_back(index);
		}
		std::sort(forming.begin(), forming.end()); // the order of pairs, whatever the order of the list
		for (const int index : forming)
			formContact(sort, index);
	}
}

void Domain::formContact(int sort, int index)
{
	const Pair p = far[sort][index];
	Image image;
	const ContactMotion m = motionOf(p.i, p.j, image);
	Contact c { p.i, p.j, {}, s.constantsOf(p.i, p.j) };
	const auto r = contactStepWith[s.mechanisms](c.constants, s.limit, m, ContactBefore {}, c.history);
	if (!r.touching) return;
	c.drag = r.now.drag;
	c.overlap = r.geometry.overlap;
	touching[sort][index] = 1;
	if (sort != Second) ++formed;
	book(r, m, image, sort);
	keepEarly(p.i, p.j, r);
	addAlone(sort, p.i, p.j, r, image);
	contacts[sort].append(c);
}

void Domain::findPairs(const Grid& grid, double nearGap)
{
	for (auto& list : far)
		list.clear();
	std::vector<int> found;
	for (int i = begin; i < end; ++i) {
		const NeighbourSearch search = grid.search(&s.grains[i].x, s.radius[i], s.farGap, cell);
		found.resize(std::max(found.size(), std::size_t(search.most())));
		int* last = found.data() + s.passes->closeMembers[cell.on](search, found.data());
		last = std::remove_if(found.data(), last, [&](int j) { return j == i || (j < i && owns(j)); });
		std::sort(found.data(), last);
		last = std::unique(found.data(), last);
		for (const int* j = found.data(); j < last; ++j)
			far[owns(*j) ? Both : i < *j ? First : Second].push_back(i < *j ? Pair { i, *j } : Pair { *j, i });
	}
	std::sort(far[Second].begin(), far[Second].end());
	for (int sort = 0; sort < 3; ++sort) {
		touching[sort].assign(far[sort].size(), 0);
		const ContactList& list = contacts[sort];
		std::size_t at = 0;
		for (int lane = 0; lane < list.size(); ++lane) { // pairs and contacts run along together as long as contacts are sorted
			if (!list.alive(lane)) continue;
			const Pair pair { list.first(lane), list.second(lane) };
			if (at > 0 && !(far[sort][at - 1] < pair))
				at = std::lower_bound(far[sort].begin(), far[sort].end(), pair) - far[sort].begin();
			while (at < far[sort].size() && far[sort][at] < pair)
				++at;
			if (at < far[sort].size() && !(pair < far[sort][at])) touching[sort][at] = 1;
		}
		for (int lane = 0; lane < bonds[sort].size(); ++lane) {
			const int pair = bonds[sort].alive(lane) ? pairIndex(sort, bonds[sort].first(lane), bonds[sort].second(lane)) : -1;
			if (pair >= 0) touching[sort][pair] = 1;
		}
	}
	findNearPairs(nearGap);
}

void Domain::sortContacts()
{
	for (ContactList& list : contacts)
		list.sort();
	for (BondList& list : bonds)
		list.sort();
	sortedBlocks = contacts[Both].blockCount();
	findCompleted();
	s.grains[dummy].fx = s.grains[dummy].fy = s.grains[dummy].fz = 0;
}

void Domain::findCompleted()
{
	const ContactList& list = contacts[Both];
	completed.assign((sortedBlocks + batchSize - 1) / batchSize, end);
	int next = end;
	for (int batch = int(completed.size()) - 1; batch >= 0; --batch) {
		completed[batch] = next;
		const int last = std::min((batch + 1) * batchSize, sortedBlocks) * lanes;
		for (int lane = last - 1; lane >= batch * batchSize * lanes; --lane)
			if (list.alive(lane)) next = list.first(lane);
	}
}

void Domain::findNearPairs(double nearGap)
{
	for (int sort = 0; sort < 3; ++sort) {
		near[sort].clear();
		for (int index = 0; index < int(far[sort].size()); ++index)
			if (!touching[sort][index] && closerThan(far[sort][index].i, far[sort][index].j, nearGap))
				near[sort].push_back(index);
	}
}

bool Domain::closerThan(int i, int j, double gap) const
{
	Vec3<double> d = positionOf(s.grains[i]) - positionOf(s.grains[j]);
	if (cell.on) nearestImage(cell, d);
	const double reach = s.radius[i] + s.radius[j] + gap;
	return dot(d, d) <= reach * reach;
}

int Domain::pairIndex(int sort, int i, int j) const
{
	const Pair pair { i, j };
	const auto found = std::lower_bound(far[sort].begin(), far[sort].end(), pair);
	return found != far[sort].end() && !(pair < *found) ? int(found - far[sort].begin()) : -1;
}

void Domain::place(const Contact& c)
{
	if (owns(c.i) || owns(c.j)) contacts[owns(c.i) && owns(c.j) ? Both : owns(c.i) ? First : Second].append(c);
}

void Domain::placeOverlapping()
{
	for (int sort = 0; sort < 3; ++sort)
		for (const int index : near[sort]) {
			const Pair p = far[sort][index];
			Vec3<double> separation = positionOf(s.grains[p.i]) - positionOf(s.grains[p.j]);
			nearestImage(cell, separation);
			const ContactMotion m { separation, { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 }, s.dt, 0 };
			const double overlap = s.radius[p.i] + s.radius[p.j] - std::sqrt(dot(m.separation, m.separation));
			if (overlap <= 0) continue;
			contacts[sort].append({ p.i, p.j, contact_law::events::formedHistory(m, 0), s.constantsOf(p.i, p.j), 0, overlap });
			touching[sort][index] = 1;
		}
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
	for (int k = begin; k < end; ++k) {
		const Grain& p = s.grains[k];
		sum += 0.5 / s.inverseMass[k] * (p.vx * p.vx + p.vy * p.vy + p.vz * p.vz)
		        + 0.5 / s.inverseInertia[k] * (p.wx * p.wx + p.wy * p.wy + p.wz * p.wz)
		        + 0.5 * s.dt * (p.fx * p.vx + p.fy * p.vy + p.fz * p.vz + p.tx * p.wx + p.ty * p.wy + p.tz * p.wz);
	}
	return sum;
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
		for (int lane = 0; lane < contacts[sort].size(); ++lane)
			count += contacts[sort].alive(lane);
	return count;
}

} // namespace contact_law
