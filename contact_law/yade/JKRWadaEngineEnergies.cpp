// What JKRWadaEngine leaves in O.energy.
#include "JKRWadaEngineRun.hpp"

namespace yade {

void JKRWadaEngine::writeEnergies(const contact_law::Energies& now, Booking booking)
{
	const bool known = booking == Booking::AlreadyInOEnergy;
	if (!booked) channels.takeOver();
	booked = true;
	current->workOn.blocked = current->workOn.blocked || contact_law::constrained(current->dynamics) || !current->grains.planes.empty();
	current->workOn.outside = current->workOn.outside || !current->outside.empty() || now.externalWork != 0;
	channels.set(*scene, now, known, current->workOn);
}

// Whether O.energy has the energies of this run still: a script may have cleared it.
bool JKRWadaEngine::isInOEnergy() const { return booked && EnergyChannels::areIn(*scene); }

// O.energy holds what this run has booked before it was saved.
void JKRWadaEngine::continueBooking()
{
	if (isInOEnergy()) writeEnergies(current->dynamics.energies(), Booking::AlreadyInOEnergy);
}

// O.energy.clear(): sums count from there on.
void JKRWadaEngine::takeCleared()
{
	if (booked && !isInOEnergy()) writeEnergies(current->dynamics.energies(), Booking::AlreadyInOEnergy);
}

} // namespace yade
