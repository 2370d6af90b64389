// The order in which grains are stored: the leaves of a k-d tree. Domains are its upper branches, groups lower ones.
#include "dynamics.hpp"
#include <algorithm>
#include <numeric>

namespace contact_law {

namespace {
	constexpr int leaf = 4;

	struct Branch {
		int firstDomain, lastDomain; // the last one not among them
		int first, last;             // grains
	};

	int widestAxis(const std::vector<GrainInput>& grains, const int* first, const int* last)
	{
		double widest = -1;
		int axis = 0;
		for (int k = 0; k < 3; ++k) {
			double low = 1e300, high = -1e300;
			for (const int* at = first; at < last; ++at) {
				low = std::min(low, grains[*at].position[k]);
				high = std::max(high, grains[*at].position[k]);
			}
			if (high - low > widest) widest = high - low, axis = k;
		}
		return axis;
	}

	// Where a branch within a domain is cut: between groups, then in the middle.
	int cut(int first, int last)
	{
		const int size = last - first;
		return first + (size > grainsInGroup ? (size / grainsInGroup + 1) / 2 * grainsInGroup : size / 2);
	}
}

/* Branches are cut across their longest axis, the first of them so that each side has half of the grains: of two like aggregates each is a side, and no contact crosses the
 * border between them. */
void Dynamics::orderGrains(const std::vector<GrainInput>& grains)
{
	original.resize(count);
	std::iota(original.begin(), original.end(), 0);
	std::vector<Branch> branches { { 0, domainCount(), 0, count } };
	while (!branches.empty()) {
		const Branch b = branches.back();
		branches.pop_back();
		const bool oneDomain = b.lastDomain - b.firstDomain == 1;
		if (oneDomain && b.last - b.first <= leaf) continue;
		const int middleDomain = (b.firstDomain + b.lastDomain) / 2;
		const int middle = oneDomain ? cut(b.first, b.last) : beginOf(middleDomain);
		const int axis = widestAxis(grains, original.data() + b.first, original.data() + b.last);
		std::nth_element(original.begin() + b.first, original.begin() + middle, original.begin() + b.last, [&](int i, int j) {
			const double x = grains[i].position[axis], y = grains[j].position[axis];
			return x != y ? x < y : i < j;
		});
		branches.push_back({ b.firstDomain, oneDomain ? b.lastDomain : middleDomain, b.first, middle });
		branches.push_back({ oneDomain ? b.firstDomain : middleDomain, b.lastDomain, middle, b.last });
	}
}

} // namespace contact_law
