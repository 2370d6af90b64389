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
	int    kind; // index of its material
};

struct Energies {
	double      kinetic = 0; // 1/2 m v(-dt/2) v(+dt/2): what a leapfrog conserves together with the stored energies (MODEL.md)
	StoredEnergy<double> stored { 0, 0, 0, 0 };
	Dissipation dissipated;
};

class Dynamics {
public:
	struct Options {
		double   dt = 0, linearDamping = 0;
		unsigned mechanisms = AllSprings;
		int      domains = 2, threads = 1;
		std::string instructions; // "avx512", "avx2", "portable"; empty: the best this machine has
	};
	// Grains that overlap touch from the start, with unstrained springs; or all is as `memory` (of remember(), from the same grains in the same order) has it.
	Dynamics(const std::vector<GrainInput>& grains, const std::vector<Material>& materials, const Options& options, const std::vector<double>* memory = nullptr);

	/* Steps from here on are unstable for every pair of like grains in the scene, in whatever packing [s]: half a time unit, at which collisions blow up
	 * (measured; MODEL.md), or m* over the drag coefficient, where drag overshoots with its velocity extrapolated. */
	double unstableStep() const;

	void run(long steps);
	void setThreads(int threads) { options.threads = threads; }
	int  threadCount() const { return std::max(1, std::min(options.threads, int(domains.size()))); }

	std::vector<double> remember() const;

	// A grain that something else has moved or pushed.
	void set(int grain, const GrainInput& now);

	// The state now; grains in the order they were given.
	void     read(std::vector<GrainInput>& grains) const;
	Energies energies();
	int      contactCount() const;
	template <class Visit> void eachContact(Visit&& visit) const // visit(Contact, index of grain 1, of grain 2, normal force now)
	{
		for (const auto& domain : domains)
			for (int sort = 0; sort < 2; ++sort)
				for (int lane = 0; lane < domain->contacts[sort].size(); ++lane)
					if (domain->contacts[sort].alive(lane)) {
						const Contact c = domain->contacts[sort].get(lane, setting.common);
						visit(c, original[c.i], original[c.j], normalForce(c));
					}
	}
	double      normalForce(const Contact&) const; // elastic and viscous, positive when repulsive
	const char* instructions() const { return setting.passes->name; }
	long        contactUpdates = 0, farRebuilds = 0, nearRebuilds = 0, events() const;

private:
	void        orderGrains(const std::vector<GrainInput>&);
	void        recallOrder(const std::vector<double>& memory);
	void        loadGrains(const std::vector<GrainInput>&);
	static void write(const GrainInput&, Grain&);
	void        kick(Grain&, int index, double time) const;
	void makeDomains();
	void recall(const std::vector<double>& memory);
	void firstForces();
	void buildGrid();
	void refreshLists(bool farToo);
	void runShare(long steps, int thread, int threads, Barrier&);

	Options                              options;
	Setting                              setting;
	int                                  count = 0;
	std::vector<int>                     original, indexHere; // index given, by index here; and the other way round
	std::vector<std::unique_ptr<Domain>> domains;
	Grid                                 grid;
	double                               travelSinceFar = 0, travelSinceNear = 0; // bound on how far any grain went
};

const InstructionSet& instructionSet(const std::string& name); // throws std::invalid_argument for one that is unknown or that this machine lacks

} // namespace contact_law
