// What a periodic cell needs of a run apart from its steps.
#include "dynamics.hpp"

namespace contact_law {

// Until grains have moved by more than a radius or two.
void Dynamics::setMostCells()
{
	if (!cell().on) return;
	Box all;
	for (const Group& group : shared.groups)
		all.include(group.box);
	const Vec3<double>& size = cell().size;
	mostCells = { all.edge(0) / size.x + 1, all.edge(1) / size.y + 1, all.edge(2) / size.z + 1 };
}

void Dynamics::setMeanField(const Vec3<double>& added, const Vec3<double>& convective)
{
	const auto same = [](const Vec3<double>& a, const Vec3<double>& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
	if (same(added, { 0, 0, 0 }) && same(convective, shared.convective)) return;
	for (auto& domain : domains)
		domain->ledger.addMeanFieldWork(domain->kineticEnergy());
	kickAll(0.5 * shared.dt);
	for (int k = 0; k < count; ++k) {
		Grain& p = shared.grains[k];
		p.vx += added.x * p.x, p.vy += added.y * p.y, p.vz += added.z * p.z;
	}
	shared.convective = convective;
	velocitiesSet = true;
	outdateLists();
	kickAll(-0.5 * shared.dt);
	for (auto& domain : domains) {
		domain->ledger.addMeanFieldWork(-domain->kineticEnergy());
		domain->cell.rate = domain->cell.rate
		        + Images<double>::times(added, domain->cell.size); // the images' velocities change with the grains'
	}
}

} // namespace contact_law
