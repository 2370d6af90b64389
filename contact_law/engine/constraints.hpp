// Grains with blocked degrees of freedom: there they keep the velocity that they have, whatever pushes them, as with YADE's NewtonIntegrator.
#pragma once
#include "../kernel/blocked.hpp"
#include "arrays.hpp"
#include <algorithm>
#include <cstring>

namespace contact_law {

struct Constrained {
	int grain;
	unsigned blocked;                                   // bits, blocked.hpp
	Vec3<double> force { 0, 0, 0 }, torque { 0, 0, 0 }; // withheld now
};

static_assert(offsetof(Constrained, torque) == offsetof(Constrained, force) + sizeof(Vec3<double>), "read as six numbers in a row");

// Of one domain's grains. Forces are withheld as soon as they are complete, so that all that comes after (kicks, kinetic energy) knows nothing of it.
class Constraints {
public:
	std::vector<Constrained> grains; // by rising index
	double work = 0;                 // that contacts did against whatever holds the grains or moves them at their given velocity [J]

	void begin() { next = 0; } // a step's forces, of which grains will have all

	/* Of grains below `end`, whose forces of this step are complete, unless it has been done. The work over the step is half of both its forces, those
	 * before and those now, times the way: by just that the leapfrog's ledger of the contacts is off when a grain does not answer, events within the
	 * step included (MODEL.md, "Blocked degrees of freedom"). */
	void withhold(Grain* all, double dt, int end)
	{
		double sum = work; // grain by grain, so that it doesn't depend on where `end` stood
		auto at = grains.begin() + next;
		for (; at != grains.end() && at->grain < end; ++at)
			sum += 0.5 * dt * withheldFrom(all[at->grain], *at);
		work = sum;
		next = at - grains.begin();
	}

	// Other degrees of freedom of a grain from now on; 0: free.
	void block(Grain* all, int grain, unsigned blocked)
	{
		auto at = std::lower_bound(grains.begin(), grains.end(), grain, [](const Constrained& c, int g) { return c.grain < g; });
		if (at != grains.end() && at->grain == grain) {
			addToGrain(all[grain], at->force, at->torque);
			at = grains.erase(at);
		}
		if (!blocked) return;
		Grain& g = all[grain];
		Constrained c { grain, blocked };
		c.force = blockedForce({ g.fx, g.fy, g.fz }, blocked);
		c.torque = blockedTorque({ g.tx, g.ty, g.tz }, blocked);
		addToGrain(g, -c.force, -c.torque);
		grains.insert(at, c);
	}

	// Another outside force on a grain from now on, by which what it is given changes: the blocked part is withheld, the rest is returned.
	void push(int grain, Vec3<double>& force, Vec3<double>& torque)
	{
		auto at = std::lower_bound(grains.begin(), grains.end(), grain, [](const Constrained& c, int g) { return c.grain < g; });
		if (at == grains.end() || at->grain != grain) return;
		const Vec3<double> heldForce = blockedForce(force, at->blocked), heldTorque = blockedTorque(torque, at->blocked);
		at->force = at->force + heldForce, at->torque = at->torque + heldTorque;
		force = force - heldForce, torque = torque - heldTorque;
	}

private:
	std::size_t next = 0;

	// The compiler's own pair of numbers, from and to places of any alignment.
	using Two = double __attribute__((vector_size(16)));
	static Two two(const double* first)
	{
		Two pair;
		std::memcpy(&pair, first, sizeof pair);
		return pair;
	}
	static void put(double* first, Two pair) { std::memcpy(first, &pair, sizeof pair); }

	// The power of what is withheld of a grain, now and before. In the plane all grains come here in every step: by pairs of numbers, without branches.
	static double withheldFrom(Grain& g, Constrained& c)
	{
		const double* blocked = blockedRows[c.blocked].data();
		double *forces = &g.fx, *before = &c.force.x;
		const double* velocities = &g.vx;
		Two power = { 0, 0 };
		for (int k = 0; k < 6; k += 2) {
			const Two force = two(forces + k), held = two(blocked + k) * force;
			power += (two(before + k) + held) * two(velocities + k);
			put(before + k, held);
			put(forces + k, force - held);
		}
		return power[0] + power[1];
	}
};

} // namespace contact_law
