#include "touching_pairs.hpp"
#include <algorithm>
#include <tuple>

namespace contact_law {

namespace {
	constexpr double sortingCost = 1; // of a contact, over what one costs a step more for being out of order (measured)
}

TouchingPairs::TouchingPairs(SharedState& shared, int begin_, int end_, int dummy_)
        : contacts { { shared.uniform, shared.mechanisms, dummy_ }, { shared.uniform, shared.mechanisms, dummy_ },
	        { shared.uniform, shared.mechanisms, dummy_ } }
        , bonds { { shared.uniformBonds(), dummy_ }, { shared.uniformBonds(), dummy_ }, { shared.uniformBonds(), dummy_ } }
        , s(shared)
        , begin(begin_)
        , end(end_)
        , dummy(dummy_)
{
	s.grains[dummy] = s.grains[dummy + 1] = Grain {};
	s.grains[dummy].x = s.common.radius1 + s.common.radius2 - s.common.equilibriumOverlap;
	for (ContactList& list : contacts)
		list.setUnusedConstants(s.common);
	for (BondList& list : bonds)
		list.setUnused(s.commonBond, s.grains[dummy].x);
}

int TouchingPairs::count() const
{
	int total = 0;
	for (const Ownership o : counted)
		total += contacts[o].usedCount() + bonds[o].usedCount();
	return total;
}

void TouchingPairs::place(const Contact& c)
{
	if (owns(c.i) || owns(c.j)) contacts[ownershipOf(c.i, c.j)].append(c);
}

void TouchingPairs::place(const Bond& b)
{
	if (owns(b.i) || owns(b.j)) bonds[ownershipOf(b.i, b.j)].append(b);
}

void TouchingPairs::placeOverlapping(PairLists& lists, const PeriodicCell& cell)
{
	lists.each([&](int i, int j) {
		const Vec3<double> separation = s.separationOf(cell, i, j);
		const ContactMotion m { separation, { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 }, s.dt, 0 };
		const double overlap = s.radius[i] + s.radius[j] - std::sqrt(dot(separation, separation));
		if (overlap <= 0) return;
		contacts[ownershipOf(i, j)].append({ i, j, events::formedHistory(m, 0), s.constantsOf(i, j), 0, overlap });
	});
	markIn(lists);
}

void TouchingPairs::placeBonds(PairLists& lists, const PeriodicCell& cell)
{
	lists.each([&](int i, int j) {
		const Vec3<double> separation = s.separationOf(cell, i, j);
		const double reach =
		        (1 + 1e-12) * (s.grainRadius[i] + s.grainRadius[j]); // those that a script has placed side by side, too
		if (dot(separation, separation) > reach * reach) return;
		Bond bond { i, j, {}, 0, s.bondOf(i, j, s.neck) };
		bond.rest = newBond(separation, bond.history);
		bonds[ownershipOf(i, j)].append(bond);
	});
	markIn(lists);
}

TouchingPairs::Contents TouchingPairs::takeOut()
{
	Contents all;
	for (ContactList& list : contacts)
		all.contacts.push_back(list), list.clear();
	for (BondList& list : bonds)
		all.bonds.push_back(list), list.clear();
	return all;
}

void TouchingPairs::place(const Contents& all, const std::vector<int>& to)
{
	for (const Ownership o : counted) {
		place(all.contacts[o], to, contacts, [this](const ContactList& list, int slot, int i, int j) {
			Contact c = list.get(slot, s.constantsOf(std::min(i, j), std::max(i, j)));
			if (i > j) c.velocity = -c.velocity, c.damping = swapped(c.damping);
			return c;
		});
		place(all.bonds[o], to, bonds, [this](const BondList& list, int slot, int i, int j) {
			Bond b = list.get(slot, s.commonBond);
			if (i > j) std::swap(b.constants.radius1, b.constants.radius2);
			return b;
		});
	}
}

// get(list, slot, i, j): one whose grains are i and j now.
template <class List, class Get> void TouchingPairs::place(const List& from, const std::vector<int>& to, List (&own)[3], const Get& get)
{
	for (int slot = 0; slot < from.size(); ++slot) {
		if (!from.isUsed(slot)) continue;
		const int i = to[from.first(slot)], j = to[from.second(slot)];
		if (!owns(i) && !owns(j)) continue;
		auto one = get(from, slot, i, j);
		one.i = std::min(i, j), one.j = std::max(i, j);
		if (i > j) one.history = swapped(one.history);
		own[ownershipOf(one.i, one.j)].append(one);
	}
}

void TouchingPairs::markIn(PairLists& lists) const
{
	const auto mark = [&lists](const auto& list) {
		for (int slot = 0; slot < list.size(); ++slot)
			if (list.isUsed(slot)) lists.touch(list.first(slot), list.second(slot));
	};
	for (const ContactList& list : contacts)
		mark(list);
	for (const BondList& list : bonds)
		mark(list);
}

void TouchingPairs::takeVelocities(const PeriodicCell& cell)
{
	if (!s.hasDrag()) return;
	for (ContactList& list : contacts)
		for (int slot = 0; slot < list.size(); ++slot) {
			if (!list.isUsed(slot)) continue;
			Image image;
			const int i = list.first(slot), j = list.second(slot);
			const ContactMotion m = s.motionOf(cell, i, j, image);
			list.writeVelocity(slot, m.velocity);
			if (!(s.mechanisms & SpringDamping)) continue;
			const PairConstants<double> c = s.constantsOf(i, j);
			DampingMoment<double> damping = list.damping(slot);
			damping.through = spring_damping::motion(c, geometryOf(m.separation, c.radius1 + c.radius2),
			        list.history(slot).pointers, m.velocity, m.spin1, m.spin2, 0.)
			                          .rates;
			list.writeDamping(slot, damping);
		}
}

/* A contact that formed costs more until it is sorted in, sorting costs in proportion to all of them: both together least when the
 * first sum has grown to the second. */
void TouchingPairs::sortIfWorthwhile()
{
	++order.stepsSinceSort;
	const int slots = contacts[Interior].size() + contacts[FirstOwned].size() + contacts[SecondOwned].size();
	if (double(order.changed) * order.stepsSinceSort > sortingCost * slots) sort();
}

void TouchingPairs::sort()
{
	for (ContactList& list : contacts)
		list.sort();
	for (BondList& list : bonds)
		list.sort();
	order = { contacts[Interior].blockCount(), 0, 0 };
	findCompleted();
	s.grains[dummy].fx = s.grains[dummy].fy = s.grains[dummy].fz = 0;
}

void TouchingPairs::findCompleted()
{
	const ContactList& list = contacts[Interior];
	completed.assign((order.sortedBlocks + batchSize - 1) / batchSize, end);
	int next = end;
	for (int batch = int(completed.size()) - 1; batch >= 0; --batch) {
		completed[batch] = next;
		const int last = std::min((batch + 1) * batchSize, order.sortedBlocks) * lanes;
		for (int slot = last - 1; slot >= batch * batchSize * lanes; --slot)
			if (list.isUsed(slot)) next = list.first(slot);
	}
}

// ---- events ----

namespace {
	void write(const ContactStepResult& r, LaneForces& out, int k)
	{
		writeVector(r.force, out.force, k);
		writeVector(r.torque1, out.torque1, k);
		writeVector(r.torque2, out.torque2, k);
	}
}

ContactEvents::ContactEvents(SharedState& shared, const PeriodicCell& cell_, PairLists& lists_, TouchingPairs& touching_, Ledger& ledger_)
        : s(shared)
        , cell(cell_)
        , lists(lists_)
        , touching(touching_)
        , ledger(ledger_)
{
}

// Positions move by velocity * dt, and by where a script has put the grains since.
Vec3<double> ContactEvents::separationAStepAgo(int i, int j, const ContactMotion& m) const
{
	Vec3<double> then = m.separation - m.dt * m.velocity;
	if (s.displaced.empty()) return then;
	then = then - (s.displaced[i] - s.displaced[j]);
	nearestImage(cell, then);
	return then;
}

void ContactEvents::book(int i, int j, const ContactStepResult& r, const ContactMotion& m, const Image& image, Ownership o)
{
	ledger.book(r, m, image, o);
	if (r.geometry.overlap > std::min(s.radius[i], s.radius[j])) ledger.tooDeep = true; // beyond the fit: always an event
	const Vec3<double> force = r.forceBefore - 0.5 * r.force;
	if (ownsFirst(o)) ledger.early.push_back({ i, force, r.torqueBefore1 - 0.5 * r.torque1 });
	if (ownsSecond(o)) ledger.early.push_back({ j, -force, r.torqueBefore2 - 0.5 * r.torque2 });
}

// Kicks of a contact that no pass scatters.
void ContactEvents::addAlone(int i, int j, const ContactStepResult& r, const Image& image, Ownership o)
{
	if (ownsFirst(o)) {
		addToGrain(s.grains[i], r.force, r.torque1);
		ledger.addCrossing(image, r.force);
	}
	if (ownsSecond(o)) addToGrain(s.grains[j], -r.force, r.torque2);
}

void ContactEvents::ofSlot(Ownership o, int slot, const ContactBlock& old, LaneForces& out)
{
	ContactList& list = touching.contacts[o];
	const int k = slot % lanes, i = list.first(slot), j = list.second(slot);
	Image image;
	const ContactMotion m = s.motionOf(cell, i, j, image);
	const PairConstants<double> constants = s.constantsOf(i, j);
	ContactHistory<double> h = historyIn(old, k);

	ContactBefore before = aStepAgo(constants, constants.radius1 + constants.radius2, separationAStepAgo(i, j, m), h);
	if (s.hasDrag()) {
		before.velocity = list.velocityBefore(slot);
		before.drag = list.drag(slot);
		before.damping = list.damping(slot);
	}

	turnPointers(h, m);
	const ContactStepResult r = contactStepWith[s.mechanisms](constants, s.limit, m, before, h);
	book(i, j, r, m, image, o);
	if (r.touching) {
		write(r, out, k);
		list.writeHistory(slot, h);
		list.writeDrag(slot, r.now.drag, r.geometry.overlap, m.velocity);
		list.writeDamping(slot, r.damping);
		return;
	}
	// the pass adds by the slot's indices, which are those of the dummies now: its kicks still go to its grains
	addAlone(i, j, r, image, o);
	write(ContactStepResult {}, out, k);
	list.markUnused(slot);
	ledger.counts.broken += isCounted(o);
	touching.noteChange();
	lists.part(i, j);
}

void ContactEvents::ofSlot(Ownership o, int slot, const BondBlock& old, LaneForces& out)
{
	BondList& list = touching.bonds[o];
	const int k = slot % lanes, i = list.first(slot), j = list.second(slot);
	Image image;
	const ContactMotion m = s.motionOf(cell, i, j, image);
	const Bond bond = list.get(slot, s.commonBond);
	const BondConstants<double>& b = bond.constants;
	const PairConstants<double> constants = s.constantsOf(i, j);
	ContactHistory<double> h = historyIn(old, k);

	const ContactBefore before = aStepAgo(b, bond.rest, separationAStepAgo(i, j, m), h);
	turnPointers(h, m);
	const BondStepResult result = bondStepWith[s.mechanisms](b, constants, m, before, bond.rest, h);
	if (result.bonded) return; // by rounding: it doesn't break after all, and the forces of the pass stand
	const ContactStepResult& r = result.contact;
	book(i, j, r, m, image, o);
	ledger.counts.brokenBonds[result.mode] += isCounted(o);
	addAlone(i, j, r, image, o);
	write(ContactStepResult {}, out, k);
	list.markUnused(slot);
	touching.noteChange();
	if (r.touching)
		touching.contacts[o].append({ i, j, h, constants, r.now.drag, r.geometry.overlap, m.velocity, r.damping });
	else
		lists.part(i, j);
}

void ContactEvents::formContacts()
{
	std::vector<NeighbourPair> forming = lists.overlapping(cell);
	const auto key = [this](const NeighbourPair& p) {
		return std::make_tuple(touching.ownershipOf(p.first(), p.second()), p.first(), p.second());
	};
	std::sort(forming.begin(), forming.end(), [&](const NeighbourPair& a, const NeighbourPair& b) { return key(a) < key(b); });
	for (const NeighbourPair& pair : forming)
		if (formContact(pair)) lists.touch(pair.first(), pair.second());
}

// Returns whether it did.
bool ContactEvents::formContact(const NeighbourPair& pair)
{
	const int i = pair.first(), j = pair.second();
	const Ownership o = touching.ownershipOf(i, j);
	Image image;
	const ContactMotion m = s.motionOf(cell, i, j, image);
	Contact c { i, j, {}, s.constantsOf(i, j) };
	const auto r = contactStepWith[s.mechanisms](c.constants, s.limit, m, ContactBefore {}, c.history);
	if (!r.touching) return false;
	c.drag = r.now.drag;
	c.overlap = r.geometry.overlap;
	c.velocity = m.velocity;
	c.damping = r.damping;
	ledger.counts.formed += isCounted(o);
	touching.noteChange();
	book(i, j, r, m, image, o);
	addAlone(i, j, r, image, o);
	touching.contacts[o].append(c);
	return true;
}

} // namespace contact_law
