// Checks after each O.step whether the run is sound, while the bodies still hold the last good state.
#pragma once
#include "../engine/contacts.hpp"
#include <string>
#include <vector>

namespace yade {

class StepWatch {
public:
	// Empty, or what is wrong, after `made` of `wanted` small steps to the given motions. energies: those now, or null when nobody
	// wants them.
	std::string wrong(const contact_law::Dynamics&, const std::vector<contact_law::GrainMotion>&, long made, long wanted,
	        const contact_law::Energies* energies);
	// A script has changed something: overlaps are checked after this step, and losses and the energies' sum are others.
	void forget() { sumKnown = false, lostBefore = -1e300, stepsSinceCheck = stepsBetweenChecks; }

	// For the start: two grains of which each reaches beyond the other's centre, or empty.
	static std::string tooDeep(const contact_law::Dynamics&);

private:
	static constexpr long stepsBetweenChecks = 30; // of the overlaps, which take about half a small step

	std::string wrongMotion(const contact_law::Dynamics&, const std::vector<contact_law::GrainMotion>&, long made, long wanted) const;
	std::string wrongEnergies(const contact_law::Energies&, double contactEnergy);

	long stepsSinceCheck = 0;
	bool sumKnown = false;
	double firstSum = 0, lostBefore = 0; // of the energies [J]
};

} // namespace yade
