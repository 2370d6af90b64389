// What JKRWadaEngine leaves in checkpoints.
#include "JKRWadaEngineRun.hpp"

namespace yade {

void JKRWadaEngine::forgetSaved() { savedState.clear(), savedForces.clear(); }

void JKRWadaEngine::restoreForces()
{
	try {
		SceneForces::restorePermanent(*Omega::instance().getScene(), savedForces);
		savedForces.clear();
	} catch (const std::invalid_argument&) { // damaged: the first step says so
	}
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
	try { // what cannot be taken in is refused by the next step, here or after loading
		if (current->grains.hasMore(*scene)) startAgain();
	} catch (const std::runtime_error&) {
	}
	// what is saved is that of the state that is saved: a script may have changed it, or not have asked for energies, since the last step
	if (isInOEnergy()) writeEnergies(current->dynamics.energies());
	savedState = current->dynamics.save();
	savedForces = SceneForces::permanent(*scene);
}

void JKRWadaEngine::postSave(JKRWadaEngine&)
{
	if (current) savedState.clear();                                                  // a copy of this engine would start from it
	if (Omega::instance().getScene()->forces.getPermForceUsed()) savedForces.clear(); // O.forces has them
}

} // namespace yade
