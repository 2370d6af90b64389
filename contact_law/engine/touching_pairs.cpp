#include "touching_pairs.hpp"
#include <algorithm>

namespace contact_law {

namespace {
	constexpr double sortingCost = 1; // of a contact, over what one costs a step more for being out of order (measured)

	// Without strain, and without constants yet.
	Bond newBond(int i, int j, const Vec3<double>& separation)
	{
		Bond bond { i, j, {}, 0, {} };
		bond.rest = contact_law::newBond(separation, bond.history);
		return bond;
	}
}

TouchingPairs::TouchingPairs(SharedState& shared, int begin_, int end_, int dummy_)
        : contacts { { shared.uniform, shared.hasDrag(), dummy_ }, { shared.uniform, shared.hasDrag(), dummy_ },
	        { shared.uniform, shared.hasDrag(), dummy_ } }
        , bonds { { shared.uniformBonds(), dummy_ }, { shared.uniformBonds(), dummy_ }, { shared.uniformBonds(), dummy_ } }
        , s(shared)
        , begin(begin_)
        , end(end_)
        , dummy(dummy_)
{
	placeDummies();
	for (ContactList& list : contacts)
		list.setUnusedConstants(s.common);
	for (BondList& list : bonds)
		list.setUnused(s.commonBond, s.grains[dummy].x);
}

void TouchingPairs::placeDummies()
{
	s.grains[dummy] = Grain {};
	s.grains[dummy + 1] = Grain {};
	s.grains[dummy].x = s.common.radius1 + s.common.radius2 - s.common.equilibriumOverlap;
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
		Bond bond = newBond(i, j, separation);
		bond.constants = s.bondOf(i, j, s.neck);
		bonds[ownershipOf(i, j)].append(bond);
	});
	markIn(lists);
}

// Without contacts that a script has torn apart since the latest step.
TouchingPairs::AllBonds TouchingPairs::sintered(const PeriodicCell& cell, double neck) const
{
	AllBonds all;
	for (const Ownership o : ownerships) {
		for (int slot = 0; slot < bonds[o].size(); ++slot)
			if (bonds[o].isUsed(slot)) all[o].push_back(bonds[o].get(slot, s.commonBond));
		for (int slot = 0; slot < contacts[o].size(); ++slot) {
			if (!contacts[o].isUsed(slot)) continue;
			const Contact c = s.contactOf(contacts[o], slot);
			const Vec3<double> separation = s.separationOf(cell, c.i, c.j);
			if (normal::beyondPullOff(c.constants, geometryOf(separation, c.constants.radius1 + c.constants.radius2))) continue;
			all[o].push_back(newBond(c.i, c.j, separation));
			all[o].back().constants.neck = neck;
		}
	}
	return all;
}

void TouchingPairs::setBonds(const AllBonds& all)
{
	placeDummies();
	for (const Ownership o : ownerships) {
		contacts[o].clear();
		contacts[o].setUnusedConstants(s.common);
		bonds[o] = BondList(s.uniformBonds(), dummy);
		bonds[o].setUnused(s.commonBond, s.grains[dummy].x);
		for (Bond bond : all[o]) {
			bond.constants = s.bondOf(bond.i, bond.j, bond.constants.neck);
			bonds[o].append(bond);
		}
	}
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
			if (i > j) c.velocity = -c.velocity;
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
			list.writeVelocity(slot, s.motionOf(cell, list.first(slot), list.second(slot), image).velocity);
		}
}

/* A contact that formed costs more until it is sorted in, sorting costs in proportion to all of them: both together least when the first sum has grown to the second. */
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

} // namespace contact_law
