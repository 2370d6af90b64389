// Sintering: what necks make of the grains, at the start and in the middle of a run.
#include "contacts.hpp"
#include <numeric>

namespace contact_law {

// The radii that ordinary contacts see, and all that follows from them and from the necks.
void Dynamics::shrinkGrains()
{
	const double shrunk = neck::shrunkRadius(setting.neck);
	setting.radius.resize(count);
	for (int k = 0; k < count; ++k)
		setting.radius[k] = shrunk * setting.grainRadius[k];
	const auto [smallest, largest] = std::minmax_element(setting.radius.begin(), setting.radius.end());
	setting.smallestRadius = *smallest;
	setting.largestRadius = *largest;
	setting.farGap = 0.8 * setting.smallestRadius;
	setting.setLeastKick();
	const Material& m = setting.material[setting.kind[0]];
	const double r = setting.grainRadius[0];
	setting.common = deriveShrunkPair(m, r, m, r, setting.pairs, setting.neck);
	if (setting.neck > 0) setting.commonBond = deriveBond(m, r, m, r, setting.necks.size() == 1 ? setting.necks[0] : setting.neck);
}

// Velocities at the positions' moment. Forces go: half of their kick belongs after it.
void Dynamics::bringVelocitiesToPositions()
{
	kickEarly(setting.dt);
	for (auto& domain : domains)
		domain->early.clear();
	kickAll(0.5 * setting.dt);
	for (int k = 0; k < count; ++k) {
		Grain& g = setting.grains[k];
		g.fx = g.fy = g.fz = g.tx = g.ty = g.tz = 0;
	}
}

/* Velocities are brought to the positions' moment and half a step back again with the forces after it, as at a start. What sum of kinetic and
 * stored energies that leaves out is what the contacts held (and, of second order, what a leapfrog's kinetic energy has of the forces). */
void Dynamics::sinter(double neck)
{
	const auto total = [&] {
		const auto values = byChannel(energies());
		return std::accumulate(values.begin(), values.end(), 0.);
	};
	const double before = total();
	bringVelocitiesToPositions();
	if (bondCount(*this) == 0) setting.necks.clear();
	std::vector<Domain::AllBonds> bonds;
	for (auto& domain : domains)
		bonds.push_back(domain->sintered(neck));

	if (std::find(setting.necks.begin(), setting.necks.end(), neck) == setting.necks.end()) setting.necks.push_back(neck);
	setting.neck = options.neck = std::max(setting.neck, neck);
	shrinkGrains();
	for (std::size_t d = 0; d < domains.size(); ++d)
		domains[d]->setBonds(bonds[d]);
	makeLists();
	firstForces();
	domains[0]->sums.dissipated.disconnection += before - total();
}

} // namespace contact_law
