#include "diagnosis.hpp"
#include "contacts.hpp"

namespace contact_law {

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

	Vec3<double> separationNow(const Dynamics& dynamics, int i, int j) { return dynamics.state().separationOf(dynamics.cell(), i, j); }

	double relativeOverlap(const SharedState& shared, int i, int j, const Vec3<double>& d)
	{
		return (shared.radius[i] + shared.radius[j] - std::sqrt(dot(d, d))) / std::min(shared.radius[i], shared.radius[j]);
	}

	struct Pair { // here
		int i, j;
	};
	// as given, in rising order
	Diagnosis ofPair(const Dynamics& dynamics, Pair p, double overlap, double force)
	{
		const int first = dynamics.given(p.i), second = dynamics.given(p.j);
		return { std::min(first, second), std::max(first, second), 0, overlap, force };
	}

	Diagnosis deepestOverlap(const Dynamics& dynamics, const Domain& domain)
	{
		const SharedState& shared = dynamics.state();
		Diagnosis found;
		for (const Ownership o : counted) {
			const ContactList& list = domain.touching.contacts[o];
			for (int slot = 0; slot < list.size(); ++slot) {
				if (!list.isUsed(slot)) continue;
				const int i = list.first(slot), j = list.second(slot);
				const Vec3<double> d = separationNow(dynamics, i, j);
				const double least = std::max(shared.radius[i], shared.radius[j]);
				if (dot(d, d) >= least * least) continue;
				const double overlap = relativeOverlap(shared, i, j, d);
				if (overlap > found.overlap) found = ofPair(dynamics, { i, j }, overlap, 0);
			}
		}
		return found;
	}
}

Diagnosis diagnoseGrain(const Dynamics& dynamics, int given)
{
	const SharedState& shared = dynamics.state();
	const int grain = given == FastestGrain ? fastestGrain(dynamics) : dynamics.here(given);
	Diagnosis found;
	found.grain = dynamics.given(grain);
	found.speed = std::sqrt(speedSquared(shared.grains[grain]));
	const auto consider = [&](int i, int j, const Vec3<double>& d, double force) {
		if (found.other >= 0 && std::abs(force) <= std::abs(found.force)) return;
		found.other = dynamics.given(i == grain ? j : i);
		found.overlap = relativeOverlap(shared, i, j, d);
		found.force = force;
	};
	eachContact(dynamics, [&](const ContactList& list, int slot, int, int) {
		if (list.first(slot) != grain && list.second(slot) != grain) return;
		const Contact c = shared.contactOf(list, slot);
		const Vec3<double> d = separationBefore(dynamics, c.i, c.j);
		const auto g = geometryOf(d, c.constants.radius1 + c.constants.radius2);
		consider(c.i, c.j, d, contactForces<0>(c.constants, g, c.history, Vec3<double> {}).normalForce);
	});
	eachBond(dynamics, [&](const BondList& list, int slot, int, int) {
		if (list.first(slot) != grain && list.second(slot) != grain) return;
		const Bond b = list.get(slot, shared.commonBond);
		const Vec3<double> d = separationBefore(dynamics, b.i, b.j);
		consider(b.i, b.j, d, b.constants.normalStiffness * (b.rest - std::sqrt(dot(d, d))));
	});
	return found;
}

Diagnosis largestForce(const Dynamics& dynamics)
{
	Diagnosis found;
	const auto consider = [&](int i, int j, double force) {
		if (found.grain >= 0 && std::abs(force) <= std::abs(found.force)) return;
		found = ofPair(dynamics, { i, j }, relativeOverlap(dynamics.state(), i, j, separationNow(dynamics, i, j)), force);
	};
	const auto considerSlot = [&](const auto& list, int slot, int, int) {
		consider(list.first(slot), list.second(slot), normalForceNow(dynamics, list, slot));
	};
	eachContact(dynamics, considerSlot);
	eachBond(dynamics, considerSlot);
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
