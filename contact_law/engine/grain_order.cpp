// The order in which grains are stored: the leaves of a k-d tree. Domains are its upper branches, groups lower ones.
#include "contacts.hpp"
#include <algorithm>
#include <functional>
#include <numeric>

namespace contact_law {

namespace {
	constexpr int leaf = 4;

	using Positions = std::vector<Vec3<double>>;

	int widestAxis(const Positions& positions, const int* first, const int* last)
	{
		Box box;
		for (const int* at = first; at < last; ++at)
			box.include(&positions[*at].x);
		int axis = 0;
		for (int k = 1; k < 3; ++k)
			if (box.edge(k) > box.edge(axis)) axis = k;
		return axis;
	}

	// Where a branch within a domain is cut: between groups, then in the middle.
	int middleOf(int first, int last)
	{
		const int size = last - first;
		return first + (size > grainsInGroup ? (size / grainsInGroup + 1) / 2 * grainsInGroup : size / 2);
	}
}

/* Branches are cut across their longest axis, the first of them so that each side has half of the grains: of two like aggregates each
 * is a side, and no contact crosses the border between them. */
void Dynamics::orderGrains(const Positions& positions)
{
	original.resize(count);
	std::iota(original.begin(), original.end(), 0);
	const auto cut = [&](int first, int middle, int last) { // grains
		const int axis = widestAxis(positions, original.data() + first, original.data() + last);
		std::nth_element(original.begin() + first, original.begin() + middle, original.begin() + last, [&](int i, int j) {
			const double x = (&positions[i].x)[axis], y = (&positions[j].x)[axis];
			return x != y ? x < y : i < j;
		});
	};
	const std::function<void(int, int)> cutDomains = [&](int first, int last) { // domains
		if (last - first == 1) return;
		const int middle = (first + last) / 2;
		cut(beginOf(first), beginOf(middle), beginOf(last));
		cutDomains(first, middle);
		cutDomains(middle, last);
	};
	const std::function<void(int, int)> cutGrains = [&](int first, int last) {
		if (last - first <= leaf) return;
		const int middle = middleOf(first, last);
		cut(first, middle, last);
		cutGrains(first, middle);
		cutGrains(middle, last);
	};
	cutDomains(0, domainCount());
#pragma omp parallel for num_threads(threadCount())
	for (int d = 0; d < domainCount(); ++d)
		cutGrains(beginOf(d), beginOf(d + 1));
	for (int k = 0; k < count; ++k)
		indexHere[original[k]] = k;
}

double Dynamics::groupSizes()
{
	double sum = 0;
	for (auto& domain : domains)
		domain->lists.measureBoxes();
	for (const Group& group : shared.groups)
		for (int k = 0; k < 3; ++k)
			sum += group.box.edge(k);
	return sum;
}

namespace {
	template <class Values> void arrange(Values& values, const std::vector<int>& from)
	{
		if (values.empty()) return;
		const Values before = values;
		for (std::size_t k = 0; k < from.size(); ++k)
			values[k] = before[from[k]];
	}
}

/* Where groups have spread (fragments that fly apart), grains are put into a new order: neighbours lie close again. Between two steps;
 * nothing else changes but the order in which contacts add their forces. */
void Dynamics::reorder()
{
	std::vector<Vec3<double>> positions(count);
	for (int k = 0; k < count; ++k)
		positions[original[k]] = positionOf(shared.grains[k]);
	const std::vector<int> hereBefore = indexHere;
	orderGrains(positions);
	std::vector<int> from(count), to(count);
	for (int k = 0; k < count; ++k)
		from[k] = hereBefore[original[k]], to[from[k]] = k;
	std::vector<Domain::Contents> contents;
	for (auto& domain : domains)
		contents.push_back(domain->takeOut());
	arrange(shared.grains, from);
	for (auto* values : { &shared.inverseMass, &shared.inverseInertia, &shared.radius, &shared.grainRadius })
		arrange(*values, from);
	arrange(shared.kind, from);
	arrange(shared.orientation, from);
	arrange(shared.blocked, from);
	arrange(shared.displaced, from);
	for (auto& domain : domains)
		domain->ledger.renumber(to);
#pragma omp parallel for num_threads(threadCount())
	for (auto& domain : domains) {
		for (const Domain::Contents& its : contents)
			domain->place(its, to);
		domain->touching.sort();
	}
	makeLists();
	sizesWhenOrdered = groupSizes();
	++orders;
}

} // namespace contact_law
