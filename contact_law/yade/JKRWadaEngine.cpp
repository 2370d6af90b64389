#include "JKRWadaEngine.hpp"
#include "JKRWada.hpp"
#include "LedgerWatch.hpp"
#include "SceneCell.hpp"
#include "SceneContacts.hpp"
#include "SceneGrains.hpp"
#include <core/Body.hpp>
#include <core/Omega.hpp>
#include <core/State.hpp>

namespace yade {

using contact_law::Dynamics;
using contact_law::GrainInput;

YADE_PLUGIN((JKRWadaEngine));
CREATE_LOGGER(JKRWadaEngine);

struct JKRWadaEngine::Run {
	Dynamics dynamics;
	std::vector<GrainInput> written, now;  // the grains as the bodies were left; as they are after a step
	std::vector<shared_ptr<State>> states; // of the bodies, to reach them quickly
	bool orientations, constrained;
	SceneContacts contacts;
	SceneCell cell;
	LedgerWatch watch {};
	long unlooked = 0; // small steps since overlaps were looked through

	// Whether it is so for every body; asked by all threads, since reading every body takes about a small step.
	template <class Is> bool all(const Is& is) const
	{
		bool so = true;
#pragma omp parallel for num_threads(dynamics.threadCount()) reduction(&& : so)
		for (std::size_t k = 0; k < written.size(); ++k)
			so = so && is(k);
		return so;
	}
};

namespace {
	constexpr long stepsBetweenLooks = 30; // looking through the overlaps takes about half a small step

	std::string text(Real number) { return boost::lexical_cast<std::string>(number); }
	std::string rounded(Real number)
	{
		char digits[32];
		std::snprintf(digits, sizeof digits, "%.4g", double(number));
		return digits;
	}

	std::string pairOf(const Dynamics::Trouble& t)
	{
		return "body " + std::to_string(t.grain) + " and body " + std::to_string(t.other);
	}
	std::string describe(const Dynamics::Trouble& t)
	{
		return " (overlap " + rounded(t.overlap) + " of the smaller radius, normal force " + rounded(t.force) + " N)";
	}
	std::string hardestContact(const Dynamics::Trouble& t)
	{
		if (t.other < 0) return "; it touches no other";
		return "; its hardest contact is with body " + std::to_string(t.other) + describe(t);
	}

	void requireAlone(const Scene& scene)
	{
		for (const auto& engine : scene.engines)
			for (const char* other : { "NewtonIntegrator", "InteractionLoop" })
				if (!engine->dead && engine->getClassName() == other)
					refuseInEngine(std::string(other) + " is among O.engines too; this engine replaces it");
	}
}

contact_law::Dynamics::Options JKRWadaEngine::optionsFor(const std::vector<contact_law::Material>& materials) const
{
	Dynamics::Options options;
	options.dt = scene->dt / subSteps;
	options.linearDamping = linearDamping;
	options.neck = neck;
	options.domains = domains;
	options.threads = threads;
	options.instructions = instructions;
	options.orientations = orientations;
	bool drag = linearDamping > 0;
	for (const auto& material : materials)
		drag = drag || material.viscoelasticTime > 0;
	options.mechanisms = contact_law::mechanismsOf(sliding, rolling, twisting, drag);
	return options;
}

void JKRWadaEngine::start(bool inStep)
{
	if (!failure.empty()) refuseInEngine(failure);
	if (subSteps < 1) refuseInEngine("subSteps = " + std::to_string(subSteps) + ", allowed: 1 or more");
	if (neck != 0 && !(neck > 0 && neck <= contact_law::largestNeck))
		refuseInEngine("neck = " + text(neck) + ", allowed: 0 (no bonds), or up to 0.7 for sintered bonds");
	if (neck != 0 && scene->isPeriodic)
		refuseInEngine(
		        "neck = " + text(neck) + " in a periodic cell, allowed: 0; sintered bonds in periodic cells are the functors'");
	requireAlone(*scene);
	const SceneGrains now = readGrains(*scene);
	if (now.grains.empty()) refuseInEngine("there are no bodies");
	Dynamics::Options options = optionsFor(now.materials);
	const bool continued = !memory.empty();
	if (continued) options.dt = smallStep;
	SceneContacts contacts;
	const contact_law::Inherited inherited = contacts.take(*scene, options.dt);
	for (const auto& one : inherited.contacts)
		if (one.bonded && neck == 0)
			refuseInEngine("O.interactions has sintered bonds, and neck is 0; allowed: the neck they were made with");
	const bool inherits = !continued && !inherited.contacts.empty();
	SceneCell cell;
	options.cell = cell.start(*scene, inStep, inherits && inherited.stepBehind, options.dt);
	options.convective = SceneCell::convective(*scene);
	current = std::shared_ptr<Run>(
	        new Run { Dynamics(now.grains, now.materials, options, continued ? &memory : nullptr, inherits ? &inherited : nullptr),
	                now.grains, now.grains, now.states, orientations, false, contacts, cell });
	smallStep = options.dt;
	try {
		const std::string tooSmall = SceneCell::tooSmall(options.cell, current->dynamics);
		if (!tooSmall.empty()) refuseInEngine(tooSmall);
		requireStable();
	} catch (...) {
		current.reset();
		throw;
	}
	SceneCell::takeVelocityGradient(*scene, current->dynamics, !inStep);
	if (scene->trackEnergy) {
		if (continued)
			writeEnergies(current->dynamics.energies(), true);
		else
			channels.takeOver(*scene);
	}
	memory.clear();
}

void JKRWadaEngine::requireStable() const
{
	const double unstable = current->dynamics.unstableStep();
	if (!(smallStep > 0 && smallStep < unstable))
		refuseInEngine("the small step O.dt/subSteps is " + text(smallStep) + " s, allowed: above 0 and below " + text(unstable)
		        + " s, where every packing of these grains is unstable (dense ones, and drag, want less)");
	const Dynamics::Trouble deep = current->dynamics.tooDeep();
	if (deep.grain >= 0)
		refuseInEngine(
		        pairOf(deep) + " overlap by " + rounded(deep.overlap) + " of the smaller radius at the start, allowed: at most 1");
}

// Bodies that a script moved, pushed or blocked since the last step.
void JKRWadaEngine::takeChanges()
{
	if (scene->bodies->size() != current->written.size())
		refuseInEngine("bodies were added or erased after the start; make a new engine");
	if (orientations != current->orientations) refuseInEngine("orientations was changed after the start; make a new engine");
	const auto same = [this](std::size_t k) { return sameMotion(*current->states[k], current->written[k], orientations); };
	if (current->all(same)) return;
	for (std::size_t k = 0; k < current->written.size(); ++k) {
		if (same(k)) continue;
		const GrainInput now = grainOf(*current->states[k]);
		if (!finite(now))
			refuseInEngine("body " + std::to_string(k) + " was given a position or velocity that is not a finite number");
		current->dynamics.set(int(k), now);
		current->watch.forgetSum();
		current->unlooked = stepsBetweenLooks;
	}
}

void JKRWadaEngine::action()
{
	if (!current)
		start(true);
	else
		takeChanges();
	current->cell.require(*scene, current->dynamics);
	if (scene->dt / subSteps != smallStep) refuseInEngine("O.dt or subSteps changed after the start; make a new engine");
	const std::string wrong = current->cell.wrong(*scene, current->dynamics, subSteps);
	if (!wrong.empty()) fail(scene->time + scene->dt, wrong, "");
	current->dynamics.setThreads(threads);
	const contact_law::Vec3<double> cellAtEnd = SceneCell::now(*scene);
	const long made = current->dynamics.run(subSteps, scene->isPeriodic ? &cellAtEnd : nullptr);
	current->cell.arrive(*scene);
	SceneCell::takeVelocityGradient(*scene, current->dynamics, true);
	current->dynamics.read(current->now);
	contact_law::Energies energies;
	if (scene->trackEnergy) energies = current->dynamics.energies();
	requireSound(made, scene->trackEnergy ? &energies : nullptr);
	writeBodies();
	if (exportInteractions)
		current->contacts.write(*scene, current->dynamics, true);
	else
		current->contacts.withdraw(*scene);
	if (scene->trackEnergy) writeEnergies(energies, false);
	actedAt = scene->iter;
}

// Before anything is written: the bodies keep the last good state. `now`: the energies, or null when nobody asks for them.
void JKRWadaEngine::requireSound(long made, const contact_law::Energies* now)
{
	Dynamics::Trouble trouble;
	if (made < subSteps) trouble = current->dynamics.trouble();
	const auto isFinite = [this](std::size_t k) { return finite(current->now[k]); };
	const bool allFinite = current->all(isFinite);
	for (std::size_t k = 0; !allFinite && trouble.grain < 0 && k < current->now.size(); ++k)
		if (!isFinite(k)) trouble = current->dynamics.trouble(int(k));
	const Real time = scene->time + std::min(made + 1, long(subSteps)) * smallStep;
	if (trouble.grain >= 0) {
		const std::string grain = "body " + std::to_string(trouble.grain);
		if (!std::isfinite(trouble.speed))
			fail(time, grain + " has no finite position or velocity any more" + hardestContact(trouble));
		fail(time,
		        grain + " moves at " + rounded(trouble.speed) + " m/s, more than half the smallest radius in a small step"
		                + hardestContact(trouble));
	}
	current->unlooked += made;
	if (current->unlooked >= stepsBetweenLooks) {
		current->unlooked = 0;
		trouble = current->dynamics.tooDeep();
	}
	if (trouble.grain >= 0) fail(time, pairOf(trouble) + " overlap by " + rounded(trouble.overlap) + " of the smaller radius");
	const auto& c = current->dynamics.commonConstants();
	const std::string wrong = now ? current->watch.wrong(*now, c.pullOffForce * c.pullOffOverlap) : "";
	if (wrong.empty()) return;
	const Dynamics::Trouble fastest = current->dynamics.trouble(), hardest = current->dynamics.hardest();
	fail(time,
	        wrong + "; body " + std::to_string(fastest.grain) + " is the fastest (" + rounded(fastest.speed) + " m/s)"
	                + (hardest.grain < 0 ? ", and none touch any more"
	                                     : ", the hardest contact is that of " + pairOf(hardest) + describe(hardest)));
}

void JKRWadaEngine::fail(Real time, const std::string& what, const char* advice)
{
	failure = "the run went wrong at t = " + text(time) + " s: " + what
	        + "; O.bodies hold the last good state, of t = " + text(scene->time) + " s" + advice;
	current.reset();
	refuseInEngine(failure);
}

void JKRWadaEngine::prepare()
{
	scene = Omega::instance().getScene().get();
	if (!current)
		start(false);
	else
		SceneCell::takeVelocityGradient(*scene, current->dynamics, true);
	if (scene->isPeriodic) { // the mean velocity field is in the grains' velocities now
		current->dynamics.read(current->now);
		writeBodies();
	}
	if (exportInteractions) current->contacts.write(*scene, current->dynamics, true);
	if (scene->trackEnergy) writeEnergies(current->dynamics.energies(), false);
}

void JKRWadaEngine::writeInteractions()
{
	scene = Omega::instance().getScene().get();
	if (!current) start(false);
	current->contacts.write(*scene, current->dynamics, true);
}

void JKRWadaEngine::handOver()
{
	scene = Omega::instance().getScene().get();
	if (!current) refuseInEngine("handOver() before the first step: there is nothing to hand over");
	if (inStep()) refuseInEngine("handOver() within an O.step: call it between two");
	takeChanges();
	current->contacts.write(*scene, current->dynamics, false); // with the orientations that go with it
	for (std::size_t k = 0; k < current->now.size(); ++k)
		current->now[k].orientation = grainOf(*current->states[k]).orientation;
	current->dynamics.readAhead(current->now);
	current->orientations = true; // functors turn the pointers with their bodies
	writeBodies();
	scene->time += smallStep;
	scene->iter += 1;
	scene->dt = smallStep;
	current.reset();
}

void JKRWadaEngine::writeBodies()
{
	const std::vector<GrainInput>& now = current->now;
#pragma omp parallel for num_threads(current->dynamics.threadCount())
	for (std::size_t k = 0; k < now.size(); ++k)
		write(now[k], *current->states[k], current->orientations);
	current->written.swap(current->now);
}

void JKRWadaEngine::writeEnergies(const contact_law::Energies& now, bool known)
{
	current->constrained = current->constrained || current->dynamics.constrained();
	channels.set(*scene, now, known, current->constrained);
}

void JKRWadaEngine::preSave(JKRWadaEngine&) { memory = current ? current->dynamics.remember() : std::vector<Real>(); }

bool JKRWadaEngine::addContacts(std::vector<int>& pairs, std::vector<double>& normalForces, std::vector<int>& bonded) const
{
	if (!current) return false;
	const auto add = [&](int first, int second, double normalForce, bool isBond) {
		pairs.push_back(first);
		pairs.push_back(second);
		normalForces.push_back(normalForce);
		bonded.push_back(isBond);
	};
	current->dynamics.eachContact(
	        [&](const contact_law::Contact&, int first, int second, double force) { add(first, second, force, false); });
	current->dynamics.eachBond([&](const contact_law::Bond&, int first, int second, double force) { add(first, second, force, true); });
	return true;
}

boost::python::dict JKRWadaEngine::statistics() const
{
	boost::python::dict result;
	if (!current) return result;
	result["contacts"] = current->dynamics.contactCount();
	result["bonds"] = current->dynamics.bondCount();
	const auto broken = current->dynamics.brokenBonds();
	const contact_law::Dissipation lost = current->dynamics.dissipated();
	static const char* const modes[contact_law::bondModes] = { "brokenByStretching", "brokenBySliding", "brokenByRolling",
		"brokenByTwisting" };
	for (int mode = 0; mode < contact_law::bondModes; ++mode) {
		result[modes[mode]] = broken[mode];
		result[modes[mode] + std::string("Energy")] = lost.*contact_law::bondBreakingBy[mode];
	}
	result["contactUpdates"] = current->dynamics.contactUpdates;
	result["events"] = current->dynamics.events();
	result["farRebuilds"] = current->dynamics.farRebuilds;
	result["nearRebuilds"] = current->dynamics.nearRebuilds;
	result["instructions"] = current->dynamics.instructions();
	return result;
}

} // namespace yade
