#include "stability.hpp"
#include "contacts.hpp"
#include <set>

namespace contact_law {

namespace {
	// visit(a grain), of each kind
	template <class Visit> void eachKind(const Dynamics& dynamics, Visit&& visit)
	{
		const SharedState& shared = dynamics.state();
		std::set<std::pair<int, double>> seen;
		for (int k = 0; k < dynamics.grainCount(); ++k)
			if (seen.emplace(shared.kind[k], shared.grainRadius[k]).second) visit(k);
	}
}

double unstableStepOfBonds(const Dynamics& dynamics, double neck)
{
	const SharedState& shared = dynamics.state();
	double least = 1e300;
	eachKind(dynamics, [&](int k) {
		const Material& m = shared.material[shared.kind[k]];
		const BondConstants<double> b = deriveBond(m, shared.grainRadius[k], m, shared.grainRadius[k], neck);
		least = std::min(least, unstableStep(b, 2 * shared.inverseMass[k], shared.inverseInertia[k], shared.inverseInertia[k]));
	});
	return least;
}

double unstableStep(const Dynamics& dynamics)
{
	double least = 1e300;
	const auto consider = [&least](const PairConstants<double>& c) { least = std::min(least, unstableStep(c)); };
	eachKind(dynamics, [&](int k) {
		consider(dynamics.state().constantsOf(k, k));
		for (int plane = 0; plane < int(dynamics.state().planes.size()); ++plane)
			consider(dynamics.state().constantsOnPlane(k, plane));
	});
	if (bondCount(dynamics) > 0)
		for (const double neck : dynamics.state().necks)
			least = std::min(least, unstableStepOfBonds(dynamics, neck));
	return least;
}

} // namespace contact_law
