#include "JKRWadaEngineRun.hpp"
#include "Refusal.hpp"
#include <algorithm>
#include <cmath>

namespace yade {

using contact_law::Diagnosis;
using contact_law::Dynamics;
using Motions = std::vector<contact_law::GrainMotion>;

namespace {
	// Of all energies. Ledgers of runs that are merely coarse (half a t0, 100 m/s) are off by a few per cent at most.
	constexpr double lossRegained = 0.1, sumChanged = 0.5;

	std::string withItsContact(const Diagnosis& d)
	{
		if (d.other < 0) return "; it touches no other";
		return "; its contact with the largest force is with " + bodyName(d.other) + " (overlap " + rounded(d.overlap)
		        + " of the smaller radius, normal force " + rounded(d.force) + " N)";
	}
}

std::string StepWatch::tooDeep(const Dynamics& dynamics)
{
	const Diagnosis d = contact_law::deepestOverlap(dynamics);
	if (d.grain < 0) return "";
	return bodyName(d.grain) + " and " + bodyName(d.other) + " overlap by " + rounded(d.overlap) + " of the smaller radius";
}

std::string StepWatch::wrong(
        const Dynamics& dynamics, const Motions& motions, long made, long wanted, const contact_law::Energies* energies)
{
	std::string found = wrongMotion(dynamics, motions, made, wanted);
	stepsSinceCheck += made;
	if (found.empty() && stepsSinceCheck >= stepsBetweenChecks) {
		stepsSinceCheck = 0;
		found = tooDeep(dynamics);
	}
	if (!found.empty() || !energies) return found;
	const auto& c = dynamics.state().common;
	found = wrongEnergies(*energies, c.pullOffForce * c.pullOffOverlap);
	if (found.empty()) return "";
	const Diagnosis fastest = contact_law::diagnoseGrain(dynamics);
	return found + "; " + bodyName(fastest.grain) + " is the fastest (" + rounded(fastest.speed) + " m/s)" + withItsContact(fastest);
}

std::string StepWatch::wrongMotion(const Dynamics& dynamics, const Motions& motions, long made, long wanted) const
{
	Diagnosis found;
	if (made < wanted) found = contact_law::diagnoseGrain(dynamics);
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

// That a run is unstable shows in its energies while all numbers are finite still. contactEnergy: of one contact, F_c delta_c [J]; bonded
// grains at rest have none but rounding's.
std::string StepWatch::wrongEnergies(const contact_law::Energies& e, double contactEnergy)
{
	const auto values = contact_law::byChannel(e);
	double lost = 0, sum = 0, scale = 1e-9 * contactEnergy;
	for (int channel = 0; channel < contact_law::channelCount; ++channel) {
		const bool isLoss = contact_law::channels[channel].kind == contact_law::ChannelKind::Lost;
		// that of broken bonds comes back where grains were sintered while they were pressed together (MODEL.md)
		if (isLoss && std::string(contact_law::channels[channel].name) != "bondBreaking") lost += values[channel];
		sum += values[channel], scale += std::abs(values[channel]);
	}
	if (!std::isfinite(scale)) return "the energies are not finite";
	if (lost < lostBefore - lossRegained * scale)
		return "losses have given back " + rounded(lostBefore - lost, 3) + " J, which no loss can: the step is too long";
	lostBefore = std::max(lost, lostBefore);
	if (!sumKnown) firstSum = sum;
	sumKnown = true;
	if (std::abs(sum - firstSum) > sumChanged * scale)
		return "energy is not conserved (" + rounded(sum - firstSum, 3) + " J more than before, of " + rounded(scale, 3)
		        + " J): the step is too long";
	return "";
}

} // namespace yade
