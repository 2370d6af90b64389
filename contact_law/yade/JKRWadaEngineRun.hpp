// What JKRWadaEngine holds from its first step on, for its own files: the arrays, and what it keeps of the scene.
#pragma once
#include "JKRWadaEngine.hpp"
#include "SceneContacts.hpp"
#include <boost/weak_ptr.hpp>

namespace yade {

// O.cell: the periodic cell that YADE's Scene deforms at the beginning of each O.step, and its mean velocity field.
class SceneCell {
public:
	// The cell at the start's moment: within an O.step the Scene has deformed it already, and the start is before that. Throws
	// std::runtime_error for a cell that is no box.
	contact_law::PeriodicCell start(const Scene&, Moment);

	/* Before a step: refuses, in one line, a cell that this engine cannot follow. After it the cell is of size now(). */
	void require(const Scene&, const contact_law::Dynamics&) const;
	// Empty, or why the grains cannot go in so many small steps to the cell as it is now.
	std::string wrong(const Scene&, const contact_law::Dynamics&, int steps) const;
	static std::string tooSmall(const contact_law::PeriodicCell&, const contact_law::Dynamics&); // likewise, of its size only
	void arrive(const Scene& scene) { size = now(scene); }

	// Grains get the change of the velocity gradient since they got the last, when Cell.homoDeform says so.
	static void applyVelocityGradient(Scene&, contact_law::Dynamics&);
	// Before that, the velocity gradient that a script wants becomes the present one, as NewtonIntegrator does it.
	static void takeVelocityGradient(Scene&, contact_law::Dynamics&);

	// Takes back, for a step that is refused, how the Scene has deformed the cell at its beginning.
	class Before {
	public:
		explicit Before(const Scene&);
		void restore(Scene&) const;

	private:
		Matrix3r size, transformation;
	};

	static contact_law::Vec3<double> now(const Scene&);
	// Diagonal of the gradient whose convective acceleration grains have [1/s].
	static contact_law::Vec3<double> convective(const Scene&);

private:
	contact_law::Vec3<double> size { 0, 0, 0 }; // that the engine's run has reached [m]
};

// Forces that other engines and scripts put on the grains (O.forces), as the fused engine takes them.
class SceneForces {
public:
	/* Those on grains in O.forces now, by rising grain; none is no entry (Walls keep their motion whatever pushes them). Unless a
	 * ForceResetter does it, O.forces is emptied of what is not permanent: forces are held over one O.step. Throws
	 * std::runtime_error, with one line, when one is not finite. */
	static std::vector<contact_law::OutsideForce> take(Scene&, const SceneGrains&);
	/* After a step that was refused: engines before this one add their forces again, so those of now go, and with them what a
	 * script has added, which cannot be told from them. */
	static void takeBack(Scene&, const Engine& refused);
	// Before the first step: what the last step of other engines left is dropped, or refused where it may be someone's wish.
	static void dropThoseOfOtherEngines(Scene&, const SceneGrains&, bool ofContacts);

	// Permanent forces (O.forces.setPermF, setPermT), which YADE does not save: a row of seven numbers a body that has one.
	static std::vector<Real> permanent(Scene&);
	// Throws std::runtime_error where others were set meanwhile, std::invalid_argument for damaged rows.
	static void restorePermanent(Scene&, const std::vector<Real>&);

	/* All that acts on each grain, for YADE's functions, until the next withdraw(). outside: as taken last. With what a script has
	 * added since. */
	void write(Scene&, const SceneGrains&, const contact_law::Dynamics&, const std::vector<contact_law::OutsideForce>& outside);
	void withdraw(Scene&);
	void withdrawInStep(Scene&); // before take()

private:
	using Load = Eigen::Matrix<Real, 6, 1>; // force and torque
	static std::vector<Load> notPermanent(Scene&);
	std::vector<Load> before, after; // write(), of each body: what is not permanent
};

// Checks after each O.step whether the run is sound, while the bodies still hold the last good state.
class StepWatch {
public:
	// Empty, or what is wrong, after `made` of `wanted` small steps to the given motions. energies: those now, or null when nobody
	// wants them.
	std::string wrong(const contact_law::Dynamics&, const std::vector<contact_law::GrainMotion>&, long made, long wanted,
	        const contact_law::Energies* energies);
	// A script has changed something: losses and the energies' sum are others.
	void forget() { sumKnown = false, lostBefore = -1e300; }

private:
	std::string wrongMotion(const contact_law::Dynamics&, const std::vector<contact_law::GrainMotion>&, long made, long wanted) const;
	std::string wrongEnergies(const contact_law::Energies&, double contactEnergy);

	bool sumKnown = false;
	double firstSum = 0, lostBefore = 0; // of the energies [J]
};

struct JKRWadaEngine::Run {
	SceneGrains grains;
	SceneContacts contacts;
	SceneCell cell;
	Settings settings;                  // at the start
	contact_law::Dynamics::Onset onset; // of the outside forces at the first step
	contact_law::Dynamics dynamics;
	boost::weak_ptr<Scene> scene; // whose grains these are
	std::string name;             // of this run, as ContactsHolder
	SceneForces forces {};
	std::vector<contact_law::GrainMotion> now {};
	StepWatch watch {};
	std::vector<contact_law::OutsideForce> outside {}; // by grains, as they are held
};

} // namespace yade
