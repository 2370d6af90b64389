// The fused engine: neighbour search, contact law and leapfrog of JKR-Wada grains in arrays of its own.
#pragma once
#include "../engine/contacts.hpp"
#include "EnergyChannels.hpp"
#include "SceneGrains.hpp"
#include <boost/python.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace yade {

enum class Moment { BetweenSteps, WithinStep }; // of O.step

class JKRWadaEngine : public GlobalEngine {
	struct Run; // the arrays, made at the first step
	std::shared_ptr<Run> current;
	EnergyChannels channels;

	mutable std::mutex busy; // held while this engine acts
	long actedAt = -1;       // iteration
	std::string failure;     // why the run cannot be continued

	using Settings =
	        std::vector<std::pair<std::string, std::string>>; // attributes that a run keeps from its start to its end: name, value
	Settings settings() const;
	void requireSameSettings() const;
	contact_law::Dynamics::Options optionsFor(const std::vector<contact_law::Material>&) const;
	contact_law::PairOptions pairOptions() const { return { CONTACT_LAW_PAIR_OPTIONS(CONTACT_LAW_VALUE) }; }
	int threadsOrYades() const;
	void requireInRange() const;
	void requireOwnScene() const;

	std::shared_ptr<Run> newRun(bool again);
	void start(bool again = false); // again: a scene that this engine has moved before
	void takeMoreBodies();
	void exportContacts();
	void readAnew();
	void writeChanged();
	void leave();
	bool isAmong(const std::vector<shared_ptr<Engine>>&) const; // and not dead
	bool isReplaced(const Scene&) const;
	bool actsYet() const; // within an O.step, later
	void writeContacts();
	void withdrawContacts();
	void requireContactsKept();
	bool isInOEnergy() const;
	void takeCleared();
	static void requireSound(const Run&);
	static void requireStable(const contact_law::Dynamics&, Real step);
	static void requireAlone(const Scene&);
	void enter(Moment);
	void takeChanges(Moment);
	void takeStep();
	void makeStep();
	void takeForces();
	[[noreturn]] void fail(Real time, const std::string& what, const char* advice = ". A smaller step may help");
	void writeBodies();
	void bringBodies();
	void writeEnergies(const contact_law::Energies&, bool known = false); // known: O.energy has them already

public:
	void action() override;
	void preSave(JKRWadaEngine&);
	void postSave(JKRWadaEngine&);
	void prepare();
	void writeInteractions();
	void giveWay();
	void restoreForces();
	void sinter(Real neck);
	void setMaterial(const shared_ptr<JKRMat>& material, const shared_ptr<JKRMat>& as);
	bool inStep() const;              // between this engine's action and the end of O.step
	bool holdsContacts(Scene&) const; // those of a checkpoint too, from before the first step
	// For calls from Python: throws std::runtime_error while O.run() is under way, otherwise keeps the engine from acting as long as
	// the lock lives.
	std::unique_lock<std::mutex> atRest(const char* call) const;
	// From the first step on, otherwise null. Refuses where the bodies are not the same any more.
	const contact_law::Dynamics* dynamics() const;
	boost::python::dict statistics() const;
	virtual ~JKRWadaEngine() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(JKRWadaEngine, GlobalEngine,
		"Moves spheres of :yref:`JKRMat` under the contact law of :yref:`Law2_ScGeom_JKRWadaPhys_JKRWada`, between each other and "
		"with planes (Wall), much faster than YADE's loop: it replaces ForceResetter, collider, "
		"InteractionLoop and NewtonIntegrator. Each O.step makes subSteps steps of O.dt/subSteps; after it O.bodies are current "
		"(positions and velocities of one and the same moment), "
		"and so is O.energy when O.trackEnergy. "
		"contact_law/SCRIPTS.md says what it does with forces, blocked degrees of freedom, periodic cells and contacts of other "
		"engines, and which changes by scripts it obeys. "
		"Results are the same to the bit whatever the number of threads, and after O.save and O.load.",
		((int, subSteps, 1, , "Small steps in one O.step."))
		((int, threads, 0, , "Threads to use, at most as many as domains. 0: YADE's own (yade -jN)."))
		((int, domains, 0, , "Parts that the grains are divided into, for the threads. 0: by the number of bodies, 2 up to "
			"24,000, then 4, 8 ... up to 64, so that results do not depend on the machine. Another number changes results by "
			"rounding."))
		((std::string, instructions, "", , "Instruction set: 'avx512', 'avx2', 'portable', or '' for the best this machine has. "
			"Another one changes results by rounding."))
		CONTACT_LAW_PAIR_OPTIONS(CONTACT_LAW_OPTION_ATTRIBUTE)
		((Real, neck, 0, , "Radius of sintered necks over that of the grains, up to 0.7; 0: nothing is sintered. Grains that "
			"touch at the start are bonded, all others as shrunk as they "
			"(:yref:`Ip2_JKRMat_JKRMat_JKRWadaPhys.neck`). After sinter(): the largest neck of any bond."))
		((bool, sliding, true, , "Whether contacts resist sliding (bonds always do; likewise below)."))
		((bool, rolling, true, , "Whether contacts resist rolling."))
		((bool, twisting, true, , "Whether contacts resist twisting."))
		((std::string, limit, contact_law::limitRuleNames[0], , "What happens to sliding, rolling and twisting springs of "
			"ordinary contacts at their limits. 'held': the displacement is held there (Wada et al. 2007). 'cut': the spring "
			"is cut, what it stores is lost, and a new one without strain takes its place (Sirono & Ueno 2017)."))
		((bool, orientations, false, , "Whether to follow the bodies' orientations (State.ori); otherwise they stay as they were."))
		((bool, exportInteractions, false, , "Whether to write all contacts to O.interactions, and the forces on the grains to "
			"O.forces, after each O.step, for recorders and stresses. It costs as much as some 25 small steps."))
		((Real, smallStep, 0, Attr::readonly, "O.dt/subSteps of the latest step [s]."))
		((bool, booked, false, Attr::readonly|Attr::hidden, "Whether O.energy has the energies of this run."))
		((std::vector<Real>, savedState, , Attr::readonly|Attr::hidden, "The engine's arrays, in a checkpoint "
			"(engine/checkpoint.cpp)."))
		((std::vector<Real>, savedForces, , Attr::readonly|Attr::hidden, "Permanent forces of O.forces, in a checkpoint: id, "
			"force and torque each.")),
		,
		.def("prepare", &JKRWadaEngine::prepare, "Read the bodies and compute forces and energies without moving anything, so "
			"that O.energy and contact_law.snapshot() have the start.")
		.def("writeInteractions", &JKRWadaEngine::writeInteractions, "Write all contacts to O.interactions now (real ones, by "
			"rising ids, with ScGeom and JKRWadaPhys), and the forces on the grains to O.forces. They go at the next O.step, "
			"unless exportInteractions.")
		.def("giveWay", &JKRWadaEngine::giveWay, "Leave the contacts in O.interactions, to whatever moves the grains from here "
			"on, unless this engine is among O.engines and not dead. `import contact_law` calls it whenever O.engines is set.")
		.def("restoreForces", &JKRWadaEngine::restoreForces, "Put the permanent forces of a checkpoint into O.forces, once. "
			"`import contact_law` has this called after O.load.")
		.def("sinter", &JKRWadaEngine::sinter, boost::python::arg("neck"), "All contacts become bonds of this neck now, without "
			"strain where the grains are; existing bonds keep their own neck. All grains shrink by the largest neck, "
			"which is this engine's neck from now on. What the contacts held is booked as disconnection. Call it between two "
			"O.steps. contact_law.sinter() calls this, or the functors'.")
		.def("setMaterial", &JKRWadaEngine::setMaterial, (boost::python::arg("material"), boost::python::arg("like")),
			"A material gets the constants of another one now, and all contacts theirs. contact_law.set_material() calls this, or "
			"the functors'.")
		.def("statistics", &JKRWadaEngine::statistics, "Dict: contacts now, of these bonds; planeContacts (with Walls); bonds "
			"broken so far by mode (brokenByStretching, -Sliding, -Rolling, -Twisting) and what that took (by the same name "
			"with Energy, in J); contactUpdates (small steps times contacts), events (contacts that formed or broke, and "
			"slips), formed and broken (contacts, bonds not among them), searches (for neighbours, of all grains), "
			"distanceChecks (of pairs that do not touch), orders (times that grains were put into a new order), domains, "
			"threads, instructions.")
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(JKRWadaEngine);

// Reads a scene of JKR-Wada grains out in bulk, everything at one and the same moment.
class JKRWadaSnapshot : public Serializable {
public:
	boost::python::dict read() const;
	virtual ~JKRWadaSnapshot() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(JKRWadaSnapshot, Serializable,
		"Arrays of the grains and contacts of the current scene, for :yref:`contact_law.snapshot`.",
		,
		,
		.def("read", &JKRWadaSnapshot::read,
			"Dict of bytearrays (double or 32-bit int, in the order of body ids) and the time [s]. Call it from a PyRunner "
			"that stands last among the engines.")
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(JKRWadaSnapshot);

} // namespace yade
