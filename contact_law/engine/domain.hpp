// A part of the grains (a stretch of their order) with all contacts that touch them. Contacts across a border are computed in both
// domains, each adding to its own grains only, so that results do not depend on how many threads the domains are dealt to.
#pragma once
#include "constraints.hpp"
#include "outside_forces.hpp"
#include "pair_lists.hpp"
#include "setting.hpp"

namespace contact_law {

struct StepSums { // since the start, and (eventWork) of the latest step's events only
	Dissipation dissipated;
	double eventWork = 0;  // what events add to the kinetic energy now beyond half the kicks' work
	BoundaryWork boundary; // of a periodic cell
	double meanField =
	        0; // taken out of the kinetic energy by changes of the cell's velocity gradient and by the convective acceleration [J]
};

// Of a grain's kick by events of the latest step: what belongs before this instant beyond the half.
struct EarlyKick {
	int grain;
	Vec3<double> force, torque;
};

/* The moment a step ago of a pair whose springs rest at a distance `rest`: the first grain stood at `then` from the second, and the pointers of `h` had not
 * turned yet. Constants: of a contact or of a bond. */
template <class Constants>
ContactBefore aStepAgo(const Constants& c, double rest, const Vec3<double>& then, const ContactHistory<double>& h)
{
	const double apart = std::sqrt(dot(then, then));
	ContactBefore before;
	before.touching = true;
	before.overlap = rest - apart;
	before.sliding = sliding::displacement(h.pointers, c.radius1, c.radius2, (1 / apart) * then);
	before.rolling = rolling::displacement(h.pointers, c.reducedRadius);
	before.twist = h.twist;
	return before;
}

enum Sort { Both, First, Second }; // of a domain's contacts: whose grains are the domain's own

class Domain {
public:
	Domain(Setting& setting, int begin, int end, int dummy);

	/* A step's forces come in two parts. First what reads grains of other domains, contacts that came since the last sorting, and contacts that form now; then, when all
	 * domains have got so far, the sorted rest, behind which grains can be moved as soon as their last contact is done: they are in the cache then. */
	void addFirstForces();
	void addOtherForces(bool moveBehind);
	void integrate();        // own grains, all of them
	void sortContacts();     // into the order of pairs, without dead lanes
	void findCompleted();    // where in the sorted contacts grains have had their last one
	void placeOverlapping(); // contacts of all pairs that overlap already, with unstrained springs
	void placeBonds();       // between all grains that touched before they shrank
	using AllBonds = std::array<std::vector<Bond>, 3>;
	AllBonds sintered(double neck) const; // the bonds, and all contacts as bonds of this neck
	void setBonds(const AllBonds&);       // in place of all bonds and contacts; to be followed by findPairs()
	void place(const Bond&);
	void place(const Contact&); // one that this domain's grains have, i < j; to be followed by sortContacts() and markTouching()
	void place(const std::vector<Constrained>&);
	void place(const std::vector<OutsideForce>&);
	struct Contents { // what a domain held before grains changed their order
		std::vector<ContactList> contacts;
		std::vector<BondList> bonds;
		std::vector<Constrained> constrained;
		std::vector<OutsideForce> outside;
	};
	Contents takeOut();
	void place(const Contents&, const std::vector<int>& to); // what is now this domain's; to: new indices of grains; likewise
	void markTouching();                                     // in the neighbour lists, all that touch
	void takeVelocities();                                   // as they are now, for drag in the next step
	StoredEnergy<double> energies();
	double kineticEnergy()
	        const; // 1/2 m v(-dt/2) v(+dt/2) of own grains, and what events of the latest step add; in it no convective acceleration, but
	double convectiveWork() const;           // this is half of what it does in the kick now
	double kineticEnergyOf(int grain) const; // likewise of one, without what events add

	int begin, end;
	VelocityRange velocities;   // of own grains through the latest drift
	bool boundExceeded = false; // whether in it a group's grains left their bounds
	PairLists lists;            // neighbours that do not touch
	bool mustCheck() const { return boundExceeded || !lists.holdToNext(); }
	long events = 0;
	long formed = 0, broke = 0; // contacts (bonds not among them) so far; a border contact where its first grain lives
	StepSums sums;
	std::vector<EarlyKick> early;          // of own grains
	ContactList contacts[3];               // both grains own; the first; the second
	int sortedBlocks = 0;                  // of the contacts with both grains own
	long changed = 0, stepsSinceSort = 0;  // contacts that formed or broke since the latest sorting
	BondList bonds[3];                     // likewise
	std::array<long, bondModes> broken {}; // bonds so far, by mode; a border bond where its first grain lives
	Constraints constraints;
	OutsideForces outside;
	PeriodicCell cell;        // as it is at this domain's latest forces
	int contactCount() const; // alive ones, bonds among them, a border contact counted where its first grain lives

private:
	struct EventCall {
		Domain* domain;
		int sort;
	};

	ForcePass passFor(int sort);
	void addForces(int sort, int firstBlock, int endBlock, bool moveBehind);
	static void moveBehind(void* owner, int batch);
	void convect(int first, int last);
	void completeForces(int grain); // of grains below that, which have those of all contacts
	void completeAndIntegrateUpTo(int grain);
	void integrateUpTo(int grain);
	template <class List, class Get> void place(const List&, const std::vector<int>& to, List (&own)[3], const Get&);
	void beginMoving();
	void finishGroup(Group&);
	void sortIfWorthwhile();
	static void eventsOf(void* owner, int block, unsigned which, const ContactBlock& before, LaneForces& forces);
	void eventOf(int sort, int lane, const ContactBlock& before, LaneForces& forces);
	void placeDummies();
	BondPass bondPassFor(int sort);
	void addBondForces();
	static void breaksOf(void* owner, int block, unsigned which, const BondBlock& before, LaneForces& forces);
	void breakOf(int sort, int lane, const BondBlock& before, LaneForces& forces);
	void addBondEnergies(StoredEnergy<double>&);
	void formContacts();
	bool formContact(const NeighbourPair&);
	ContactMotion motionOf(int i, int j, Image&) const;
	Vec3<double> separationAStepAgo(int i, int j, const ContactMotion&) const;
	void book(const ContactStepResult&, const ContactMotion&, const Image&, int sort);
	void keepEarly(int i, int j, const ContactStepResult&);
	void addAlone(int sort, int i, int j, const ContactStepResult&, const Image&); // kicks of a contact that no pass scatters
	bool owns(int grain) const { return grain >= begin && grain < end; }
	Sort sortOf(int i, int j) const { return owns(i) && owns(j) ? Both : owns(i) ? First : Second; }

	Setting& s;
	int dummy;
	Dissipation ignoredDissipation; // of border contacts that the other domain books
	Vec3<double> ignoredCrossing { 0, 0, 0 };
	long ignoredEvents = 0;
	EventCall eventCalls[3];
	int moved = 0;              // grains from begin on that this step has moved already
	VelocityRange movedLatest;  // of the group that is being moved
	std::vector<int> completed; // by batch of the sorted contacts with both grains own: the first grain that has contacts after it
};

} // namespace contact_law
