// Sintered bonds of a domain: where they come from, their forces, and what is left when they break.
#include "domain.hpp"

namespace contact_law {

namespace {
	void write(const Vec3<double>& v, double (*to)[lanes], int k) { to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z; }

	// Without strain, and without constants yet.
	Bond newBond(int i, int j, const Vec3<double>& separation)
	{
		Bond bond { i, j, {}, 0, {} };
		bond.rest = contact_law::newBond(separation, bond.history);
		return bond;
	}
}

BondPass Domain::bondPassFor(int sort)
{
	BondList& list = bonds[sort];
	return { s.grains.data(), list.data(), list.constantsData(), &s.commonBond, list.blockCount(), sort != Second, sort != First, dummy,
		s.dt, &cell, sort != Second ? &sums.boundary.kicks : &ignoredCrossing, &eventCalls[sort], &Domain::breaksOf };
}

void Domain::addBondForces()
{
	for (int sort = 0; sort < 3; ++sort)
		if (bonds[sort].blockCount()) s.passes->bondForces[cell.on](bondPassFor(sort));
}

void Domain::breaksOf(void* owner, int block, unsigned which, const BondBlock& before, LaneForces& forces)
{
	const EventCall& call = *static_cast<EventCall*>(owner);
	for (int k = 0; k < lanes; ++k)
		if (which & (1u << k)) call.domain->breakOf(call.sort, block * lanes + k, before, forces);
}

// A border bond is computed in both domains, from the same numbers to the same end.
void Domain::breakOf(int sort, int lane, const BondBlock& old, LaneForces& forces)
{
	BondList& list = bonds[sort];
	const int k = lane % lanes, i = list.first(lane), j = list.second(lane);
	Image image;
	const ContactMotion m = motionOf(i, j, image);
	const Bond bond = list.get(lane, s.commonBond);
	const BondConstants<double>& b = bond.constants;
	const PairConstants<double> constants = s.constantsOf(i, j);
	ContactHistory<double> h = ContactList::history(old, k);

	const ContactBefore before = aStepAgo(b, bond.rest, separationAStepAgo(i, j, m), h);
	h.pointers = { turnedALittle(h.pointers.n1, m.dt * m.spin1), turnedALittle(h.pointers.n2, m.dt * m.spin2) };

	const BondStepResult result = bondStepWith[s.mechanisms](b, constants, m, before, bond.rest, h);
	const ContactStepResult& r = result.contact;
	if (result.bonded) { // by rounding: it doesn't after all, and the forces of the pass stand
		return;
	}
	book(r, m, image, sort);
	keepEarly(i, j, r);
	if (sort != Second) ++broken[result.mode];
	addAlone(sort, i, j, r, image);
	write({ 0, 0, 0 }, forces.force, k);
	write({ 0, 0, 0 }, forces.torque1, k);
	write({ 0, 0, 0 }, forces.torque2, k);
	list.kill(lane);
	++changed;
	if (r.touching) {
		contacts[sort].append({ i, j, h, constants, r.now.drag, r.geometry.overlap, m.velocity });
		return;
	}
	lists.part(i, j);
}

void Domain::placeBonds()
{
	lists.each([this](int i, int j) {
		Image image;
		const Vec3<double> separation = motionOf(i, j, image).separation;
		const double reach = s.grainRadius[i] + s.grainRadius[j];
		if (dot(separation, separation) >= reach * reach) return;
		Bond bond = newBond(i, j, separation);
		bond.constants = s.bondOf(i, j, s.neck);
		bonds[sortOf(i, j)].append(bond);
	});
	markTouching();
}

void Domain::place(const Bond& b)
{
	if (owns(b.i) || owns(b.j)) bonds[sortOf(b.i, b.j)].append(b);
}

// Contacts that a script has torn apart since the latest step are none any more.
Domain::AllBonds Domain::sintered(double neck) const
{
	AllBonds all;
	for (int sort = 0; sort < 3; ++sort) {
		for (int lane = 0; lane < bonds[sort].size(); ++lane)
			if (bonds[sort].alive(lane)) all[sort].push_back(bonds[sort].get(lane, s.commonBond));
		for (int lane = 0; lane < contacts[sort].size(); ++lane) {
			if (!contacts[sort].alive(lane)) continue;
			const Contact c = s.contactOf(contacts[sort], lane);
			Image image;
			const Vec3<double> separation = motionOf(c.i, c.j, image).separation;
			if (normal::beyondPullOff(c.constants, geometryOf(separation, c.constants.radius1 + c.constants.radius2))) continue;
			all[sort].push_back(newBond(c.i, c.j, separation));
			all[sort].back().constants.neck = neck;
		}
	}
	return all;
}

void Domain::setBonds(const AllBonds& all)
{
	placeDummies();
	for (int sort = 0; sort < 3; ++sort) {
		contacts[sort].clear();
		contacts[sort].setDeadConstants(s.common);
		bonds[sort] = BondList(s.uniformBonds(), dummy);
		bonds[sort].setDead(s.commonBond, s.grains[dummy].x);
		for (Bond bond : all[sort]) {
			bond.constants = s.bondOf(bond.i, bond.j, bond.constants.neck);
			bonds[sort].append(bond);
		}
	}
}

void Domain::addBondEnergies(StoredEnergy<double>& total)
{
	for (int sort = Both; sort <= First; ++sort) {
		if (!bonds[sort].blockCount()) continue;
		StoredEnergy<double> part { 0, 0, 0, 0 };
		s.passes->bondEnergies(bondPassFor(sort), part);
		total += part;
	}
}

} // namespace contact_law
