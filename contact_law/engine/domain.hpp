/* A part of the grains (a stretch of their order) through a step: the forces of all contacts that touch them, then the kick and the
 * drift. Contacts across a border are computed in both domains, each adding to its own grains only, so that results do not depend on
 * how many threads the domains are assigned to. */
#pragma once
#include "../kernel/blocked.hpp"
#include "plane_contacts.hpp"
#include "touching_pairs.hpp"

namespace contact_law {

// ---- outside forces: what something else than contacts puts on grains (in YADE: O.forces), constant until others are set ----

struct OutsideForce {
	int grain;
	Vec3<double> force, torque; // N, N m

	friend bool operator==(const OutsideForce& a, const OutsideForce& b)
	{
		return a.grain == b.grain && a.force == b.force && a.torque == b.torque;
	}
};

// On one domain's grains. Added as soon as a grain's contacts are complete, before blocked components are withheld.
class OutsideForces {
public:
	std::vector<OutsideForce> grains; // by rising index
	double work = 0;                  // minus what these forces did on the grains [J]

	void begin() { next = 0; } // a step's forces, of which grains will have all

	/* To grains below `end`, unless it has been done. A force that is the same before and after a step does its product with the
	 * way: by just that the leapfrog's kinetic energy grows (MODEL.md, "Outside forces"). */
	void add(Grain* all, double dt, int end)
	{
		double sum = work; // grain by grain, so that it doesn't depend on where `end` stood
		auto at = grains.begin() + next;
		for (; at != grains.end() && at->grain < end; ++at) {
			Grain& g = all[at->grain];
			sum -= dt * (dot(at->force, velocityOf(g)) + dot(at->torque, spinOf(g)));
			addToGrain(g, at->force, at->torque);
		}
		work = sum;
		next = at - grains.begin();
	}

private:
	std::size_t next = 0;
};

// ---- blocked degrees of freedom: there grains keep the velocity that they have, whatever pushes them, as with NewtonIntegrator ----

struct Constrained {
	int grain;
	unsigned blocked;                                   // bits, blocked.hpp
	Vec3<double> force { 0, 0, 0 }, torque { 0, 0, 0 }; // withheld now
};

static_assert(offsetof(Constrained, torque) == offsetof(Constrained, force) + sizeof(Vec3<double>), "read as six numbers in a row");

// Of one domain's grains. Forces are withheld as soon as they are complete, so that all that comes after (kicks, kinetic energy) knows
// nothing of it.
class Constraints {
public:
	std::vector<Constrained> grains; // by rising index
	double work = 0;                 // that contacts did against whatever holds the grains or moves them at their given velocity [J]

	void begin() { next = 0; } // a step's forces, of which grains will have all

	/* Of grains below `end`, whose forces of this step are complete, unless it has been done. The work over the step is half of
	 * both its forces, those before and those now, times the way: by just that the leapfrog's ledger of the contacts is off when a
	 * grain does not answer, events within the step included (MODEL.md, "Blocked degrees of freedom"). */
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

	// Another outside force on a grain from now on, by which what it is given changes: the blocked part is withheld, the rest is
	// returned.
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

	// The power of what is withheld of a grain, now and before. In the plane all grains come here in every step: without branches,
	// and with two sums side by side (a tenth of the time of such scenes).
	static double withheldFrom(Grain& g, Constrained& c)
	{
		const double* __restrict blocked = blockedRows[c.blocked].data(), * __restrict velocities = &g.vx;
		double* __restrict forces = &g.fx, * __restrict before = &c.force.x;
		double power[2] = { 0, 0 };
		for (int k = 0; k < 6; ++k) {
			const double held = blocked[k] * forces[k];
			power[k % 2] += (before[k] + held) * velocities[k];
			before[k] = held;
			forces[k] -= held;
		}
		return power[0] + power[1];
	}
};

// ---- the domain ----

class Domain {
public:
	Domain(SharedState& shared, int begin, int end, int dummy);

	/* A step's forces come in two parts. First what reads grains of other domains, contacts that came since the last sorting, and
	 * contacts that form now; then, when all domains have reached this point, the sorted rest, behind which grains can be moved as
	 * soon as their last contact is done: they are in the cache then. */
	void addFirstForces();
	void addOtherForces(bool moveBehind);
	void integrate(); // own grains, all of them

	// ---- grains in another order, or other forces on them ----

	struct Contents { // what a domain held before grains changed their order
		TouchingPairs::Contents touching;
		std::vector<Constrained> constrained;
		std::vector<OutsideForce> outside;
		std::vector<PlaneContact> onPlanes;
	};
	Contents takeOut();
	void place(const Contents&, const std::vector<int>& to); // what is now this domain's; to: new indices of grains
	void place(const std::vector<OutsideForce>&);            // on own grains

	// ---- what it knows ----

	StoredEnergy<double> energies();
	// 1/2 m v(-dt/2) v(+dt/2) of own grains, and what events of the latest step add; in it no convective acceleration.
	double kineticEnergy() const;
	double convectiveWork() const;           // half of what the convective acceleration does in the kick now
	double kineticEnergyOf(int grain) const; // as kineticEnergy(), of one, without what events add
	const VelocityRange& latestVelocities() const { return velocities; }    // of own grains through the latest drift
	bool mustCheck() const { return boundExceeded || !lists.holdToNext(); } // whether the neighbour lists hold no further step

	const int begin, end;
	PeriodicCell cell;      // as it is at this domain's latest forces
	PairLists lists;        // neighbours that do not touch
	TouchingPairs touching; // those that do
	Ledger ledger;
	Constraints constraints;
	OutsideForces outside;
	PlaneContacts planes;

private:
	struct Caller { // of a pass
		Domain* domain;
		Ownership ownership;
	};
	template <class Block> static void eventsOf(void* caller, int block, unsigned which, const Block& before, LaneForces& out);
	static void moveBehind(void* caller, int batch);

	template <class Pass, class List> Pass passOver(List&, Ownership);
	ForcePass passFor(Ownership);
	BondPass bondPassFor(Ownership);
	void addForces(Ownership, int firstBlock, int endBlock, bool moveBehind);
	void addBondForces();
	void completeForces(int grain); // of grains below that, which have those of all contacts
	void completeAndIntegrateUpTo(int grain);
	void beginMoving();
	void integrateUpTo(int grain);
	void convect(int first, int last);
	void finishGroup(Group&);

	SharedState& s;
	int dummy;
	ContactEvents events;
	Caller callers[3];
	VelocityRange velocities;
	bool boundExceeded = false; // whether in the latest drift a group's grains left their bounds
	int moved = 0;              // grains from begin on that this step has moved already
	VelocityRange movedLatest;  // of the group that is being moved
};

} // namespace contact_law
