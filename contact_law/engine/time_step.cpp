// Another length of the step in the middle of a run.
#include "dynamics.hpp"

namespace contact_law {

void kickEarly(const SharedState& shared, const EarlyKick& early, Grain& g, double time)
{
	const unsigned blocked = shared.blocked[early.grain];
	const double m = time * shared.inverseMass[early.grain], i = time * shared.inverseInertia[early.grain];
	const Vec3<double> push = m * (early.force - blockedForce(early.force, blocked));
	const Vec3<double> turn = i * (early.torque - blockedTorque(early.torque, blocked));
	g.vx += push.x, g.vy += push.y, g.vz += push.z;
	g.wx += turn.x, g.wy += turn.y, g.wz += turn.z;
}

void Dynamics::kickEarly(double time)
{
	for (auto& domain : domains)
		for (const EarlyKick& early : domain->ledger.earlyKicks())
			contact_law::kickEarly(shared, early, shared.grains[early.grain], time);
}

/* The part of this moment's kicks that belongs before it was meant for the step that has been, the rest for the one to come (MODEL.md, "Steps of changing
 * length"): velocities, which are those of half a step ago, move on to half a new step ago. Lists count in steps, and are checked anew. */
void Dynamics::setStep(double dt)
{
	const double before = shared.dt;
	if (dt == before) return;
	kickEarly(before - dt);
	kickAll(0.5 * before);
	kickAll(-0.5 * dt);
	shared.dt = dt;
	shared.setLeastKick();
	for (auto& domain : domains)
		domain->ledger.changeStep(shared.grains, dt);
	velocitiesSet = true;
	outdateLists();
}

} // namespace contact_law
