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

	int idOf(const Dynamics& dynamics, int here) { return dynamics.id(dynamics.given(here)); }

	struct Pair { // here
		int i, j;
	};
	// in rising order
	Diagnosis ofPair(const Dynamics& dynamics, Pair p, double overlap, double force)
	{
		const int first = idOf(dynamics, p.i), second = idOf(dynamics, p.j);
		return { std::min(first, second), std::max(first, second), 0, overlap, force };
	}
	Diagnosis ofPair(const Dynamics& dynamics, const PlaneContact& c, double overlap, double force)
	{
		return { idOf(dynamics, c.grain), dynamics.state().planes[c.plane].id, 0, overlap, force };
	}

	double relativeOverlap(const SharedState& shared, const PlaneContact& c) { return c.before.overlap / shared.radius[c.grain]; }
	double normalForce(const PlaneContact& c)
	{
		const ContactGeometry<double> g { {}, 0, c.before.overlap };
		return contactForces<0>(c.constants, g, PlaneHistory<double> {}, Vec3<double> {}).normalForce;
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
				if (overlap > found.overlap) found = ofPair(dynamics, Pair { i, j }, overlap, 0);
			}
		}
		for (const PlaneContact& c : domain.planes.contacts) {
			const double overlap = relativeOverlap(shared, c);
			if (overlap > std::max(1., found.overlap)) found = ofPair(dynamics, c, overlap, 0);
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
	const auto consider = [&](int i, int j, const Vec3<double>& d, double force) {
		take(idOf(dynamics, i == grain ? j : i), relativeOverlap(shared, i, j, d), force);
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
	eachPlaneContact(dynamics, [&](const Domain&, const PlaneContact& c) {
		if (c.grain == grain) take(shared.planes[c.plane].id, relativeOverlap(shared, c), normalForce(c));
	});
	return found;
}

Diagnosis largestForce(const Dynamics& dynamics)
{
	Diagnosis found;
	const auto take = [&](const auto& pair, double overlap, double force) {
		if (found.grain < 0 || std::abs(force) > std::abs(found.force)) found = ofPair(dynamics, pair, overlap, force);
	};
	const auto considerSlot = [&](const auto& list, int slot, int, int) {
		const Pair p { list.first(slot), list.second(slot) };
		const double overlap = relativeOverlap(dynamics.state(), p.i, p.j, separationNow(dynamics, p.i, p.j));
		take(p, overlap, normalForceNow(dynamics, list, slot));
	};
	eachContact(dynamics, considerSlot);
	eachBond(dynamics, considerSlot);
	eachPlaneContact(
	        dynamics, [&](const Domain&, const PlaneContact& c) { take(c, relativeOverlap(dynamics.state(), c), normalForce(c)); });
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
