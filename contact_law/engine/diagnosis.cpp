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

	Vec3<double> separationNow(const Dynamics& dynamics, int i, int j)
	{
		Vec3<double> d = separationOf(dynamics.state().grains[i], dynamics.state().grains[j]);
		nearestImage(dynamics.cell(), d);
		return d;
	}

	double relativeOverlap(const Setting& setting, int i, int j, const Vec3<double>& d)
	{
		return (setting.radius[i] + setting.radius[j] - std::sqrt(dot(d, d))) / std::min(setting.radius[i], setting.radius[j]);
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
		const Setting& setting = dynamics.state();
		Diagnosis found;
		for (int sort = 0; sort < 2; ++sort) {
			const ContactList& list = domain.contacts[sort];
			for (int lane = 0; lane < list.size(); ++lane) {
				if (!list.alive(lane)) continue;
				const int i = list.first(lane), j = list.second(lane);
				const Vec3<double> d = separationNow(dynamics, i, j);
				const double least = std::max(setting.radius[i], setting.radius[j]);
				if (dot(d, d) >= least * least) continue;
				const double overlap = relativeOverlap(setting, i, j, d);
				if (overlap > found.overlap) found = ofPair(dynamics, { i, j }, overlap, 0);
			}
		}
		return found;
	}
}

Diagnosis diagnoseGrain(const Dynamics& dynamics, int given)
{
	const Setting& setting = dynamics.state();
	const int grain = given == FastestGrain ? fastestGrain(dynamics) : dynamics.here(given);
	Diagnosis found;
	found.grain = dynamics.given(grain);
	found.speed = std::sqrt(speedSquared(setting.grains[grain]));
	const auto consider = [&](int i, int j, const Vec3<double>& d, double force) {
		if (found.other >= 0 && std::abs(force) <= std::abs(found.force)) return;
		found.other = dynamics.given(i == grain ? j : i);
		found.overlap = relativeOverlap(setting, i, j, d);
		found.force = force;
	};
	eachContactLane(dynamics, [&](const ContactList& list, int lane, int, int) {
		if (list.first(lane) != grain && list.second(lane) != grain) return;
		const Contact c = setting.contactOf(list, lane);
		const Vec3<double> d = separationBefore(dynamics, c.i, c.j);
		const auto g = geometryOf(d, c.constants.radius1 + c.constants.radius2);
		consider(c.i, c.j, d, contactForces<0>(c.constants, g, c.history, Vec3<double> {}).normalForce);
	});
	eachBondLane(dynamics, [&](const BondList& list, int lane, int, int) {
		if (list.first(lane) != grain && list.second(lane) != grain) return;
		const Bond b = list.get(lane, setting.commonBond);
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
	const auto look = [&](const auto& list, int lane, int, int) {
		consider(list.first(lane), list.second(lane), normalForceNow(dynamics, list, lane));
	};
	eachContactLane(dynamics, look);
	eachBondLane(dynamics, look);
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
