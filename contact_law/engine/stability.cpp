#include "stability.hpp"
#include "contacts.hpp"
#include <set>

namespace contact_law {

double unstableStep(const Dynamics& dynamics)
{
	const Setting& setting = dynamics.state();
	const bool bonded = bondCount(dynamics) > 0;
	double least = 1e300;
	std::set<std::pair<int, double>> seen;
	for (int k = 0; k < dynamics.grainCount(); ++k) {
		if (!seen.emplace(setting.kind[k], setting.radius[k]).second) continue;
		const PairConstants<double> c = setting.constantsOf(k, k);
		if (bonded)
			least = std::min(
			        least, 2 / fastestVibration(setting.bondOf(k, k), setting.inverseMass[k], setting.inverseInertia[k]));
		const double drag = c.dragPerContactRadius * c.equilibriumContactRadius + c.linearDrag;
		least = std::min({ least, 0.5 * c.timeUnit, drag > 0 ? c.reducedMass / drag : least });
	}
	return least;
}

} // namespace contact_law
