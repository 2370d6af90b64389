// Notices from the energies that a run is unstable, while all numbers are finite still.
#pragma once
#include "../kernel/energy_channels.hpp"
#include "Refusal.hpp"
#include <algorithm>
#include <cmath>
#include <string>

namespace yade {

class LedgerWatch {
public:
	// Scripts may give energy to grains, or take it, and tear contacts apart: sum and losses are others from the next energies on.
	void forgetSum() { known = false, lostBefore = -1e300; }

	// Empty, or what the energies after a step show. contactEnergy: of one contact, F_c delta_c [J]; bonded grains at rest have none
	// but rounding's.
	std::string wrong(const contact_law::Energies& e, double contactEnergy)
	{
		const auto values = contact_law::byChannel(e);
		double lost = 0, sum = 0, scale = 0;
		for (int channel = 0; channel < contact_law::channelCount; ++channel) {
			sum += values[channel], scale += std::abs(values[channel]);
			if (isLoss(contact_law::channels[channel])) lost += values[channel];
		}
		if (!std::isfinite(scale)) return "the energies are not finite";
		scale = std::max(scale, negligible * contactEnergy);
		if (lost < lostBefore - lossRegained * scale)
			return "losses have given back " + rounded(lostBefore - lost, 3) + " J, which no loss can: the step is too long";
		lostBefore = std::max(lost, lostBefore);
		if (!known) first = sum;
		known = true;
		if (std::abs(sum - first) > sumChanged * scale)
			return "energy is not conserved (" + rounded(sum - first, 3) + " J more than before, of " + rounded(scale, 3)
			        + " J): the step is too long";
		return "";
	}

private:
	// Whether a channel's energy cannot come back. That of broken bonds does, where grains were sintered while they were pressed
	// together (MODEL.md, "Sintering a running scene").
	static bool isLoss(const contact_law::Channel& channel)
	{
		return channel.kind == contact_law::ChannelKind::Lost && channel.name != std::string("bondBreaking");
	}

	// Ledgers of runs that are merely coarse (half a t0, 100 m/s) are off by a few per cent at most.
	static constexpr double lossRegained = 0.1, sumChanged = 0.5, negligible = 1e-9;

	bool known = false;
	double first = 0, lostBefore = 0;
};

} // namespace yade
