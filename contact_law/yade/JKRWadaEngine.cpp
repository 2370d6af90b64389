#include "../engine/exchange.hpp"
#include "../engine/stability.hpp"
#include "ContactsHolder.hpp"
#include "JKRWadaEngineRun.hpp"
#include "RunningLoop.hpp"
#include "SceneShapes.hpp"

namespace yade {

using contact_law::Dynamics;
using contact_law::GrainMotion;

YADE_PLUGIN((JKRWadaEngine));
CREATE_LOGGER(JKRWadaEngine);

// What a script has changed since the last step holds from here on, or is refused.
void JKRWadaEngine::takeChanges(Moment moment)
{
	current->settings.requireSame(settings());
	if (current->grains.hasMore(*scene)) startAgain();
	const auto set = [this](std::size_t k, const GrainMotion& motion) {
		if (!finite(motion))
			refuseInEngine(bodyName(current->grains.idOf(k))
			        + " was given a position, orientation or velocity that is not a finite number");
		current->dynamics.set(int(k), motion);
		current->watch.motionsChanged();
	};
	current->dynamics.setMeanField({ 0, 0, 0 }, SceneCell::convective(*scene)); // O.cell.homoDeform may be another
	current->grains.eachChange(*scene, orientations, current->dynamics.threadCount(), set);
	if (current->grains.planes.takeChanges(*scene, current->dynamics)) current->watch.motionsChanged();
	if (exportInteractions || moment == Moment::WithinStep) requireContactsKept();
	takeCleared();
	takeStep();
}

// What was written and does not stay goes with the refusal: erasing it needs no undoing.
void JKRWadaEngine::requireContactsKept()
{
	const std::string erased = current->contacts.erased(*scene);
	if (erased.empty()) return;
	if (!exportInteractions) withdrawContacts();
	refuseInEngine(erased);
}

void JKRWadaEngine::withdrawContacts()
{
	if (current->contacts.withdraw(*scene)) ContactsHolder(*scene).set(current->name, false);
}

void JKRWadaEngine::takeStep()
{
	const Real now = scene->dt / subSteps;
	if (now == smallStep) return;
	requireStable(current->dynamics, now);
	current->dynamics.setStep(now);
	smallStep = now;
	current->watch.motionsChanged();
	bringBodies();
}

// The forces that others put on the grains hold through this O.step.
void JKRWadaEngine::takeForces()
{
	std::vector<contact_law::OutsideForce> now = current->forces.take(*scene, current->grains, current->dynamics.threadCount());
	const auto onset = current->onset;
	current->onset = Dynamics::Onset::Now;
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
	if (!current) requireAlone(*scene), start();
	if (!ContactsHolder(*scene).is(current->name))
		refuseInEngine("other engines have moved these grains since this engine's last step: make a new engine");
	current->dynamics.setThreads(threads);
	takeChanges(moment);
}

// O.pause() ends O.run() while the last step is still being made: that is waited for.
std::unique_lock<std::mutex> JKRWadaEngine::atRest(const char* call) const
{
	requireLoopAtRest(std::string("JKRWadaEngine: ") + call);
	return std::unique_lock<std::mutex>(busy);
}

// YADE would resume a step that was refused without its beginning, or begin it again with the cell deformed already.
void JKRWadaEngine::action()
{
	std::unique_lock<std::mutex> acting(busy);
	const SceneCell::Before before(*scene);
	try {
		makeStep();
		if (isReplaced(*scene) && holdsContacts(*scene)) leave();
	} catch (...) {
		before.restore(*scene);
		SceneForces::takeBack(*scene, *this);
		scene->subStep = -1;
		acting.unlock(); // a call that waits for this engine holds Python's lock
		letPythonWait();
		throw;
	}
}

void JKRWadaEngine::makeStep()
{
	if (current && holdsContacts(*scene))
		current->forces.withdrawInStep(*scene); // first: engines before this one act again after a refusal
	requireAlone(*scene);
	enter(Moment::WithinStep);
	current->cell.require(*scene, current->dynamics);
	const std::string tooFast = current->grains.planes.tooFast(smallStep, current->dynamics.state().smallestRadius);
	if (!tooFast.empty()) refuseInEngine(tooFast);
	takeForces(); // last: it empties O.forces
	const std::string wrongCell = current->cell.wrong(*scene, current->dynamics, subSteps);
	if (!wrongCell.empty()) {
		writeContacts();
		fail(scene->time + scene->dt, wrongCell, "");
	}
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
	current->grains.planes.push(*scene, current->dynamics);
	if (exportInteractions)
		writeContacts();
	else
		withdrawContacts();
	if (scene->trackEnergy) writeEnergies(energies);
	actedAt = scene->iter;
}

void JKRWadaEngine::fail(Real time, const std::string& what, const char* advice)
{
	const bool kept = ContactsHolder(*scene).isWritten();
	failure = "the run broke down at t = " + text(time) + " s: " + what
	        + "; O.bodies hold the last good state, of t = " + text(scene->time) + " s, "
	        + (kept ? "and O.interactions its contacts"
	                : "but not its contacts' springs (O.interactions does with exportInteractions=True)")
	        + advice;
	current->forces.withdraw(*scene);
	current.reset();
	ContactsHolder(*scene).clear();
	refuseInEngine(failure);
}

void JKRWadaEngine::prepare()
{
	const auto rest = atRest("prepare()");
	enter(Moment::BetweenSteps);
	SceneCell::takeVelocityGradient(*scene, current->dynamics);
	if (scene->isPeriodic) bringBodies(); // the mean velocity field is in the grains' velocities now
	if (exportInteractions) writeContacts();
	if (scene->trackEnergy) writeEnergies(current->dynamics.energies());
}

void JKRWadaEngine::writeInteractions()
{
	const auto rest = atRest("writeInteractions()");
	enter(Moment::BetweenSteps);
	writeContacts();
}

void JKRWadaEngine::writeContacts()
{
	current->contacts.write(*scene, current->dynamics, SceneContacts::Stage::OfPositions);
	current->forces.write(*scene, current->grains, current->dynamics, current->outside);
	ContactsHolder(*scene).set(current->name, true);
}

void JKRWadaEngine::sinter(Real neckNow)
{
	const auto rest = atRest("sinter()");
	if (!(neckNow > 0 && neckNow <= contact_law::largestNeck))
		refuseInEngine("sinter(): neck = " + text(neckNow) + ": must be > 0 and up to 0.7");
	enter(Moment::BetweenSteps);
	if (!current->grains.planes.empty()) refuseInEngine(bondsOfPlanes);
	const double unstable = contact_law::unstableStepOfBonds(current->dynamics, neckNow);
	if (!(smallStep < unstable))
		refuseInEngine("sinter(): the small step O.dt/subSteps is " + text(smallStep) + " s: must be below " + text(unstable)
		        + " s for bonds of neck = " + text(neckNow));
	current->contacts.withdraw(*scene);
	current->dynamics.sinter(neckNow);
	neck = current->dynamics.state().neck;
	current->settings.neck = neck;
	current->watch.motionsChanged();
	bringBodies();
	if (exportInteractions) writeContacts();
	if (scene->trackEnergy) writeEnergies(current->dynamics.energies());
}

void JKRWadaEngine::handOver()
{
	const auto rest = atRest("handOver()");
	if (!current) refuseInEngine("handOver() before the first step: there is nothing to hand over");
	requireOwnScene();
	if (inStep()) refuseInEngine("handOver() within an O.step: call it between two");
	enter(Moment::BetweenSteps);
	if (EnergyChannels::areIn(*scene)) writeEnergies(current->dynamics.energies());
	current->contacts.write(*scene, current->dynamics, SceneContacts::Stage::AStepBehind); // with the orientations that go with it
	for (std::size_t k = 0; k < current->now.size(); ++k)
		current->now[k].orientation = motionOf(current->grains.stateOf(k)).orientation;
	contact_law::readAhead(current->dynamics, current->now);
	current->grains.write(current->now, true, current->dynamics.threadCount()); // functors turn the pointers with their bodies
	current->grains.planes.write(current->dynamics, smallStep);
	scene->time += smallStep;
	scene->iter += 1;
	scene->dt = smallStep;
	current->forces.withdraw(*scene);
	current.reset();
	ContactsHolder(*scene).clear();
}

// Contacts go to O.interactions, where whatever moves the grains from here on finds them, in the state of the bodies as this engine left them.
void JKRWadaEngine::leaveContacts()
{
	if (EnergyChannels::areIn(*scene)) writeEnergies(current->dynamics.energies());
	const auto isThere = [this](int id) { return current->grains.hasBody(*scene, id); };
	current->contacts.write(*scene, current->dynamics, SceneContacts::Stage::OfPositions, isThere);
	ContactsHolder(*scene).set(current->name, true);
}

void JKRWadaEngine::leave()
{
	leaveContacts();
	current->forces.withdraw(*scene);
	current.reset();
	ContactsHolder(*scene).clear();
}

bool JKRWadaEngine::isAmong(const std::vector<shared_ptr<Engine>>& engines) const
{
	return std::any_of(engines.begin(), engines.end(), [this](const auto& engine) { return engine.get() == this && !engine->dead; });
}

bool JKRWadaEngine::isReplaced(const Scene& now) const
{
	return !isAmong(
	        now._nextEngines.empty() ? now.engines : now._nextEngines); // those next: a script has set O.engines within an O.step
}

bool JKRWadaEngine::inStep() const
{
	const Scene& now = *Omega::instance().getScene();
	return now.subStep >= 0 && actedAt == now.iter;
}

bool JKRWadaEngine::actsYet() const
{
	const Scene& now = *Omega::instance().getScene();
	return now.subStep >= 0 && !inStep() && isAmong(now.engines);
}

bool JKRWadaEngine::holdsContacts(Scene& now) const
{
	const ContactsHolder holder(now);
	return current ? current->scene.lock().get() == &now && holder.is(current->name) : holder.isAny() && !savedState.empty();
}

void JKRWadaEngine::giveWay()
{
	const auto rest = atRest("O.engines was given others");
	Scene& now = *Omega::instance().getScene();
	if (!isReplaced(now) || !holdsContacts(now)) return;
	scene = &now;
	if (!current) start();
	if (actsYet())
		leaveContacts(); // and leaves then; but YADE does not come to this engine where one before it throws
	else
		leave();
}

// Bodies were added: another run of all bodies, which has the contacts of this one and goes on booking. This one stays where that is refused.
void JKRWadaEngine::startAgain()
{
	const SceneGrains all(*scene); // refuses bodies that cannot be moved, while nothing is changed
	const std::shared_ptr<Run> before = current;
	leaveContacts();
	const bool wasBooked = booked; // with that too
	start(true);
	before->forces.withdraw(*scene);
	current->dynamics.continueFrom(contact_law::booked(before->dynamics));
	current->watch.motionsChanged(); // what was lost before may be below zero: grains torn apart by a script, sinter()
	booked = wasBooked;
	current->workOn = before->workOn;
}

void JKRWadaEngine::writeBodies()
{
	current->grains.write(current->now, orientations, current->dynamics.threadCount());
	current->grains.planes.write(current->dynamics);
}

// After a change between steps. Velocities that are the same but for rounding too: a checkpoint must find them as the engine has them.
void JKRWadaEngine::bringBodies()
{
	current->dynamics.read(current->now);
	writeBodies();
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

contact_law::NormalForces JKRWadaEngine::normalForcesOnPlanes() const { return contact_law::normalForcesOnPlanes(current->dynamics); }

boost::python::dict JKRWadaEngine::statistics() const
{
	boost::python::dict result;
	const auto rest = atRest("statistics()");
	if (!current) return result;
	const Dynamics& dynamics = current->dynamics;
	result["contacts"] = contactCount(dynamics);
	result["planeContacts"] = planeContactCount(dynamics);
	result["bonds"] = bondCount(dynamics);
	const contact_law::Dissipation lost = dissipated(dynamics);
	const contact_law::Counts counts = contact_law::counts(dynamics);
	for (int mode = 0; mode < contact_law::bondModeCount; ++mode) {
		const auto& [name, energy] = contact_law::bondModes[mode];
		result[name] = counts.brokenBonds[mode];
		result[std::string(name) + "Energy"] = lost.*energy;
	}
	result["domains"] = dynamics.parts().size();
	result["contactUpdates"] = dynamics.counters().contactUpdates;
	result["events"] = counts.events;
	result["formed"] = counts.formed;
	result["broken"] = counts.broken;
	result["searches"] = dynamics.counters().searches;
	result["distanceChecks"] = dynamics.counters().distanceChecks;
	result["orders"] = dynamics.counters().orders;
	result["instructions"] = dynamics.state().passes->name;
	return result;
}

} // namespace yade
