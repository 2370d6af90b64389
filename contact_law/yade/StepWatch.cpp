#include "StepWatch.hpp"
#include "../engine/diagnosis.hpp"
#include "Refusal.hpp"
#include "SceneGrains.hpp"

namespace yade {

using contact_law::Diagnosis;
using contact_law::Dynamics;
using Motions = std::vector<contact_law::GrainMotion>;

namespace {
	constexpr long stepsBetweenChecks = 30; // of the overlaps, which take about half a small step

	std::string pairOf(const Diagnosis& d) { return bodyName(d.grain) + " and " + bodyName(d.other); }
	std::string inNumbers(const Diagnosis& d)
	{
		return " (overlap " + rounded(d.overlap) + " of the smaller radius, normal force " + rounded(d.force) + " N)";
	}
	std::string withItsContact(const Diagnosis& d)
	{
		if (d.other < 0) return "; it touches no other";
		return "; its contact with the largest force is with " + bodyName(d.other) + inNumbers(d);
	}
}

std::string StepWatch::tooDeep(const Dynamics& dynamics)
{
	const Diagnosis deepest = contact_law::deepestOverlap(dynamics);
	return deepest.grain < 0 ? "" : pairOf(deepest) + " overlap by " + rounded(deepest.overlap) + " of the smaller radius";
}

void StepWatch::motionsChanged()
{
	ledger.forgetSum();
	stepsSinceCheck = stepsBetweenChecks;
}

std::string StepWatch::wrong(const Dynamics& dynamics, const Motions& motions, long made, long asked, const contact_law::Energies* energies)
{
	std::string found = wrongMotion(dynamics, motions, made, asked);
	stepsSinceCheck += made;
	if (found.empty() && stepsSinceCheck >= stepsBetweenChecks) {
		stepsSinceCheck = 0;
		found = tooDeep(dynamics);
	}
	if (found.empty() && energies) found = wrongEnergies(dynamics, *energies);
	return found;
}

std::string StepWatch::wrongMotion(const Dynamics& dynamics, const Motions& motions, long made, long asked) const
{
	Diagnosis found;
	if (made < asked) found = contact_law::diagnoseGrain(dynamics);
	const auto isFinite = [&](std::size_t k) { return finite(motions[k]); };
	if (found.grain < 0 && !forAll(motions.size(), dynamics.threadCount(), isFinite))
		for (std::size_t k = 0; k < motions.size() && found.grain < 0; ++k)
			if (!isFinite(k)) found = contact_law::diagnoseGrain(dynamics, int(k));
	if (found.grain < 0) return "";
	if (!std::isfinite(found.speed))
		return bodyName(found.grain) + " has no finite position or velocity any more" + withItsContact(found);
	return bodyName(found.grain) + " moves at " + rounded(found.speed) + " m/s, more than half the smallest radius in a small step"
	        + withItsContact(found);
}

std::string StepWatch::wrongEnergies(const Dynamics& dynamics, const contact_law::Energies& energies)
{
	const auto& c = dynamics.state().common;
	const std::string found = ledger.wrong(energies, c.pullOffForce * c.pullOffOverlap);
	if (found.empty()) return "";
	const Diagnosis fastest = contact_law::diagnoseGrain(dynamics), largest = contact_law::largestForce(dynamics);
	return found + "; " + bodyName(fastest.grain) + " is the fastest (" + rounded(fastest.speed) + " m/s)"
	        + (largest.grain < 0 ? ", and none touch any more"
	                             : ", the contact with the largest force is that of " + pairOf(largest) + inNumbers(largest));
}

} // namespace yade
