// How a run of JKRWadaEngine starts: from a scene, from a checkpoint, or from its own contacts in a scene that has changed; and what it
// leaves behind.
#include "JKRWadaEngineRun.hpp"
#include "SceneShapes.hpp"
#include <omp.h>
#include <set>

namespace yade {

using contact_law::Dynamics;

namespace {
	// A ForceResetter after this engine would empty what it writes; forces that are added there would come a step late, or never.
	const std::set<std::string> enginesBefore { "ForceResetter", "AxialGravityEngine", "CentralConstantAccelerationEngine",
		"DragEngine", "ForceEngine", "GravityEngine", "HarmonicForceEngine", "HdapsGravityEngine", "HydroForceEngine",
		"InterpolatingDirectedForceEngine", "LinearDragEngine", "RadialForceEngine", "TorqueEngine" };
}

// Every scene has one engine that moves its grains.
void JKRWadaEngine::requireAlone(const Scene& scene)
{
	int engines = 0;
	std::string late;
	for (const auto& engine : scene.engines) {
		if (engine->dead) continue;
		const std::string name = engine->getClassName();
		if (name == "NewtonIntegrator" || name == "InteractionLoop")
			refuseInEngine(name + " is among O.engines too; this engine replaces it (gravity: a GravityEngine before it)");
		if (engines && enginesBefore.count(name)) late = name;
		engines += bool(dynamic_cast<const JKRWadaEngine*>(engine.get()));
	}
	if (engines > 1)
		refuseInEngine(
		        "O.engines has " + std::to_string(engines) + " JKRWadaEngines: there must be one, which moves all grains once");
	if (!late.empty()) refuseInEngine(late + " comes after this engine in O.engines, too late for O.forces: must come before");
}

JKRWadaEngine::Settings JKRWadaEngine::settings() const
{
	return { { "domains", text(domains) }, { "instructions", text(instructions) }, { "linearDamping", text(linearDamping) },
		{ "slidingStiffnessFactor", text(slidingStiffnessFactor) }, { "rollingStiffnessFactor", text(rollingStiffnessFactor) },
		{ "springDamping", text(springDamping) }, { "mixedSurfaceEnergyFactor", text(mixedSurfaceEnergyFactor) },
		{ "neck", text(neck) }, { "sliding", text(sliding) }, { "rolling", text(rolling) }, { "twisting", text(twisting) },
		{ "limit", text(limit) }, { "orientations", text(orientations) } };
}

void JKRWadaEngine::requireSameSettings() const
{
	const Settings now = settings();
	for (std::size_t k = 0; k < now.size(); ++k)
		if (now[k] != current->settings[k])
			refuseInEngine(now[k].first + " was changed after the start: it must stay " + current->settings[k].second + ", not "
			        + now[k].second + "; a new JKRWadaEngine takes the contacts over");
}

void JKRWadaEngine::requireInRange() const
{
	constexpr int mostSubSteps = 1000000; // of a pair some seconds; nothing stops an O.step that has begun
	if (subSteps < 1 || subSteps > mostSubSteps)
		refuseInEngine("subSteps = " + text(subSteps) + ": must be >= 1 and <= " + text(mostSubSteps));
	if (threads < 0) refuseInEngine("threads = " + text(threads) + ": must be >= 1, or 0 (those of YADE)");
	if (domains < 0) refuseInEngine("domains = " + text(domains) + ": must be >= 1, or 0 (by the number of bodies)");
	try {
		yade::requireInRange(pairOptions(), neck);
		limitRuleOf(limit);
		if (springDamping > 0 && !(sliding && rolling && twisting)) throw std::invalid_argument(dampedWithoutSprings);
	} catch (const std::invalid_argument& refusal) {
		refuseInEngine(refusal.what());
	}
}

void JKRWadaEngine::requireOwnScene() const
{
	if (current && current->scene.lock() != Omega::instance().getScene())
		refuseInEngine(
		        "this engine moves the grains of another scene (O.reset() or O.switchScene() was called since its first step): "
		        "a scene must have an engine of its own; make a new one");
}

int JKRWadaEngine::threadsOrYades() const { return threads > 0 ? threads : omp_get_max_threads(); }

contact_law::Dynamics::Options JKRWadaEngine::optionsFor(const std::vector<contact_law::Material>& materials) const
{
	Dynamics::Options options;
	options.pairs = pairOptions();
	options.neck = neck;
	options.domains = domains;
	options.threads = threadsOrYades();
	options.instructions = instructions;
	options.orientations = orientations;
	bool drag = linearDamping > 0;
	for (const auto& material : materials)
		drag = drag || material.viscoelasticTime > 0;
	options.mechanisms = contact_law::mechanismsOf(sliding, rolling, twisting, drag, springDamping > 0);
	options.limit = limitRuleOf(limit);
	return options;
}

// The grains of the scene, with contacts from the checkpoint, from O.interactions, or where they overlap.
std::shared_ptr<JKRWadaEngine::Run> JKRWadaEngine::newRun(bool again)
{
	SceneGrains grains(*scene);
	if (grains.size() == 0) refuseInEngine("there are no spheres");
	if (neck != 0 && grains.hasPlanes()) refuseInEngine(bondsOfPlanes);
	const auto materials = grains.materials();
	const bool continued = !savedState.empty();
	Dynamics::Options options = optionsFor(materials);
	options.dt = continued || again ? smallStep : scene->dt / subSteps;
	SceneContacts contacts;
	const contact_law::Inherited inherited = contacts.take(*scene, grains, options.mechanisms);
	for (const auto& one : inherited.contacts)
		if (one.neck > neck)
			refuseInEngine("O.interactions has sintered bonds of neck = " + text(one.neck) + ", and neck is " + text(neck)
			        + ": must be the largest neck they were made with");
	const ContactsHolder holder(*scene);
	if (!continued && holder.onlyInEngine()) refuseInEngine(ContactsHolder::refusal);
	const bool inherits = again || (!continued && !(inherited.contacts.empty() && inherited.onPlanes.empty()));
	const bool ofContacts = contacts.ofFunctors() || holder.isWritten();
	if (!continued && !again) SceneForces::dropThoseOfOtherEngines(*scene, grains, ofContacts);
	SceneCell cell;
	options.cell = cell.start(*scene, actsYet() ? Moment::WithinStep : Moment::BetweenSteps);
	options.convective = SceneCell::convective(*scene);
	options.planes = grains.planes();
	static std::atomic<int> runs { 0 };
	const auto started = [&](auto&&... from) {
		return std::shared_ptr<Run>(new Run { grains, contacts, cell, settings(),
		        inherits ? Dynamics::Onset::Before : Dynamics::Onset::Now, Dynamics(grains.grains(), materials, options, from...),
		        Omega::instance().getScene(), "JKRWadaEngine " + std::to_string(++runs) });
	};
	return continued ? started(savedState) : inherits ? started(inherited) : started();
}

void JKRWadaEngine::start(bool again)
{
	if (!again) actedAt = -1; // in another scene
	const bool continued = !savedState.empty();
	std::shared_ptr<Run> run;
	try {
		SceneForces::restorePermanent(*scene, savedForces);
		run = newRun(again);
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
		current->grains.setWritten(current->now, current->dynamics);
		if (isInOEnergy()) writeEnergies(current->dynamics.energies(), true); // it has them from before it was saved
	} else if (!again)
		booked = false;
	if (continued || run->onset == Dynamics::Onset::Before)
		current->watch.forget(); // losses may be below zero: what a script has changed, sinter()
	// that of the last step: one that was set since is taken by prepare(), or in the next step
	SceneCell::applyVelocityGradient(*scene, current->dynamics);
	savedState.clear(), savedForces.clear();
	ContactsHolder(*scene).set(current->name, false);
}

// ---- a scene that has changed: its contacts are exported, and the scene is read anew ----

void JKRWadaEngine::takeMoreBodies()
{
	const SceneGrains all(*scene); // refuses bodies that cannot be moved, while nothing is changed
	exportContacts();
	readAnew();
}

// To O.interactions, where whatever moves the grains from here on finds them, in the state of the bodies as this engine left them.
void JKRWadaEngine::exportContacts()
{
	if (EnergyChannels::areIn(*scene)) writeEnergies(current->dynamics.energies());
	const auto isThere = [this](int id) { return current->grains.hasBody(*scene, id); };
	current->contacts.write(*scene, current->dynamics, isThere);
	ContactsHolder(*scene).set(current->name, true);
}

// Another run of the scene, which goes on booking where this one ends. This one stays where that is refused.
void JKRWadaEngine::readAnew()
{
	const std::shared_ptr<Run> before = current;
	start(true);
	before->forces.withdraw(*scene);
	current->dynamics.continueFrom(contact_law::booked(before->dynamics));
	for (contact_law::OutsideForce force : before->outside) {
		force.grain = current->grains.grainOf(before->grains.idOf(force.grain));
		current->outside.push_back(force);
	}
	current->dynamics.setOutsideForces(current->outside, Dynamics::Onset::Before);
	current->onset = Dynamics::Onset::Now;
}

void JKRWadaEngine::leave()
{
	exportContacts();
	current->forces.withdraw(*scene);
	current.reset();
	ContactsHolder(*scene).clear();
}

// ---- whether it can be had ----

void JKRWadaEngine::requireSound(const Run& run)
{
	const Dynamics& dynamics = run.dynamics;
	refuseIfAny(SceneCell::tooSmall(dynamics.cell(), dynamics));
	requireStable(dynamics, dynamics.state().dt);
	const contact_law::Overlap deepest = contact_law::deepestOverlap(dynamics);
	if (deepest.overlap > 1)
		refuseInEngine(tooDeep(deepest.first, deepest.second, deepest.overlap) + " at the start: must be at most 1");
}

void JKRWadaEngine::requireStable(const Dynamics& dynamics, Real step)
{
	const double unstable = contact_law::unstableStep(dynamics);
	if (!(step > 0 && step < unstable)) refuseInEngine(tooLong("small step O.dt/subSteps", step, unstable));
}

// ---- checkpoints ----

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
	if (current->scene.lock() != saved) return savedState.clear(), savedForces.clear();
	scene = saved.get();
	try { // what cannot be taken in is refused by the next step, here or after loading
		if (current->grains.hasMore(*scene)) takeMoreBodies();
	} catch (const std::runtime_error&) {
	}
	// what is saved is that of the state that is saved: a script may have changed it, or not have asked for energies, since the last
	// step
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
