// Forces that other engines and scripts put on the grains (O.forces), as the fused engine takes them.
#pragma once
#include "../engine/outside_forces.hpp"
#include <core/Scene.hpp>
#include <vector>

namespace yade {

class SceneForces {
public:
	/* Those in O.forces now, by rising id; none is no entry. Unless a ForceResetter does it, O.forces is emptied of what is not permanent:
	 * forces are held over one O.step. Throws std::runtime_error, with one line, when one is not finite. */
	static std::vector<contact_law::OutsideForce> take(Scene&, std::size_t bodies, int threads);
	// Before the first step: what the last step of other engines left is dropped, or refused where it may be someone's wish.
	static void dropThoseOfOtherEngines(Scene&, std::size_t bodies, int threads, bool ofFunctors);

	// Permanent forces (O.forces.setPermF, setPermT), which YADE does not save: a row of seven numbers a body that has one.
	static std::vector<Real> permanent(Scene&);
	static void restorePermanent(Scene&, const std::vector<Real>&); // unless there are others
};

} // namespace yade
