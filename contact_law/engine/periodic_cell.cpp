// What a periodic cell needs of a run beside its steps.
#include "dynamics.hpp"

namespace contact_law {

// Until grains have moved by more than a radius or two.
void Dynamics::setMostCells()
{
	if (!cell().on) return;
	Box all;
	for (const Group& group : setting.groups)
		all.include(group.box);
	const Vec3<double>& size = cell().size;
	mostCells = { all.edge(0) / size.x + 1, all.edge(1) / size.y + 1, all.edge(2) / size.z + 1 };
}

void Dynamics::setMeanField(const Vec3<double>& added, const Vec3<double>& convective)
{
	const auto same = [](const Vec3<double>& a, const Vec3<double>& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
	if (same(added, { 0, 0, 0 }) && same(convective, setting.convective)) return;
	for (auto& domain : domains)
		domain->sums.meanField += domain->kineticEnergy();
	kickAll(0.5 * setting.dt);
	for (int k = 0; k < count; ++k) {
		Grain& p = setting.grains[k];
		p.vx += added.x * p.x, p.vy += added.y * p.y, p.vz += added.z * p.z;
	}
	setting.convective = convective;
	velocitiesSet = true;
	outdateLists();
	kickAll(-0.5 * setting.dt);
	for (auto& domain : domains) {
		domain->sums.meanField -= domain->kineticEnergy();
		domain->cell.rate = domain->cell.rate
		        + Images<double>::times(added, domain->cell.size); // the images' velocities change with the grains'
	}
}

} // namespace contact_law
