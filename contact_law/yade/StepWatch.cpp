#include "JKRWadaEngineRun.hpp"
#include "Refusal.hpp"
#include <algorithm>
#include <cmath>

namespace yade {

using contact_law::Dynamics;
using Motions = std::vector<contact_law::GrainMotion>;

namespace {
	// Of all energies. Ledgers of runs that are merely coarse (half a t0, 100 m/s) are off by a few per cent at most.
	constexpr double lossRegained = 0.1, sumChanged = 0.5;

	// Before the grains moved in the latest step: what pushed was the force there.
	std::string withItsContact(const Dynamics& dynamics, int id)
	{
		const contact_law::Overlap deepest = contact_law::deepestOverlap(dynamics, dynamics.state().dt, id);
		if (deepest.first < 0) return "; it touches no other";
		return "; its deepest contact is with " + bodyName(deepest.first == id ? deepest.second : deepest.first) + " (overlap "
		        + rounded(deepest.overlap) + " of the smaller radius)";
	}
}

std::string StepWatch::wrong(
        const Dynamics& dynamics, const Motions& motions, long made, long wanted, const contact_law::Energies* energies)
{
	std::string found = wrongMotion(dynamics, motions, made, wanted);
	if (!found.empty() || !energies) return found;
	const auto& c = dynamics.state().common;
	found = wrongEnergies(*energies, c.pullOffForce * c.pullOffOverlap);
	if (found.empty()) return "";
	const auto [fastest, speed] = contact_law::fastestGrain(dynamics);
	return found + "; " + bodyName(fastest) + " is the fastest (" + rounded(speed) + " m/s)" + withItsContact(dynamics, fastest);
}

std::string StepWatch::wrongMotion(const Dynamics& dynamics, const Motions& motions, long made, long wanted) const
{
	const auto isFinite = [&](std::size_t k) { return finite(motions[k]); };
	if (!forAll(motions.size(), dynamics.threadCount(), isFinite)) {
		int k = 0;
		while (isFinite(k))
			++k;
		return bodyName(dynamics.id(k)) + " has no finite position or velocity any more" + withItsContact(dynamics, dynamics.id(k));
	}
	if (dynamics.isTooDeep()) { // before the grains moved, where they did
		const contact_law::Overlap deepest = contact_law::deepestOverlap(dynamics, made == wanted ? 0 : dynamics.state().dt);
		return tooDeep(deepest.first, deepest.second, deepest.overlap);
	}
	if (made == wanted) return "";
	const auto [fastest, speed] = contact_law::fastestGrain(dynamics);
	return bodyName(fastest) + " moves at " + rounded(speed) + " m/s, more than half the smallest radius in a small step"
	        + withItsContact(dynamics, fastest);
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
