/* Many grains through many steps: leapfrog over the domains, neighbour lists, threads. Knows nothing of YADE.
 * What is only read from a run stands beside it, in the free functions of contacts.hpp. */
#pragma once
#include "domain.hpp"
#include "threads.hpp"
#include <algorithm>
#include <memory>
#include <string>

namespace contact_law {

// What a step or a script changes of a grain; everything of one moment. Positions in m, velocities in m/s, angular velocities in rad/s.
struct GrainMotion {
	Vec3<double> position, velocity, angularVelocity;
	unsigned blocked = 0;                     // degrees of freedom (kernel/blocked.hpp)
	Orientation orientation = { 1, 0, 0, 0 }; // followed only with Options::orientations
};
struct GrainInput : GrainMotion {
	double radius, mass, inertia; // m, kg, kg m2
	int kind;                     // index of its material
	int id = 0;                   // as its owner calls it
};

// Contacts that grains have when a run starts, in place of unstrained springs where they overlap; all of the moment of the grains'
// positions.
struct Inherited {
	struct Energy { // that their owner counts for one [J]: now, and where a script has torn it apart since
		double held = 0, letGo = 0;
	};
	struct Pair {
		int first, second;              // grains as given
		ContactHistory<double> history; // laboratory frame
		double drag = 0, overlap = 0;
		double neck = 0; // of a bond, over the grains' radius; 0: an ordinary contact
		double rest = 0; // distance of the centres at which the bond was made [m]; 0: it is made now, without strain
		Energy energy {};
	};
	struct OnPlane {
		PlaneContact contact; // its grain as given; constants are left out
		Energy energy {};
	};
	std::vector<Pair> contacts;
	std::vector<OnPlane> onPlanes;
};

struct Booked; // contacts.hpp

void copyMotion(const GrainMotion&, Grain&); // all but orientation and blocked degrees of freedom, which grains don't carry
void copyMotion(const Grain&, GrainMotion&);
// A grain's velocities through the given time [s] with the forces as they are; back in time, it undoes what it does.
void kick(const SharedState&, Grain&, int index, double time);
// Likewise by what its kick has before this moment beyond the half, because of events.
void kickEarly(const SharedState&, const EarlyKick&, Grain&, double time);

// How long ago the neighbour lists were checked.
struct ListAge {
	double sinceBoxes = 0; // bound on how far any two grains have come closer since the groups' boxes were measured [m]
	int sinceCheck = 0;    // steps
	double moved = 0;      // by how much boundaries have moved images in these [m]
	int checkAfter = 1;    // steps, or fewer when kicks exceed their bounds
	bool outdated = false; // grains have been moved otherwise than by steps since
};

class Dynamics {
public:
	struct Options {
		double dt = 0;
		PairOptions pairs;
		double neck = 0; // of sintered bonds over the grains' radius; 0: none
		unsigned mechanisms = AllSprings;
		LimitRule limit = LimitRule::Held;
		int domains = 0, threads = 1;        // domains = 0: by the number of grains
		std::string instructions;            // "avx512", "avx2", "portable"; empty: the best this machine has
		bool orientations = false;           // whether to follow the grains' orientations
		std::vector<PlaneInput> planes;      // in a periodic cell: one at rest
		PeriodicCell cell {};                // at the start's moment; off: open space
		Vec3<double> convective { 0, 0, 0 }; // see setMeanField
	};
	struct Counters {
		long contactUpdates = 0;
		double searches = 0;     // for neighbours, of all grains or as many grains a part at a time
		long distanceChecks = 0; // of pairs that do not touch
		long orders = 0;         // times that grains were put into a new order
	};
	using Grains = std::vector<GrainInput>;
	using Materials = std::vector<Material>;

	// ---- three ways to start. All throw std::invalid_argument, with one line, for what they cannot start from ----

	// Grains that overlap touch from the start, with unstrained springs (with a neck: bonded).
	Dynamics(const Grains&, const Materials&, const Options&);
	// The one way to take a changed scene: its grains anew, with the contacts that another owner, or the run before, has exported.
	// What the change brings to the contacts, or takes from them, is booked as disconnection.
	Dynamics(const Grains&, const Materials&, const Options&, const Inherited&);
	// As save() left it, to the bit; grains, materials and options must be those of the saved run. Motions are the saved ones,
	// whatever the grains' are.
	Dynamics(const Grains&, const Materials&, const Options&, const std::vector<double>& saved);
	Dynamics(const Dynamics&) = delete; // its domains refer to it

	// ---- what changes a run ----

	/* Returns the steps made: fewer than asked for when a grain moves further in a step than any contact could follow
	 * (fastestGrain() says which), or two overlap too far (isTooDeep()). In a periodic cell its size changes evenly from what it was to sizeAtEnd [m]. */
	long run(long steps, const Vec3<double>* sizeAtEnd = nullptr);
	// A grain that something else has moved, pushed, or blocked. Contacts that it is moved away from break as the functors' do.
	void set(int grain, const GrainMotion& now);
	void setPlane(int plane, const Vec3<double>& position, const Vec3<double>& velocity);
	/* All outside forces from now on, by rising grain (those not given have none). Positions and velocities of this moment stay.
	 * Onset::Now: the force acts from here on. Onset::Before: it has acted until now too, on the grains of another run, whose
	 * ledger has its work. */
	enum class Onset { Now, Before };
	void setOutsideForces(const std::vector<OutsideForce>& given, Onset);
	/* A periodic cell's mean velocity field x gradient: what is added to it now is added to every grain (by its unwrapped
	 * position), and from now on `convective` (diagonal, 1/s) times their velocity accelerates grains. */
	void setMeanField(const Vec3<double>& added, const Vec3<double>& convective);
	/* Steps of another length from now on [s]. Positions and velocities of this moment stay; the kinetic energy as a leapfrog
	 * counts it changes in second order of the steps (changes.cpp). */
	void setStep(double dt);
	void setThreads(int threads) { options.threads = threads; }
	void continueFrom(const Booked&);
	void bookDisconnection(double energy) { domains[0]->ledger.lost.disconnection += energy; } // [J]
	void bookConstraintWork(double energy) { domains[0]->constraints.work += energy; }

	// ---- its state ----

	void read(std::vector<GrainMotion>&) const; // now; grains in the order they were given
	Energies energies();
	double totalEnergy();       // of all channels: constant but for what scripts give [J]
	std::vector<double> save(); // the whole state (checkpoint.cpp)

	// ---- for the free functions beside this class ----

	const SharedState& state() const { return shared; }
	const std::vector<std::unique_ptr<Domain>>& parts() const { return domains; }
	int given(int here) const { return original[here]; } // a grain's index as given, by its index in state()
	int id(int given) const { return ids[given]; }       // of a grain, as its owner calls it
	int grainCount() const { return count; }
	int threadCount() const { return std::max(1, std::min(options.threads, domainCount())); }
	const PeriodicCell& cell() const { return domains[0]->cell; }
	// Whether some have overlapped by more than the smaller radius, where no law holds.
	bool isTooDeep() const
	{
		return std::any_of(domains.begin(), domains.end(), [](const auto& domain) { return domain->ledger.tooDeep; });
	}
	// What a periodic cell must hold twice along each axis: the largest distance of neighbours in the lists.
	double reach() const { return 2 * shared.largestRadius + shared.skin; }
	Counters counters() const;

private:
	void prepare(const Grains&, const Materials&, const Options&);
	void orderGrains(const std::vector<Vec3<double>>& positions); // as given
	double groupSizes();                                          // sum of their edges [m]
	void reorder();
	void loadGrains(const Grains&);
	int domainCount() const;
	int beginOf(int domain) const { return int(long(count) * domain / domainCount()); }
	void shrinkGrains();
	void kickAll(double time);   // kick() of every grain [s]
	void kickEarly(double time); // kickEarly() of every grain that has one [s]
	void makeDomains();
	void inherit(const Inherited&);
	bool place(const Inherited::Pair&);
	template <class Archive> void transferLayout(Archive&);
	template <class Archive> void transferState(Archive&);
	void firstForces();
	void addForces(); // of all domains, without moving
	void takeVelocities();
	void setMostCells();
	void makeLists();
	void outdateLists(); // grains have been moved otherwise than by a step
	ListWork listWork(ListAge&, const VelocityRange&, const Vec3<double>& growth) const; // of this step; advances the age
	void keepLists(int domain, const ListWork&);
	long runEvenly(long steps, const Vec3<double>& sizeAtEnd);
	long runThread(long steps, const Vec3<double>& growth, const Vec3<double>& sizeAtEnd, Shares, Barrier&);
	Domain& domainOf(int index);
	void changeForce(Domain&, int index, Vec3<double> force, Vec3<double> torque, Onset); // by that much
	double fastestThatHolds() const;                                                      // velocity component that a step may have
	VelocityRange velocities() const;                                                     // of all grains through the latest drift

	Options options;
	SharedState shared;
	long contactUpdates = 0;
	Counters countedBefore; // by the run that this one continues
	int count = 0;
	std::vector<int> ids;                 // as given
	std::vector<int> original, indexHere; // index given, by index here; and the other way round
	std::vector<std::unique_ptr<Domain>> domains;
	double sizesWhenOrdered = 0; // groupSizes() when grains were put into their order
	long stepsSinceTrial = 0;    // whether they need a new one
	long orders = 0;
	ListAge listAge;
	bool velocitiesSet = false;         // otherwise than by a step since the latest one
	Vec3<double> mostCells { 0, 0, 0 }; // that a shift to the nearest image can be, periodic
};

// Numbers of a checkpoint with a sum of their bits at the end; std::invalid_argument where it is another, before any of them is an index.
std::vector<double> sealed(std::vector<double> numbers);
void requireSealed(const std::vector<double>&);

// Throws std::invalid_argument for one that is unknown or that this machine lacks.
const InstructionSet& instructionSet(const std::string& name);

} // namespace contact_law
