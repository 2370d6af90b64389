// Many grains through many steps: leapfrog over the domains, neighbour lists, threads. Knows nothing of YADE.
#pragma once
#include "barrier.hpp"
#include "domain.hpp"
#include <algorithm>
#include <memory>
#include <string>

namespace contact_law {

struct GrainInput {
	double position[3], velocity[3], angularVelocity[3]; // all at the start's moment
	double radius, mass, inertia;
	int kind;                                 // index of its material
	unsigned blocked = 0;                     // degrees of freedom (kernel/blocked.hpp)
	Orientation orientation = { 1, 0, 0, 0 }; // kept up only with Options::orientations
};

// A contact as it is now, its grains as they were given.
struct ContactNow {
	int first, second;
	PairConstants<double> constants;
	ContactHistory<double> history; // laboratory frame
	ContactGeometry<double> geometry;
	ContactForces<double> forces;
	Vec3<double> velocity; // of the first past the second through the last small step
	Vec3<double> shift;    // cells by which the first is shifted to be nearest to the second (periodic)
	bool bonded = false;
	BondConstants<double> bond {}; // when it is; the geometry's overlap is then rest - distance
	double rest = 0;
};
ContactNow swapped(const ContactNow&); // the same with its grains in the other order

// Contacts that grains have when a run starts, in place of unstrained springs where they overlap.
struct Inherited {
	struct One {
		int first, second;              // grains as given
		ContactHistory<double> history; // laboratory frame
		double overlap, drag;           // at the moment of the history
		bool bonded = false;
		double rest = 0; // of a bond
	};
	std::vector<One> contacts;
	/* As a leapfrog leaves them: histories of the moment a small step before the positions, velocities of half a step before (of turned grains likewise), and in
	 * scenes with drag `previous`, the velocities another step before. Otherwise all is of one moment. */
	bool stepBehind = false;
	std::vector<Vec3<double>> previous;
};

class Dynamics {
public:
	struct Options {
		double dt = 0, linearDamping = 0;
		double neck = 0; // of sintered bonds over the grains' radius; 0: none
		unsigned mechanisms = AllSprings;
		int domains = 2, threads = 1;
		std::string instructions;            // "avx512", "avx2", "portable"; empty: the best this machine has
		bool orientations = false;           // whether to keep the grains' orientations up
		PeriodicCell cell {};                // at the start's moment; off: open space
		Vec3<double> convective { 0, 0, 0 }; // see setMeanField
	};
	// Grains that overlap touch from the start, with unstrained springs (with a neck: bonded), or as `inherited` has it; or all is as `memory` (of remember(), from the same grains in the
	// same order) has it.
	Dynamics(const std::vector<GrainInput>& grains, const std::vector<Material>& materials, const Options& options,
	        const std::vector<double>* memory = nullptr, const Inherited* inherited = nullptr);

	/* Steps from here on are unstable for every pair of like grains in the scene, in whatever packing [s]: half a time unit, at which collisions blow up
	 * (measured; MODEL.md), m* over the drag coefficient, where drag overshoots with its velocity extrapolated, or 2 over the fastest vibration of a bonded pair. */
	double unstableStep() const;

	// Returns the steps made: fewer than asked for when a grain moves further in a step than any contact could follow (trouble() then tells).
	// In a periodic cell its size goes evenly from what it was to sizeAtEnd [m].
	long run(long steps, const Vec3<double>* sizeAtEnd = nullptr);

	/* A periodic cell's mean velocity field x gradient: what is added to it now is added to every grain (by its unwrapped position), and from now on
	 * `convective` (diagonal, 1/s) times their velocity accelerates grains. */
	void setMeanField(const Vec3<double>& added, const Vec3<double>& convective);
	Vec3<double> convective() const { return setting.convective; }
	const PeriodicCell& cell() const { return domains[0]->cell; }
	// What a periodic cell must hold twice along each axis: the largest distance of neighbours in the lists.
	double reach() const { return 2 * *std::max_element(setting.radius.begin(), setting.radius.end()) + setting.farGap; }
	double smallestRadius() const { return setting.smallestRadius; }

	void setThreads(int threads) { options.threads = threads; }
	int threadCount() const { return std::max(1, std::min(options.threads, int(domains.size()))); }

	std::vector<double> remember() const;

	// A grain that something else has moved, pushed, or blocked.
	void set(int grain, const GrainInput& now);

	// The state now; grains in the order they were given.
	void read(std::vector<GrainInput>& grains) const;
	// As YADE's loop leaves grains after a step: moved on by a small step, velocities of half a step before that, contacts as they are now.
	// Orientations are turned from those of this run, or, where it keeps none, from those given.
	void readAhead(std::vector<GrainInput>& grains) const;
	Energies energies();
	Dissipation dissipated() const; // since the start
	bool constrained() const;       // whether any grain has a blocked degree of freedom
	int contactCount() const;
	template <class Visit>
	void eachPlace(Visit&& visit) const // of every contact once: visit(list, lane, its first and its second grain as given)
	{
		for (const auto& domain : domains)
			for (int sort = 0; sort < 2; ++sort) {
				const ContactList& list = domain->contacts[sort];
				for (int lane = 0; lane < list.size(); ++lane)
					if (list.alive(lane)) visit(list, lane, original[list.first(lane)], original[list.second(lane)]);
			}
	}
	template <class Visit> void eachBondPlace(Visit&& visit) const // likewise, of bonds: visit(list, lane, ...)
	{
		for (const auto& domain : domains)
			for (int sort = 0; sort < 2; ++sort) {
				const BondList& list = domain->bonds[sort];
				for (int lane = 0; lane < list.size(); ++lane)
					if (list.alive(lane)) visit(list, lane, original[list.first(lane)], original[list.second(lane)]);
			}
	}
	template <class Visit> void eachBond(Visit&& visit) const // visit(Bond, its first and second grain as given, normal force now)
	{
		eachBondPlace([&](const BondList& list, int lane, int first, int second) {
			const Bond b = list.get(lane, setting.commonBond);
			visit(b, first, second, now(b).forces.normalForce);
		});
	}
	const BondConstants<double>& commonBond() const { return setting.commonBond; } // for BondList::get
	std::array<long, bondModes> brokenBonds() const;                               // so far, by mode
	int bondCount() const;
	const PairConstants<double>& commonConstants() const { return setting.common; } // of the first grain with its like
	Contact contactOf(const ContactList& list, int lane) const { return setting.contactOf(list, lane); }
	template <class Visit>
	void eachContact(Visit&& visit) const // visit(Contact, its first and second grain as given, normal force now)
	{
		eachPlace([&](const ContactList& list, int lane, int first, int second) {
			const Contact c = setting.contactOf(list, lane);
			visit(c, first, second, normalForce(c));
		});
	}
	double normalForce(const Contact&) const; // elastic and viscous, positive when repulsive
	ContactNow now(const Contact&) const;
	ContactNow now(const Bond&) const;

	// What went wrong: the grain that moves fastest (or the given one) and its contact that pushes or pulls hardest; both as given, -1: none.
	struct Trouble {
		int grain = -1, other = -1;
		double speed = 0, overlap = 0, force = 0; // overlap over the smaller radius; force along the normal [N]
	};
	Trouble trouble(int grain = -1) const;
	Trouble hardest() const; // the contact that pushes or pulls hardest of all
	// The contact that overlaps most, by more than the smaller of its radii (no law holds there); speed and force are not looked up. Grain -1: none does.
	Trouble tooDeep() const;
	const char* instructions() const { return setting.passes->name; }
	long contactUpdates = 0, farRebuilds = 0, nearRebuilds = 0, events() const;

private:
	void orderGrains(const std::vector<GrainInput>&);
	void recallOrder(const std::vector<double>& memory);
	void loadGrains(const std::vector<GrainInput>&);
	void inherit(const Inherited&);
	static void write(const GrainInput&, Grain&);
	static void write(const Grain&, GrainInput&);
	void kick(Grain&, int index, double time) const;
	Trouble tooDeep(const Domain&) const;
	void makeDomains();
	void recall(const std::vector<double>& memory);
	void firstForces();
	void addForces(); // of all domains, without moving
	// mine(what) calls what(domain, its number) for a thread's domains, wait() lets the threads come together
	template <class Mine, class Wait> void buildGrid(bool firstThread, Mine&&, Wait&&);
	void setMostCells();
	void refreshLists(bool farToo);
	long runShare(long steps, const Vec3<double>& growth, const Vec3<double>& sizeAtEnd, int thread, int threads, Barrier&);
	Domain& domainOf(int index);
	double fastestAllowed() const;    // velocity component
	VelocityRange velocities() const; // of all grains through the latest drift
	double nearGapFor(double approach) const;

	Options options;
	Setting setting;
	int count = 0;
	std::vector<int> original, indexHere; // index given, by index here; and the other way round
	std::vector<std::unique_ptr<Domain>> domains;
	Grid grid;
	double travelSinceFar = 0, travelSinceNear = 0; // bounds on how far any two grains have come closer
	double nearGap = 0;                             // up to which untouching pairs are in the near lists
	Vec3<double> mostCells { 0, 0, 0 };             // that a shift to the nearest image can be, periodic
};

const InstructionSet& instructionSet(
        const std::string& name); // throws std::invalid_argument for one that is unknown or that this machine lacks

} // namespace contact_law
