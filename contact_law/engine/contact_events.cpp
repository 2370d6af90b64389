#include "contact_events.hpp"
#include <algorithm>
#include <tuple>

namespace contact_law {

namespace {
	void write(const Vec3<double>& v, double (*to)[lanes], int k) { to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z; }
	void write(const ContactStepResult& r, LaneForces& out, int k)
	{
		write(r.force, out.force, k);
		write(r.torque1, out.torque1, k);
		write(r.torque2, out.torque2, k);
	}

	/* The moment a step ago of a pair whose springs rest at a distance `rest`: the first grain stood at `then` from the second, and the pointers of `h` had not
	 * turned yet. Constants: of a contact or of a bond. */
	template <class Constants>
	ContactBefore aStepAgo(const Constants& c, double rest, const Vec3<double>& then, const ContactHistory<double>& h)
	{
		const double apart = std::sqrt(dot(then, then));
		ContactBefore before;
		before.touching = true;
		before.overlap = rest - apart;
		before.sliding = SlidingSpring::displacement(c, h.pointers, (1 / apart) * then);
		before.rolling = RollingSpring::displacement(c, h.pointers);
		before.twist = h.twist;
		return before;
	}

	void turnPointers(ContactHistory<double>& h, const ContactMotion& m)
	{
		h.pointers = { turnedALittle(h.pointers.n1, m.dt * m.spin1), turnedALittle(h.pointers.n2, m.dt * m.spin2) };
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
	const Vec3<double> force = r.forceBefore - 0.5 * r.force;
	if (ownsFirst(o)) ledger.keep({ i, force, r.torqueBefore1 - 0.5 * r.torque1 });
	if (ownsSecond(o)) ledger.keep({ j, -force, r.torqueBefore2 - 0.5 * r.torque2 });
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
	ContactHistory<double> h = ContactList::history(old, k);

	ContactBefore before = aStepAgo(constants, constants.radius1 + constants.radius2, separationAStepAgo(i, j, m), h);
	if (s.hasDrag()) {
		before.velocity = list.velocityBefore(slot);
		before.drag = list.drag(slot);
	}

	turnPointers(h, m);
	const ContactStepResult r = contactStepWith[s.mechanisms](constants, s.limit, m, before, h);
	book(i, j, r, m, image, o);
	if (r.touching) {
		write(r, out, k);
		list.writeHistory(slot, h);
		list.writeDrag(slot, r.now.drag, r.geometry.overlap, m.velocity);
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
	ContactHistory<double> h = ContactList::history(old, k);

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
		touching.contacts[o].append({ i, j, h, constants, r.now.drag, r.geometry.overlap, m.velocity });
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
	ledger.counts.formed += isCounted(o);
	touching.noteChange();
	book(i, j, r, m, image, o);
	addAlone(i, j, r, image, o);
	touching.contacts[o].append(c);
	return true;
}

} // namespace contact_law
