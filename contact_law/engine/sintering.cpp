// Sintering: what necks make of the grains, at the start and in the middle of a run.
#include "contacts.hpp"
#include "stability.hpp"
#include <numeric>

namespace contact_law {

// The radii that ordinary contacts see, and all that follows from them and from the necks.
void Dynamics::shrinkGrains()
{
	const double shrunk = neck::shrunkRadius(shared.neck);
	shared.radius.resize(count);
	for (int k = 0; k < count; ++k)
		shared.radius[k] = shrunk * shared.grainRadius[k];
	const auto [smallest, largest] = std::minmax_element(shared.radius.begin(), shared.radius.end());
	shared.smallestRadius = *smallest;
	shared.largestRadius = *largest;
	shared.setLeastKick();
	const Material& m = shared.material[shared.kind[0]];
	const double r = shared.grainRadius[0];
	shared.common = deriveShrunkPair(m, r, m, r, shared.pairs, shared.neck);
	if (shared.neck > 0) shared.commonBond = deriveBond(m, r, m, r, shared.necks.size() == 1 ? shared.necks[0] : shared.neck);
	shared.skin = std::max(0.8 * shared.smallestRadius, 1.1 * mostStretched(*this));
}

// Velocities at the positions' moment. Forces go: half of their kick belongs after it.
void Dynamics::bringVelocitiesToPositions()
{
	kickEarly(shared.dt);
	for (auto& domain : domains)
		domain->ledger.forgetEarlyKicks();
	kickAll(0.5 * shared.dt);
	for (int k = 0; k < count; ++k) {
		Grain& g = shared.grains[k];
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
	if (bondCount(*this) == 0) shared.necks.clear();
	std::vector<TouchingPairs::AllBonds> bonds;
	for (auto& domain : domains)
		bonds.push_back(domain->touching.sintered(cell(), neck));

	if (std::find(shared.necks.begin(), shared.necks.end(), neck) == shared.necks.end()) shared.necks.push_back(neck);
	shared.neck = std::max(shared.neck, neck);
	shared.displaced.clear(); // bonds are made where grains are now
	shrinkGrains();
	for (std::size_t d = 0; d < domains.size(); ++d)
		domains[d]->touching.setBonds(bonds[d]);
	makeLists();
	firstForces();
	domains[0]->ledger.bookDisconnection(before - total());
}

} // namespace contact_law
