#include "JKRWadaEngine.hpp"
#include "../engine/contacts.hpp"
#include "../engine/exchange.hpp"
#include "../engine/stability.hpp"
#include "RunningLoop.hpp"
#include "SceneContacts.hpp"
#include "SceneForces.hpp"
#include "SceneGrains.hpp"
#include "StepWatch.hpp"
#include <boost/weak_ptr.hpp>

namespace yade {

using contact_law::Dynamics;
using contact_law::GrainMotion;

YADE_PLUGIN((JKRWadaEngine));
CREATE_LOGGER(JKRWadaEngine);

struct JKRWadaEngine::Run {
	SceneGrains grains;
	SceneContacts contacts;
	SceneCell cell;
	EngineSettings settings; // at the start
	bool stepBehind;         // until the first step: velocities came from the functors
	Dynamics dynamics;
	boost::weak_ptr<Scene> scene; // whose grains these are
	std::vector<GrainMotion> now {};
	StepWatch watch {};
	std::vector<contact_law::OutsideForce> outside {}; // by ids, as they are held
	EnergyChannels::WorkOn workOn {};                  // at any time: the scene then has the channel
};

namespace {
	// Every scene has one engine that moves its grains.
	void requireAlone(const Scene& scene)
	{
		int engines = 0;
		for (const auto& engine : scene.engines) {
			if (engine->dead) continue;
			for (const char* other : { "NewtonIntegrator", "InteractionLoop" })
				if (engine->getClassName() == other)
					refuseInEngine(std::string(other) + " is among O.engines too; this engine replaces it");
			engines += bool(dynamic_cast<const JKRWadaEngine*>(engine.get()));
		}
		if (engines > 1)
			refuseInEngine("O.engines has " + std::to_string(engines)
			        + " JKRWadaEngines: there must be one, which moves all grains once");
	}
}

EngineSettings JKRWadaEngine::settings() const
{
	return { domains, instructions, linearDamping, slidingStiffnessFactor, neck, sliding, rolling, twisting, limit, orientations };
}

void JKRWadaEngine::requireInRange() const
{
	const auto atLeastOne = [](const char* name, int value) {
		if (value < 1) refuseInEngine(std::string(name) + " = " + text(value) + ": must be >= 1");
	};
	atLeastOne("subSteps", subSteps), atLeastOne("threads", threads);
	if (domains < 0) refuseInEngine("domains = " + text(domains) + ": must be >= 1, or 0 (by the number of bodies)");
	if (!(linearDamping >= 0 && std::isfinite(linearDamping)))
		refuseInEngine("linearDamping = " + text(linearDamping) + ": must be >= 0");
	if (!(slidingStiffnessFactor > 0 && std::isfinite(slidingStiffnessFactor)))
		refuseInEngine("slidingStiffnessFactor = " + text(slidingStiffnessFactor) + ": must be > 0");
	if (neck != 0 && !(neck > 0 && neck <= contact_law::largestNeck))
		refuseInEngine("neck = " + text(neck) + ": must be 0 (no bonds), or up to 0.7 for sintered bonds");
	if (contact_law::limitRuleNumber(limit) < 0) refuseInEngine("limit = " + text(limit) + ": must be 'held' or 'cut'");
}

void JKRWadaEngine::requireOwnScene() const
{
	if (current && current->scene.lock() != Omega::instance().getScene())
		refuseInEngine(
		        "this engine moves the grains of another scene (O.reset() or O.switchScene() was called since its first step): "
		        "a scene must have an engine of its own; make a new one");
}

contact_law::Dynamics::Options JKRWadaEngine::optionsFor(const std::vector<contact_law::Material>& materials) const
{
	Dynamics::Options options;
	options.pairs = { linearDamping, slidingStiffnessFactor };
	options.neck = neck;
	options.domains = domains;
	options.threads = threads;
	options.instructions = instructions;
	options.orientations = orientations;
	bool drag = linearDamping > 0;
	for (const auto& material : materials)
		drag = drag || material.viscoelasticTime > 0;
	options.mechanisms = contact_law::mechanismsOf(sliding, rolling, twisting, drag);
	options.limit = contact_law::LimitRule(contact_law::limitRuleNumber(limit));
	return options;
}

// The grains of the scene, with contacts from the checkpoint, from O.interactions, or where they overlap.
std::shared_ptr<JKRWadaEngine::Run> JKRWadaEngine::newRun(Moment moment)
{
	SceneGrains grains(*scene);
	if (grains.size() == 0) refuseInEngine("there are no bodies");
	const auto materials = grains.materials();
	const bool continued = !savedState.empty();
	Dynamics::Options options = optionsFor(materials);
	options.dt = continued ? smallStep : scene->dt / subSteps;
	SceneContacts contacts;
	const contact_law::Inherited inherited = contacts.take(*scene, options.dt);
	for (const auto& one : inherited.contacts)
		if (one.bonded && one.neck > neck)
			refuseInEngine("O.interactions has sintered bonds of neck = " + text(one.neck) + ", and neck is " + text(neck)
			        + ": must be the largest neck they were made with");
	const bool inherits = !continued && !inherited.contacts.empty(), stepBehind = inherits && inherited.stepBehind;
	if (!continued) SceneForces::dropThoseOfOtherEngines(*scene, grains.size(), threads, stepBehind);
	SceneCell cell;
	options.cell = cell.start(*scene, moment, stepBehind, options.dt);
	options.convective = SceneCell::convective(*scene);
	const auto started = [&](auto&&... from) {
		return std::shared_ptr<Run>(new Run { grains, contacts, cell, settings(), stepBehind,
		        Dynamics(grains.grains(), materials, options, from...), Omega::instance().getScene() });
	};
	return continued ? started(savedState) : inherits ? started(inherited) : started();
}

void JKRWadaEngine::start(Moment moment)
{
	requireAlone(*scene);
	const bool continued = !savedState.empty();
	SceneForces::restorePermanent(*scene, savedForces);
	std::shared_ptr<Run> run;
	try {
		run = newRun(moment);
	} catch (const std::invalid_argument& refusal) { // the engine's, which knows nothing of YADE
		refuseInEngine(refusal.what());
	}
	requireSound(*run);
	current = run;
	current->outside = contact_law::outsideForces(current->dynamics);
	smallStep = run->dynamics.state().dt;
	current->now = current->grains.motions();
	if (continued) { // as the bodies were when they were saved: what a script has changed since is a change like any other
		current->dynamics.read(current->now);
		current->grains.setWritten(current->now);
		current->watch.motionsChanged(); // losses so far may be below zero, after sinter()
		continueBooking();
	} else
		booked = false;
	// that of the last step: one that was set since is taken by prepare(), or in the next step
	SceneCell::applyVelocityGradient(*scene, current->dynamics);
	forgetSaved();
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

void JKRWadaEngine::requireSound(const Run& run)
{
	const Dynamics& dynamics = run.dynamics;
	const std::string tooSmall = SceneCell::tooSmall(dynamics.cell(), dynamics);
	if (!tooSmall.empty()) refuseInEngine(tooSmall);
	const double step = dynamics.state().dt, unstable = contact_law::unstableStep(dynamics);
	if (!(step > 0 && step < unstable))
		refuseInEngine("the small step O.dt/subSteps is " + text(step) + " s: must be above 0 and below " + text(unstable)
		        + " s, where every packing of these grains is unstable (dense ones, and drag, want less)");
	const std::string deep = StepWatch::tooDeep(dynamics);
	if (!deep.empty()) refuseInEngine(deep + " at the start: must be at most 1");
}

// What a script has changed since the last step holds from here on, or is refused.
void JKRWadaEngine::takeChanges()
{
	current->settings.requireSame(settings());
	const auto set = [this](std::size_t k, const GrainMotion& motion) {
		if (!finite(motion)) refuseInEngine(bodyName(k) + " was given a position or velocity that is not a finite number");
		current->dynamics.set(int(k), motion);
		current->watch.motionsChanged();
	};
	current->grains.eachChange(*scene, orientations, current->dynamics.threadCount(), set);
	if (exportInteractions) current->contacts.requireKept(*scene);
}

// The forces that others put on the grains hold through this O.step.
void JKRWadaEngine::takeForces()
{
	std::vector<contact_law::OutsideForce> now = SceneForces::take(*scene, current->grains.size(), current->dynamics.threadCount());
	const auto onset = current->stepBehind ? Dynamics::Onset::AStepAgo : Dynamics::Onset::Now;
	current->stepBehind = false;
	if (now == current->outside) return;
	current->dynamics.setOutsideForces(now, onset);
	current->outside = std::move(now);
	current->watch.motionsChanged();
}

// The beginning of all that this engine does: afterwards there is a run, of this scene, and as scripts want it.
void JKRWadaEngine::enter(Moment moment)
{
	requireOwnScene();
	if (moment == Moment::BetweenSteps) scene = Omega::instance().getScene().get();
	if (!failure.empty()) refuseInEngine(failure);
	requireInRange();
	if (!current) start(moment);
	current->dynamics.setThreads(threads);
	takeChanges();
}

// O.pause() ends O.run() while the last step is still being made: that is waited for.
std::unique_lock<std::mutex> JKRWadaEngine::atRest(const char* call) const
{
	requireLoopAtRest(std::string("JKRWadaEngine: ") + call);
	return std::unique_lock<std::mutex>(busy);
}

void JKRWadaEngine::action()
{
	const std::lock_guard<std::mutex> acting(busy);
	requireAlone(*scene);
	enter(Moment::WithinStep);
	takeForces();
	current->cell.require(*scene, current->dynamics);
	if (scene->dt / subSteps != smallStep)
		refuseInEngine("the small step O.dt/subSteps was changed after the start: it must stay " + text(smallStep) + " s, not "
		        + text(scene->dt / subSteps) + " s" + otherEngine);
	const std::string wrongCell = current->cell.wrong(*scene, current->dynamics, subSteps);
	if (!wrongCell.empty()) fail(scene->time + scene->dt, wrongCell, "");
	const contact_law::Vec3<double> cellAtEnd = SceneCell::now(*scene);
	const long made = current->dynamics.run(subSteps, scene->isPeriodic ? &cellAtEnd : nullptr);
	current->cell.arrive(*scene);
	SceneCell::takeVelocityGradient(*scene, current->dynamics);
	current->dynamics.read(current->now);
	contact_law::Energies energies;
	if (scene->trackEnergy) energies = current->dynamics.energies();
	// before anything is written: the bodies keep the last good state
	const std::string wrong =
	        current->watch.wrong(current->dynamics, current->now, made, subSteps, scene->trackEnergy ? &energies : nullptr);
	if (!wrong.empty()) fail(scene->time + std::min(made + 1, long(subSteps)) * smallStep, wrong);
	writeBodies();
	if (exportInteractions)
		current->contacts.write(*scene, current->dynamics, SceneContacts::Stage::OfPositions);
	else
		current->contacts.withdraw(*scene);
	if (scene->trackEnergy) writeEnergies(energies);
	actedAt = scene->iter;
}

void JKRWadaEngine::fail(Real time, const std::string& what, const char* advice)
{
	failure = "the run broke down at t = " + text(time) + " s: " + what
	        + "; O.bodies hold the last good state, of t = " + text(scene->time) + " s" + advice;
	current.reset();
	forgetSaved(); // by an earlier O.save, of another moment than the bodies are
	refuseInEngine(failure);
}

void JKRWadaEngine::prepare()
{
	const auto rest = atRest("prepare()");
	enter(Moment::BetweenSteps);
	SceneCell::takeVelocityGradient(*scene, current->dynamics);
	if (scene->isPeriodic) { // the mean velocity field is in the grains' velocities now
		current->dynamics.read(current->now);
		writeBodies();
	}
	if (exportInteractions) current->contacts.write(*scene, current->dynamics, SceneContacts::Stage::OfPositions);
	if (scene->trackEnergy) writeEnergies(current->dynamics.energies());
}

void JKRWadaEngine::writeInteractions()
{
	const auto rest = atRest("writeInteractions()");
	enter(Moment::BetweenSteps);
	current->contacts.write(*scene, current->dynamics, SceneContacts::Stage::OfPositions);
}

void JKRWadaEngine::sinter(Real neckNow)
{
	const auto rest = atRest("sinter()");
	if (!(neckNow > 0 && neckNow <= contact_law::largestNeck))
		refuseInEngine("sinter(): neck = " + text(neckNow) + ": must be > 0 and up to 0.7");
	enter(Moment::BetweenSteps);
	const double unstable = contact_law::unstableStepOfBonds(current->dynamics, neckNow);
	if (!(smallStep < unstable))
		refuseInEngine("sinter(): the small step O.dt/subSteps is " + text(smallStep) + " s: must be below " + text(unstable)
		        + " s for bonds of neck = " + text(neckNow));
	current->contacts.withdraw(*scene);
	current->dynamics.sinter(neckNow);
	neck = current->dynamics.state().neck;
	current->settings.neck = neck;
	current->watch.motionsChanged();
	current->dynamics.read(current->now);
	writeBodies(); // their velocities are the same but for rounding: a checkpoint must find them as the engine has them
	if (exportInteractions) current->contacts.write(*scene, current->dynamics, SceneContacts::Stage::OfPositions);
	if (scene->trackEnergy) writeEnergies(current->dynamics.energies());
}

void JKRWadaEngine::handOver()
{
	const auto rest = atRest("handOver()");
	if (!current) refuseInEngine("handOver() before the first step: there is nothing to hand over");
	requireOwnScene();
	if (inStep()) refuseInEngine("handOver() within an O.step: call it between two");
	enter(Moment::BetweenSteps);
	current->contacts.write(*scene, current->dynamics, SceneContacts::Stage::AStepBehind); // with the orientations that go with it
	for (std::size_t k = 0; k < current->now.size(); ++k)
		current->now[k].orientation = motionOf(current->grains.stateOf(k)).orientation;
	contact_law::readAhead(current->dynamics, current->now);
	current->grains.write(current->now, true, current->dynamics.threadCount()); // functors turn the pointers with their bodies
	scene->time += smallStep;
	scene->iter += 1;
	scene->dt = smallStep;
	current.reset();
	forgetSaved(); // by an earlier O.save
}

void JKRWadaEngine::writeBodies() { current->grains.write(current->now, orientations, current->dynamics.threadCount()); }

void JKRWadaEngine::writeEnergies(const contact_law::Energies& now, Booking booking)
{
	const bool known = booking == Booking::AlreadyInOEnergy;
	if (!booked) channels.takeOver(*scene); // what other engines had stored is stored here from now on
	booked = true;
	current->workOn.blocked = current->workOn.blocked || contact_law::constrained(current->dynamics);
	current->workOn.outside = current->workOn.outside || !current->outside.empty() || now.externalWork != 0;
	channels.set(*scene, now, known, current->workOn);
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

bool JKRWadaEngine::hasStarted() const
{
	requireOwnScene();
	return bool(current);
}

std::size_t JKRWadaEngine::bodyCount() const { return current->grains.size(); }

void JKRWadaEngine::readBodies(const SceneGrains::Columns& to) const
{
	current->grains.readNow(*Omega::instance().getScene(), current->dynamics.threadCount(), to);
}

std::vector<contact_law::NormalForces> JKRWadaEngine::normalForces() const { return contact_law::normalForces(current->dynamics); }

boost::python::dict JKRWadaEngine::statistics() const
{
	boost::python::dict result;
	const auto rest = atRest("statistics()");
	if (!current) return result;
	const Dynamics& dynamics = current->dynamics;
	result["contacts"] = contactCount(dynamics);
	result["bonds"] = bondCount(dynamics);
	const auto broken = brokenBonds(dynamics);
	const contact_law::Dissipation lost = dissipated(dynamics);
	static const char* const modes[contact_law::bondModes] = { "brokenByStretching", "brokenBySliding", "brokenByRolling",
		"brokenByTwisting" };
	for (int mode = 0; mode < contact_law::bondModes; ++mode) {
		result[modes[mode]] = broken[mode];
		result[modes[mode] + std::string("Energy")] = lost.*contact_law::bondBreakingBy[mode];
	}
	result["domains"] = dynamics.parts().size();
	result["contactUpdates"] = dynamics.counters().contactUpdates;
	const contact_law::Counts counts = contact_law::counts(dynamics);
	result["events"] = counts.events;
	result["formed"] = counts.formed;
	result["broken"] = counts.broken;
	result["searches"] = dynamics.counters().searches;
	result["looks"] = dynamics.counters().looks;
	result["orders"] = dynamics.counters().orders;
	result["instructions"] = dynamics.state().passes->name;
	return result;
}

} // namespace yade
