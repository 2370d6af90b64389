// What a domain holds: contacts, bonds, and what concerns single grains, placed, taken out and sorted.
#include "domain.hpp"
#include "contacts.hpp"
#include <algorithm>

namespace contact_law {

namespace {
	constexpr double sortingCost = 1; // of a contact, over what one costs a step more for being out of order (measured)

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
	for (ContactList& list : contacts)
		all.contacts.push_back(list), list.clear();
	for (BondList& list : bonds)
		all.bonds.push_back(list), list.clear();
	all.constrained.swap(constraints.grains);
	all.outside.swap(outside.grains);
	return all;
}

void Domain::place(const Contents& all, const std::vector<int>& to)
{
	for (int sort = Both; sort <= First; ++sort) { // the domain of the second grain holds the same ones
		place(all.contacts[sort], to, contacts, [this](const ContactList& list, int lane, int i, int j) {
			Contact c = list.get(lane, s.constantsOf(std::min(i, j), std::max(i, j)));
			if (i > j) c.velocity = -c.velocity;
			return c;
		});
		place(all.bonds[sort], to, bonds, [this](const BondList& list, int lane, int i, int j) {
			Bond b = list.get(lane, s.commonBond);
			if (i > j) std::swap(b.constants.radius1, b.constants.radius2);
			return b;
		});
	}
	place(renumbered(all.constrained, to));
	place(renumbered(all.outside, to));
}

// get(list, lane, i, j): one whose grains are i and j now.
template <class List, class Get> void Domain::place(const List& from, const std::vector<int>& to, List (&own)[3], const Get& get)
{
	for (int lane = 0; lane < from.size(); ++lane) {
		if (!from.alive(lane)) continue;
		const int i = to[from.first(lane)], j = to[from.second(lane)];
		if (!owns(i) && !owns(j)) continue;
		auto one = get(from, lane, i, j);
		one.i = std::min(i, j), one.j = std::max(i, j);
		if (i > j) one.history = swapped(one.history);
		own[sortOf(one.i, one.j)].append(one);
	}
}

void Domain::place(const std::vector<Constrained>& all)
{
	for (const Constrained& c : all)
		if (owns(c.grain)) constraints.grains.push_back(c);
	sortByGrain(constraints.grains);
}

void Domain::place(const std::vector<OutsideForce>& all)
{
	for (const OutsideForce& f : all)
		if (owns(f.grain)) outside.grains.push_back(f);
	sortByGrain(outside.grains);
}

void Domain::markTouching()
{
	const auto mark = [this](const auto& list) {
		for (int lane = 0; lane < list.size(); ++lane)
			if (list.alive(lane)) lists.touch(list.first(lane), list.second(lane));
	};
	for (const ContactList& list : contacts)
		mark(list);
	for (const BondList& list : bonds)
		mark(list);
}

void Domain::takeVelocities()
{
	if (!s.hasDrag()) return;
	for (ContactList& list : contacts)
		for (int lane = 0; lane < list.size(); ++lane) {
			if (!list.alive(lane)) continue;
			Image image;
			list.writeVelocity(lane, motionOf(list.first(lane), list.second(lane), image).velocity);
		}
}

/* A contact that formed costs more until it is sorted in, sorting costs in proportion to all of them: both together least when the first sum has grown to the second. */
void Domain::sortIfWorthwhile()
{
	++stepsSinceSort;
	if (double(changed) * stepsSinceSort > sortingCost * (contacts[Both].size() + contacts[First].size() + contacts[Second].size()))
		sortContacts();
}

void Domain::sortContacts()
{
	for (ContactList& list : contacts)
		list.sort();
	for (BondList& list : bonds)
		list.sort();
	sortedBlocks = contacts[Both].blockCount();
	changed = stepsSinceSort = 0;
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

void Domain::place(const Contact& c)
{
	if (owns(c.i) || owns(c.j)) contacts[sortOf(c.i, c.j)].append(c);
}

void Domain::placeOverlapping()
{
	lists.each([this](int i, int j) {
		Vec3<double> separation = separationOf(s.grains[i], s.grains[j]);
		nearestImage(cell, separation);
		const ContactMotion m { separation, { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 }, s.dt, 0 };
		const double overlap = s.radius[i] + s.radius[j] - std::sqrt(dot(separation, separation));
		if (overlap <= 0) return;
		contacts[sortOf(i, j)].append({ i, j, contact_law::events::formedHistory(m, 0), s.constantsOf(i, j), 0, overlap });
	});
	markTouching();
}

} // namespace contact_law
