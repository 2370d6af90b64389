// The steps of JKRWadaEngine, and its calls between them.
#include "JKRWadaEngineRun.hpp"
#include "SceneShapes.hpp"

namespace yade {

using contact_law::Dynamics;

YADE_PLUGIN((JKRWadaEngine));

// What a script has changed since the last step holds from here on, or is refused.
void JKRWadaEngine::takeChanges(Moment moment)
{
	requireSameSettings();
	if (current->grains.hasMore(*scene)) takeMoreBodies();
	current->dynamics.setMeanField({ 0, 0, 0 }, SceneCell::convective(*scene)); // O.cell.homoDeform may be another
	if (current->grains.takeChanges(*scene, orientations, current->dynamics)) current->watch.forget();
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
	current->watch.forget();
	bringBodies();
}

// The forces that others put on the grains hold through this O.step.
void JKRWadaEngine::takeForces()
{
	std::vector<contact_law::OutsideForce> now = current->forces.take(*scene, current->grains);
	const auto onset = current->onset;
	current->onset = Dynamics::Onset::Now;
	if (now == current->outside) return;
	current->dynamics.setOutsideForces(now, onset);
	current->outside = std::move(now);
	current->watch.forget();
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
	current->dynamics.setThreads(threadsOrYades());
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
	refuseIfAny(current->grains.tooFast(smallStep, current->dynamics.state().smallestRadius));
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
	current->grains.pushPlanes(*scene, current->dynamics);
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
	current->contacts.write(*scene, current->dynamics);
	current->forces.write(*scene, current->grains, current->dynamics, current->outside);
	ContactsHolder(*scene).set(current->name, true);
}

void JKRWadaEngine::sinter(Real neckNow)
{
	const auto rest = atRest("sinter()");
	if (!(neckNow > 0 && neckNow <= contact_law::largestNeck))
		refuseInEngine("sinter(): neck = " + text(neckNow) + ": must be > 0 and up to 0.7");
	enter(Moment::BetweenSteps);
	if (current->grains.hasPlanes()) refuseInEngine(bondsOfPlanes);
	const double unstable = contact_law::unstableStepOfBonds(current->dynamics, neckNow);
	if (!(smallStep < unstable))
		refuseInEngine("sinter(): the small step O.dt/subSteps is " + text(smallStep) + " s: must be below " + text(unstable)
		        + " s for bonds of neck = " + text(neckNow));
	const Real before = current->dynamics.totalEnergy();
	exportContacts();
	neck = std::max(neck, neckNow);
	SharedConstants constants;
	SharedBonds bonds;
	sinterContacts(*scene, pairOptions(), neckNow, neck, constants, bonds);
	readAnew();
	current->dynamics.bookDisconnection(
	        before - current->dynamics.totalEnergy()); // of the leapfrog's kinetic energy: contacts push no more
	writeChanged();
}

// What the change of contacts takes, or brings, is constraintWork, but for what springs lose that are beyond their new limits.
void JKRWadaEngine::setMaterial(const shared_ptr<JKRMat>& material, const shared_ptr<JKRMat>& as)
{
	const auto rest = atRest("set_material()");
	enter(Moment::BetweenSteps);
	const Real before = current->dynamics.totalEnergy(), disconnection = contact_law::booked(current->dynamics).lost.disconnection;
	exportContacts();
	const contact_law::Material was = material->forKernel();
	material->set(as->forKernel());
	try {
		readAnew();
	} catch (...) {
		material->set(was);
		throw;
	}
	current->dynamics.bookDisconnection(disconnection - contact_law::booked(current->dynamics).lost.disconnection);
	current->dynamics.bookConstraintWork(before - current->dynamics.totalEnergy());
	writeChanged();
}

// Between two steps, after the scene was read anew.
void JKRWadaEngine::writeChanged()
{
	current->contacts.withdraw(*scene);
	bringBodies();
	if (exportInteractions) writeContacts();
	if (scene->trackEnergy) writeEnergies(current->dynamics.energies());
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
		exportContacts(); // and leaves then; but YADE does not come to this engine where one before it throws
	else
		leave();
}

void JKRWadaEngine::writeBodies()
{
	current->grains.write(current->now, orientations, current->dynamics.threadCount());
	current->grains.writePlanes(current->dynamics);
}

// After a change between steps. Velocities that are the same but for rounding too: a checkpoint must find them as the engine has them.
void JKRWadaEngine::bringBodies()
{
	current->dynamics.read(current->now);
	writeBodies();
}

// ---- O.energy ----

void JKRWadaEngine::writeEnergies(const contact_law::Energies& now, bool known)
{
	if (!booked) channels.takeOver();
	booked = true;
	channels.set(*scene, now, known);
}

// Whether O.energy has the energies of this run still: a script may have cleared it.
bool JKRWadaEngine::isInOEnergy() const { return booked && EnergyChannels::areIn(*scene); }

// O.energy.clear(): sums count from there on.
void JKRWadaEngine::takeCleared()
{
	if (booked && !isInOEnergy()) writeEnergies(current->dynamics.energies(), true);
}

// ---- what others read ----

const Dynamics* JKRWadaEngine::dynamics() const
{
	requireOwnScene();
	if (!current) return nullptr;
	current->grains.requireSame(*Omega::instance().getScene());
	return &current->dynamics;
}

boost::python::dict JKRWadaEngine::statistics() const
{
	boost::python::dict result;
	const auto rest = atRest("statistics()");
	if (!current) return result;
	const Dynamics& dynamics = current->dynamics;
	result["contacts"] = contactCount(dynamics);
	result["planeContacts"] = contact_law::normalForcesOnPlanes(dynamics).forces.size();
	result["bonds"] = bondCount(dynamics);
	const contact_law::Booked all = contact_law::booked(dynamics);
	for (int mode = 0; mode < contact_law::bondModeCount; ++mode) {
		const auto& [name, energy] = contact_law::bondModes[mode];
		result[name] = all.counts.brokenBonds[mode];
		result[std::string(name) + "Energy"] = all.lost.*energy;
	}
	result["domains"] = dynamics.parts().size();
	result["threads"] = dynamics.threadCount();
	result["contactUpdates"] = all.counters.contactUpdates;
	result["events"] = all.counts.events;
	result["formed"] = all.counts.formed;
	result["broken"] = all.counts.broken;
	result["searches"] = all.counters.searches;
	result["distanceChecks"] = all.counters.distanceChecks;
	result["orders"] = all.counters.orders;
	result["instructions"] = dynamics.state().passes->name;
	return result;
}

} // namespace yade
