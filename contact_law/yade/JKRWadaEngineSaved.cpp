// What JKRWadaEngine leaves in O.energy and in checkpoints.
#include "JKRWadaEngineRun.hpp"
#include "SceneForces.hpp"

namespace yade {

void JKRWadaEngine::writeEnergies(const contact_law::Energies& now, Booking booking)
{
	const bool known = booking == Booking::AlreadyInOEnergy;
	if (!booked) channels.takeOver(*scene); // what other engines had stored is stored here from now on
	booked = true;
	current->workOn.blocked = current->workOn.blocked || contact_law::constrained(current->dynamics);
	current->workOn.outside = current->workOn.outside || !current->outside.empty() || now.externalWork != 0;
	channels.set(*scene, now, known, current->workOn);
}

void JKRWadaEngine::forgetSaved() { savedState.clear(), savedForces.clear(); }

// Whether O.energy has the energies of this run still: a script may have cleared it.
bool JKRWadaEngine::isInOEnergy() const
{
	int kinetic = -1;
	scene->energy->findId("kinetic", kinetic, false, false);
	return booked && kinetic >= 0;
}

// O.energy holds what this run has booked before it was saved.
void JKRWadaEngine::continueBooking()
{
	booked = isInOEnergy();
	if (booked) writeEnergies(current->dynamics.energies(), Booking::AlreadyInOEnergy);
}

void JKRWadaEngine::preSave(JKRWadaEngine&)
{
	const auto rest = atRest("O.save()");
	const shared_ptr<Scene> saved = Omega::instance().getScene();
	if (!current) { // before the first step: what was loaded, if anything, is saved again, but for forces set since
		if (saved->forces.getPermForceUsed()) savedForces = SceneForces::permanent(*saved);
		return;
	}
	if (current->scene.lock() != saved) return forgetSaved();
	scene = saved.get();
	// what is saved is that of the state that is saved: a script may have changed it, or not have asked for energies, since the last step
	if (isInOEnergy()) writeEnergies(current->dynamics.energies());
	savedState = current->dynamics.save();
	savedForces = SceneForces::permanent(*scene);
}

} // namespace yade
