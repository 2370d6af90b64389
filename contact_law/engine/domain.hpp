/* A part of the grains (a stretch of their order) through a step: the forces of all contacts that touch them, then the kick and the drift. Contacts across a border are
 * computed in both domains, each adding to its own grains only, so that results do not depend on how many threads the domains are assigned to. */
#pragma once
#include "constraints.hpp"
#include "contact_events.hpp"
#include "ledger.hpp"
#include "outside_forces.hpp"
#include "pair_lists.hpp"
#include "plane_contacts.hpp"
#include "touching_pairs.hpp"

namespace contact_law {

class Domain {
public:
	Domain(SharedState& shared, int begin, int end, int dummy);

	/* A step's forces come in two parts. First what reads grains of other domains, contacts that came since the last sorting, and contacts that form now; then, when all
	 * domains have reached this point, the sorted rest, behind which grains can be moved as soon as their last contact is done: they are in the cache then. */
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
