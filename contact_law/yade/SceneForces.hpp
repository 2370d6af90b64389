// Forces that other engines and scripts put on the grains (O.forces), as the fused engine takes them.
#pragma once
#include "../engine/dynamics.hpp"
#include <core/Scene.hpp>
#include <vector>

namespace yade {

class Engine;
class SceneGrains;

class SceneForces {
public:
	/* Those on grains in O.forces now, by rising grain; none is no entry (Walls keep their motion whatever pushes them).
	 * Unless a ForceResetter does it, O.forces is emptied of what is not permanent: forces are held over one O.step. Throws std::runtime_error, with
	 * one line, when one is not finite. */
	static std::vector<contact_law::OutsideForce> take(Scene&, const SceneGrains&, int threads);
	/* After a step that was refused: engines before this one add their forces again, so those of now go, and with them what a script has added,
	 * which cannot be told from them. */
	static void takeBack(Scene&, const Engine& refused);
	// Before the first step: what the last step of other engines left is dropped, or refused where it may be someone's wish.
	static void dropThoseOfOtherEngines(Scene&, const SceneGrains&, int threads, bool ofContacts);

	// Permanent forces (O.forces.setPermF, setPermT), which YADE does not save: a row of seven numbers a body that has one.
	static std::vector<Real> permanent(Scene&);
	// Throws std::runtime_error where others were set meanwhile, std::invalid_argument for damaged rows.
	static void restorePermanent(Scene&, const std::vector<Real>&);

	/* All that acts on each grain, for YADE's functions, until the next withdraw(). outside: as taken last. With what a script has added
	 * since. */
	void write(Scene&, const SceneGrains&, const contact_law::Dynamics&, const std::vector<contact_law::OutsideForce>& outside);
	void withdraw(Scene&);
	void withdrawInStep(Scene&); // before take()

private:
	struct Load {
		Vector3r force, torque;
		bool operator==(const Load& other) const { return force == other.force && torque == other.torque; }
		Load operator+(const Load& other) const { return { force + other.force, torque + other.torque }; }
		Load operator-(const Load& other) const { return { force - other.force, torque - other.torque }; }
		bool isZero() const { return force.isZero(0) && torque.isZero(0); }
	};
	static Load notPermanent(Scene&, int id);
	std::vector<Load> before, after; // write(), of each body: what is not permanent
};

} // namespace yade
