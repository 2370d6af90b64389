// A part of the grains (a stretch of the space-filling curve) with all contacts that touch them. Contacts across a border are computed in both
// domains, each adding to its own grains only, so that results do not depend on how many threads the domains are dealt to.
#pragma once
#include "../kernel/contact_step.hpp"
#include "bond_list.hpp"
#include "constraints.hpp"
#include "contact_list.hpp"
#include "grid.hpp"
#include "orientations.hpp"

namespace contact_law {

// What all domains share, and a step does not change.
struct Setting {
	Aligned<PreviousVelocity> previous;                      // in scenes with drag
	Aligned<Grain> grains;                                   // then, for each domain, two dummies that dead lanes point to
	std::vector<double> inverseMass, inverseInertia, radius; // radius: of the grain as contacts have it, shrunk where necks are
	std::vector<double> grainRadius;                         // before
	std::vector<Material> material;                          // kinds of material
	std::vector<int> kind;                                   // of each grain
	std::vector<Orientation> orientation;                    // likewise; none where the scene doesn't ask for them
	std::vector<unsigned> blocked;                           // likewise (kernel/blocked.hpp)
	double linearDamping = 0;
	double neck = 0; // radius of sintered bonds' necks over that of the grains, the largest, by which all grains have shrunk; 0: none
	std::vector<double> necks; // of the bonds in the scene, each once
	bool uniform = true;
	PairConstants<double> common {};     // of the first grain with itself; of every pair when all grains are equal
	BondConstants<double> commonBond {}; // likewise, when all bonds are of one neck
	unsigned mechanisms = AllSprings;
	LimitRule limit = LimitRule::Held;
	double dt = 0, farGap = 0, smallestRadius = 0;
	Vec3<double> convective { 0, 0, 0 }; // a periodic cell's grains are accelerated by this times their velocity [1/s]
	const InstructionSet* passes = nullptr;
	std::vector<Vec3<double>> displaced; // of each grain, by a script since the latest step [m]; empty when none was

	void displace(int grain, const Vec3<double>& by)
	{
		if (by.x == 0 && by.y == 0 && by.z == 0) return;
		displaced.resize(grains.size(), Vec3<double> { 0, 0, 0 });
		displaced[grain] = displaced[grain] + by;
	}
	bool hasDrag() const { return mechanisms & Drag; }
	bool convects() const { return convective.x != 0 || convective.y != 0 || convective.z != 0; }
	Contact contactOf(const ContactList& list, int lane) const
	{
		return list.get(lane, constantsOf(list.first(lane), list.second(lane)));
	}
	PairConstants<double> constantsOf(int i, int j) const
	{
		return uniform
		        ? common
		        : deriveShrunkPair(material[kind[i]], grainRadius[i], material[kind[j]], grainRadius[j], linearDamping, neck);
	}
	bool uniformBonds() const { return uniform && necks.size() <= 1; }
	BondConstants<double> bondOf(int i, int j, double beta) const
	{
		return uniformBonds() ? commonBond : deriveBond(material[kind[i]], grainRadius[i], material[kind[j]], grainRadius[j], beta);
	}
};

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

class Domain {
public:
	Domain(Setting& setting, int begin, int end, int dummy);

	/* A step's forces come in two parts. First what reads grains of other domains, contacts that came since the last sorting, and contacts that form now; then, when all
	 * domains have got so far, the sorted rest, behind which grains can be moved as soon as their last contact is done: they are in the cache then. */
	void addFirstForces();
	void addOtherForces(bool moveBehind);
	void integrate();                            // own grains, all of them
	void findPairs(const Grid&, double nearGap); // neighbours, far and near
	void findNearPairs(double nearGap);
	void sortContacts();     // into the order of pairs, without dead lanes
	void findCompleted();    // where in the sorted contacts grains have had their last one
	void placeOverlapping(); // contacts of all pairs that overlap already, with unstrained springs
	void placeBonds();       // between all grains that touched before they shrank
	using AllBonds = std::array<std::vector<Bond>, 3>;
	AllBonds sintered(double neck) const; // the bonds, and all contacts as bonds of this neck
	void setBonds(const AllBonds&);       // in place of all bonds and contacts; to be followed by findPairs()
	void place(const Bond&);
	void place(const Contact&); // one that this domain's grains have, i < j; to be followed by sortContacts() and findPairs()
	StoredEnergy<double> energies();
	double kineticEnergy()
	        const; // 1/2 m v(-dt/2) v(+dt/2) of own grains, and what events of the latest step add; in it no convective acceleration, but
	double convectiveWork() const; // this is half of what it does in the kick now

	int begin, end;
	VelocityRange velocities; // of own grains through the latest drift
	long events = 0;
	long formed = 0, broke = 0; // contacts (bonds not among them) so far; a border contact where its first grain lives
	StepSums sums;
	std::vector<EarlyKick> early;          // of own grains
	ContactList contacts[3];               // both grains own; the first; the second
	int sortedBlocks = 0;                  // of the contacts with both grains own
	BondList bonds[3];                     // likewise
	std::array<long, bondModes> broken {}; // bonds so far, by mode; a border bond where its first grain lives
	Constraints constraints;
	PeriodicCell cell;        // as it is at this domain's latest forces
	int contactCount() const; // alive ones, bonds among them, a border contact counted where its first grain lives

private:
	struct Pair {
		int i, j;
		bool operator<(const Pair& other) const { return i != other.i ? i < other.i : j < other.j; }
	};
	enum Sort { Both, First, Second };
	struct EventCall {
		Domain* domain;
		int sort;
	};

	ForcePass passFor(int sort);
	void addForces(int sort, int firstBlock, int endBlock, bool moveBehind);
	static void moveBehind(void* owner, int batch);
	void convect(int first, int last);
	void integrateUpTo(int grain);
	static void eventsOf(void* owner, int block, unsigned which, const ContactBlock& before, LaneForces& forces);
	void eventOf(int sort, int lane, const ContactBlock& before, LaneForces& forces);
	bool closerThan(int i, int j, double gap) const; // surfaces
	int pairIndex(int sort, int i, int j) const;     // among the far pairs, or -1
	void placeDummies();
	BondPass bondPassFor(int sort);
	void addBondForces();
	static void breaksOf(void* owner, int block, unsigned which, const BondBlock& before, LaneForces& forces);
	void breakOf(int sort, int lane, const BondBlock& before, LaneForces& forces);
	void addBondEnergies(StoredEnergy<double>&);
	void formContacts();
	void formContact(int sort, int farIndex);
	ContactMotion motionOf(int i, int j, Image&) const;
	Vec3<double> separationAStepAgo(int i, int j, const ContactMotion&) const;
	void book(const ContactStepResult&, const ContactMotion&, const Image&, int sort);
	void keepEarly(int i, int j, const ContactStepResult&);
	void addAlone(int sort, int i, int j, const ContactStepResult&, const Image&); // kicks of a contact that no pass scatters
	bool owns(int grain) const { return grain >= begin && grain < end; }

	Setting& s;
	int dummy;
	Dissipation ignoredDissipation; // of border contacts that the other domain books
	Vec3<double> ignoredCrossing { 0, 0, 0 };
	long ignoredEvents = 0;
	EventCall eventCalls[3];
	int moved = 0;              // grains from begin on that this step has moved already
	std::vector<int> completed; // by batch of the sorted contacts with both grains own: the first grain that has contacts after it
	std::vector<Pair> far[3];
	std::vector<char> touching[3]; // by far pair
	std::vector<int> near[3];      // indices of far pairs that are close and don't touch
};

} // namespace contact_law
