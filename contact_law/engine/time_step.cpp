// Another length of the step in the middle of a run.
#include "dynamics.hpp"

namespace contact_law {

void Dynamics::kickEarly(double time)
{
	for (auto& domain : domains)
		for (const EarlyKick& early : domain->early) {
			Grain& g = setting.grains[early.grain];
			const unsigned blocked = setting.blocked[early.grain];
			const double m = time * setting.inverseMass[early.grain], i = time * setting.inverseInertia[early.grain];
			const Vec3<double> push = m * (early.force - blockedForce(early.force, blocked));
			const Vec3<double> turn = i * (early.torque - blockedTorque(early.torque, blocked));
			g.vx += push.x, g.vy += push.y, g.vz += push.z;
			g.wx += turn.x, g.wy += turn.y, g.wz += turn.z;
		}
}

/* The part of this moment's kicks that belongs before it was meant for the step that has been, the rest for the one to come (MODEL.md, "Steps of changing
 * length"): velocities, which are those of half a step ago, move on to half a new step ago. Lists reckon in steps, and are looked after anew. */
void Dynamics::setStep(double dt)
{
	const double before = setting.dt;
	if (dt == before) return;
	kickEarly(before - dt);
	kickAll(0.5 * before);
	kickAll(-0.5 * dt);
	setting.dt = dt;
	setting.setLeastKick();
	for (auto& domain : domains) {
		domain->sums.eventWork = 0;
		for (const EarlyKick& early : domain->early) {
			const Grain& g = setting.grains[early.grain];
			domain->sums.eventWork += dt * (dot(early.force, velocityOf(g)) + dot(early.torque, spinOf(g)));
		}
	}
	velocitiesSet = true;
	outdateLists();
}

} // namespace contact_law
