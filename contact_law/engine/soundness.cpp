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
			const std::array key { m.young, m.poisson, m.density, m.surfaceEnergy, m.criticalRolling, m.viscoelasticTime };
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
		        shared.material[shared.kind[j]], shared.grainRadius[j], neck);
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
	double speedSquared(const Grain& g) { return dot(velocityOf(g), velocityOf(g)); }

	int fastestGrain(const Dynamics& dynamics)
	{
		const Grain* grains = dynamics.state().grains.data();
		return int(std::max_element(grains, grains + dynamics.grainCount(), [](const Grain& a, const Grain& b) {
			return speedSquared(a) < speedSquared(b);
		}) - grains);
	}

	// Where the pair was before it moved in the latest step: what pushed was the force there.
	Vec3<double> separationBefore(const Dynamics& dynamics, int i, int j)
	{
		const Grain &a = dynamics.state().grains[i], &b = dynamics.state().grains[j];
		Vec3<double> d = separationOf(a, b) - dynamics.state().dt * (velocityOf(a) - velocityOf(b));
		nearestImage(dynamics.cell(), d);
		return d;
	}

	double relativeOverlap(const SharedState& shared, int i, int j, const Vec3<double>& d)
	{
		return (shared.radius[i] + shared.radius[j] - std::sqrt(dot(d, d))) / std::min(shared.radius[i], shared.radius[j]);
	}
	double relativeOverlap(const SharedState& shared, const PlaneContact& c) { return c.before.overlap / shared.radius[c.grain]; }

	// The elastic part of the normal force, with the pair's grains at this distance from each other; positive when repulsive [N].
	double elasticForce(const Dynamics& dynamics, const ContactList& list, int slot, const Vec3<double>& separation)
	{
		const PairConstants<double> c = dynamics.state().constantsOf(list.first(slot), list.second(slot));
		ContactForces<double> f {};
		normal::addForces(c, geometryOf(separation, c.radius1 + c.radius2), f);
		return f.normalForce;
	}

	double elasticForce(const Dynamics& dynamics, const BondList& list, int slot, const Vec3<double>& separation)
	{
		const Bond b = list.get(slot, dynamics.state().commonBond);
		return bondForces(b.constants, geometryOf(separation, b.rest), b.history).normalForce;
	}

	double elasticForce(const PlaneContact& c)
	{
		ContactForces<double> f {};
		normal::addForces(c.constants, ContactGeometry<double> { {}, 0, c.before.overlap }, f);
		return f.normalForce;
	}

	int idOf(const Dynamics& dynamics, int here) { return dynamics.id(dynamics.given(here)); }

	Diagnosis deepestOverlap(const Dynamics& dynamics, const Domain& domain)
	{
		const SharedState& shared = dynamics.state();
		Diagnosis found;
		eachSlotOf(dynamics, domain, &TouchingPairs::contacts, [&](const ContactList& list, int slot, int, int) {
			const int i = list.first(slot), j = list.second(slot);
			const double overlap = relativeOverlap(shared, i, j, shared.separationOf(dynamics.cell(), i, j));
			if (overlap <= std::max(1., found.overlap)) return;
			const int first = idOf(dynamics, i), second = idOf(dynamics, j);
			found = { std::min(first, second), std::max(first, second), 0, overlap };
		});
		for (const PlaneContact& c : domain.planes.contacts) {
			const double overlap = relativeOverlap(shared, c);
			if (overlap > std::max(1., found.overlap))
				found = { idOf(dynamics, c.grain), shared.planes[c.plane].id, 0, overlap };
		}
		return found;
	}
}

Diagnosis diagnoseGrain(const Dynamics& dynamics, int given)
{
	const SharedState& shared = dynamics.state();
	const int grain = given == FastestGrain ? fastestGrain(dynamics) : dynamics.here(given);
	Diagnosis found;
	found.grain = idOf(dynamics, grain);
	found.speed = std::sqrt(speedSquared(shared.grains[grain]));
	const auto take = [&](int other, double overlap, double force) {
		if (found.other >= 0 && std::abs(force) <= std::abs(found.force)) return;
		found.other = other, found.overlap = overlap, found.force = force;
	};
	const auto consider = [&](const auto& list, int slot, int, int) {
		const int i = list.first(slot), j = list.second(slot);
		if (i != grain && j != grain) return;
		const Vec3<double> d = separationBefore(dynamics, i, j);
		take(idOf(dynamics, i == grain ? j : i), relativeOverlap(shared, i, j, d), elasticForce(dynamics, list, slot, d));
	};
	eachContact(dynamics, consider);
	eachBond(dynamics, consider);
	eachPlaneContact(dynamics, [&](const Domain&, const PlaneContact& c) {
		if (c.grain == grain) take(shared.planes[c.plane].id, relativeOverlap(shared, c), elasticForce(c));
	});
	return found;
}

Diagnosis deepestOverlap(const Dynamics& dynamics)
{
	std::vector<Diagnosis> worst(dynamics.parts().size());
#pragma omp parallel for num_threads(dynamics.threadCount())
	for (std::size_t d = 0; d < worst.size(); ++d)
		worst[d] = deepestOverlap(dynamics, *dynamics.parts()[d]);
	return *std::max_element(worst.begin(), worst.end(), [](const Diagnosis& a, const Diagnosis& b) { return a.overlap < b.overlap; });
}

} // namespace contact_law
