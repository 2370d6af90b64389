// How long a run's small step may be, and why a run broke down.
#include "contacts.hpp"
#include <map>

namespace contact_law {

namespace {
	// Of each material, which grains may have as objects of their own, the smallest and the largest grain.
	std::vector<int> extremeGrains(const Dynamics& dynamics)
	{
		const SharedState& shared = dynamics.state();
		std::map<std::array<double, std::size(materialList)>, std::pair<int, int>> extremes;
		for (int k = 0; k < dynamics.grainCount(); ++k) {
			const Material& m = shared.material[shared.kind[k]];
#define CONTACT_LAW_OF_MATERIAL(name, ...) m.name,
			const std::array key { CONTACT_LAW_MATERIAL(CONTACT_LAW_OF_MATERIAL) };
			auto& [smallest, largest] = extremes.emplace(key, std::pair(k, k)).first->second;
			if (shared.grainRadius[k] < shared.grainRadius[smallest]) smallest = k;
			if (shared.grainRadius[k] > shared.grainRadius[largest]) largest = k;
		}
		std::vector<int> grains;
		for (const auto& [material, pair] : extremes)
			grains.insert(grains.end(), { pair.first, pair.second });
		return grains;
	}

	// Of the grain that is lightest, or turns most easily, beside a solid sphere of its material.
	double leastLightness(const Dynamics& dynamics)
	{
		const SharedState& shared = dynamics.state();
		double least = 1;
		for (int k = 0; k < dynamics.grainCount(); ++k) {
			const double r = shared.grainRadius[k], solid = 4 * pi / 3 * shared.material[shared.kind[k]].density * r * r * r;
			const double turning = massByInertia(1 / shared.inverseInertia[k], r);
			least = std::min(least, lightness(std::min(1 / shared.inverseMass[k], turning), solid));
		}
		return least;
	}

	/* visit(a grain, another one or itself), of pairs that have the least limit of all. For two materials a contact's limits rise
	 * with t0, which goes as m*^(1/2) R^(-1/3), and a bond's go as (m* / R)^(1/2) and (I* / R^3)^(1/2). With either radius each of
	 * these rises, and beyond some radius falls: the least is at an end. */
	template <class Visit> void eachExtremePair(const Dynamics& dynamics, Visit&& visit)
	{
		const std::vector<int> grains = extremeGrains(dynamics);
		for (std::size_t k = 0; k < grains.size(); ++k)
			for (std::size_t other = 0; other <= k; ++other)
				visit(grains[k], grains[other]);
	}
}

double mostStretched(const Dynamics& dynamics)
{
	const SharedState& shared = dynamics.state();
	double most = 0;
	eachExtremePair(dynamics, [&](int i, int j) {
		const double gap = shared.grainRadius[i] + shared.grainRadius[j] - shared.radius[i] - shared.radius[j]; // by sintering
		double stretch = 0;
		for (const double neck : shared.necks) {
			const BondConstants<double> b = shared.bondOf(i, j, neck);
			stretch = std::max(stretch, std::sqrt(2 * b.breakingEnergy / b.normalStiffness));
		}
		most = std::max(most, gap + shared.constantsOf(i, j).pullOffOverlap + stretch);
	});
	return most;
}

double unstableStepOfBonds(const Dynamics& dynamics, double neck)
{
	const SharedState& shared = dynamics.state();
	double least = 1e300;
	eachExtremePair(dynamics, [&](int i, int j) {
		const BondConstants<double> b = deriveBond(shared.material[shared.kind[i]], shared.grainRadius[i],
		        shared.material[shared.kind[j]], shared.grainRadius[j], shared.pairs, neck);
		least = std::min(least,
		        unstableStep(b, shared.inverseMass[i] + shared.inverseMass[j], shared.inverseInertia[i], shared.inverseInertia[j]));
	});
	return least;
}

double unstableStep(const Dynamics& dynamics)
{
	const SharedState& shared = dynamics.state();
	const double light = leastLightness(dynamics);
	double least = 1e300;
	eachExtremePair(dynamics, [&](int i, int j) { least = std::min(least, unstableStep(shared.constantsOf(i, j), light)); });
	for (const int k : extremeGrains(dynamics))
		for (int plane = 0; plane < int(shared.planes.size()); ++plane)
			least = std::min(least, unstableStep(shared.constantsOnPlane(k, plane), light));
	if (bondCount(dynamics) > 0)
		for (const double neck : shared.necks)
			least = std::min(least, unstableStepOfBonds(dynamics, neck));
	return least;
}

// ---- why a run broke down ----

namespace {
	// visit(Overlap), of every contact and bond of a domain's as it was a time `ago` [s].
	template <class Visit> void eachOverlap(const Dynamics& dynamics, const Domain& domain, double ago, Visit&& visit)
	{
		const SharedState& shared = dynamics.state();
		const auto visitSlot = [&](const auto& list, int slot, int first, int second) {
			const int i = list.first(slot), j = list.second(slot);
			const Grain &a = shared.grains[i], &b = shared.grains[j];
			Vec3<double> d = separationOf(a, b);
			if (ago > 0) d = d - ago * (velocityOf(a) - velocityOf(b));
			nearestImage(dynamics.cell(), d);
			const double overlap = shared.radius[i] + shared.radius[j] - std::sqrt(dot(d, d));
			visit(Overlap { dynamics.id(first), dynamics.id(second), overlap / std::min(shared.radius[i], shared.radius[j]) });
		};
		eachSlotOf(dynamics, domain, &TouchingPairs::contacts, visitSlot);
		eachSlotOf(dynamics, domain, &TouchingPairs::bonds, visitSlot);
		for (const PlaneContact& c : domain.planes.contacts)
			visit(Overlap { dynamics.id(dynamics.given(c.grain)), shared.planes[c.plane].id,
			        c.before.overlap / shared.radius[c.grain] });
	}
}

Fastest fastestGrain(const Dynamics& dynamics)
{
	Fastest found;
	for (int k = 0; k < dynamics.grainCount(); ++k) {
		const Vec3<double> velocity = velocityOf(dynamics.state().grains[k]);
		const double speed = std::sqrt(dot(velocity, velocity));
		if (speed > found.speed) found = { dynamics.id(dynamics.given(k)), speed };
	}
	return found;
}

Overlap deepestOverlap(const Dynamics& dynamics, double ago, int id)
{
	std::vector<Overlap> deepest(dynamics.parts().size());
#pragma omp parallel for num_threads(dynamics.threadCount())
	for (std::size_t d = 0; d < deepest.size(); ++d)
		eachOverlap(dynamics, *dynamics.parts()[d], ago, [&](const Overlap& one) {
			const bool its = id < 0 || one.first == id || one.second == id;
			if (its && (deepest[d].first < 0 || one.overlap > deepest[d].overlap)) deepest[d] = one;
		});
	const auto less = [](const Overlap& a, const Overlap& b) { return a.overlap < b.overlap; };
	return *std::max_element(deepest.begin(), deepest.end(), less);
}

} // namespace contact_law
