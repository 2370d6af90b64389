// Checks after each O.step whether the run is sound, while the bodies still hold the last good state.
#pragma once
#include "../engine/dynamics.hpp"
#include "LedgerWatch.hpp"
#include <string>
#include <vector>

namespace yade {

class StepWatch {
public:
	/* Empty, or what is wrong, after `made` of `asked` small steps to the given motions. `energies`: those now, or null when they were not asked for. */
	std::string wrong(const contact_law::Dynamics&, const std::vector<contact_law::GrainMotion>&, long made, long asked,
	        const contact_law::Energies* energies);
	// A script has changed motions: overlaps are checked after this step, and the energies' sum is another.
	void motionsChanged();

	// For the start: two grains of which each reaches beyond the other's centre, or empty.
	static std::string tooDeep(const contact_law::Dynamics&);

private:
	std::string wrongMotion(const contact_law::Dynamics&, const std::vector<contact_law::GrainMotion>&, long made, long asked) const;
	std::string wrongEnergies(const contact_law::Dynamics&, const contact_law::Energies&);

	LedgerWatch ledger;
	long stepsSinceCheck = 0; // of the overlaps
};

} // namespace yade
