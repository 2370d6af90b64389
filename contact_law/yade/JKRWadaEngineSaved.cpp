// What JKRWadaEngine leaves in checkpoints.
#include "JKRWadaEngineRun.hpp"

namespace yade {

void JKRWadaEngine::forgetSaved() { savedState.clear(), savedForces.clear(); }

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
