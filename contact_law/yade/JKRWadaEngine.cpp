#include "JKRWadaEngine.hpp"
#include "../engine/dynamics.hpp"
#include "JKRWada.hpp"
#include <core/Body.hpp>
#include <core/Omega.hpp>
#include <core/State.hpp>
#include <pkg/common/Sphere.hpp>
#include <algorithm>
#include <stdexcept>

namespace yade {

using contact_law::Dynamics;
using contact_law::GrainInput;

YADE_PLUGIN((JKRWadaEngine));
CREATE_LOGGER(JKRWadaEngine);

struct JKRWadaEngine::Run {
	Dynamics                       dynamics;
	std::vector<GrainInput>        written, now; // the grains as the bodies were left; as they are after a step
	std::vector<shared_ptr<State>> states;  // of the bodies, to reach them quickly
};

namespace {
	[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error("JKRWadaEngine: " + what); }

	void copy(const Vector3r& from, double (&to)[3])
	{
		for (int k = 0; k < 3; ++k)
			to[k] = from[k];
	}

	GrainInput grainOf(const State& s)
	{
		GrainInput g {};
		copy(s.pos, g.position);
		copy(s.vel, g.velocity);
		copy(s.angVel, g.angularVelocity);
		g.mass    = s.mass;
		g.inertia = s.inertia[0];
		return g;
	}

	bool sameMotion(const State& s, const GrainInput& g)
	{
		const auto same = [](const Vector3r& x, const double(&y)[3]) { return x[0] == y[0] && x[1] == y[1] && x[2] == y[2]; };
		return same(s.pos, g.position) && same(s.vel, g.velocity) && same(s.angVel, g.angularVelocity);
	}

	struct SceneGrains {
		std::vector<GrainInput>             grains;
		std::vector<contact_law::Material> materials;
		std::vector<shared_ptr<State>>      states;
	};

	bool finite(const GrainInput& g)
	{
		const auto all = [](const double(&x)[3]) { return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]); };
		return all(g.position) && all(g.velocity) && all(g.angularVelocity);
	}

	SceneGrains read(const Scene& scene)
	{
		SceneGrains               result;
		std::vector<const JKRMat*> kinds;
		for (const auto& body : *scene.bodies) {
			const std::string who = "body " + std::to_string(body ? body->getId() : -1);
			if (!body) refuse("erased bodies are not supported: make the scene without them");
			const auto* sphere   = dynamic_cast<const Sphere*>(body->shape.get());
			const auto* material = dynamic_cast<const JKRMat*>(body->material.get());
			if (!sphere || !material) refuse(who + " is not a sphere of JKRMat; this engine moves nothing else");
			if (body->state->blockedDOFs) refuse(who + " has blocked degrees of freedom; use the functors for such scenes");
			GrainInput g = grainOf(*body->state);
			g.radius     = sphere->radius;
			if (!finite(g)) refuse(who + " has a position or velocity that is not a finite number");
			if (!(g.radius > 0) || !(g.mass > 0) || !(g.inertia > 0)) refuse(who + ": radius, mass and moment of inertia must be positive");
			const auto known = std::find(kinds.begin(), kinds.end(), material);
			g.kind           = int(known - kinds.begin());
			if (known == kinds.end()) {
				material->requireInRange();
				kinds.push_back(material);
				result.materials.push_back(material->forKernel());
			}
			result.grains.push_back(g);
			result.states.push_back(body->state);
		}
		return result;
	}
}

void JKRWadaEngine::start()
{
	if (scene->isPeriodic) refuse("periodic cells are not supported yet; use the functors");
	if (subSteps < 1) refuse("subSteps = " + std::to_string(subSteps) + ", allowed: 1 or more");
	const SceneGrains now = read(*scene);
	if (now.grains.empty()) refuse("there are no bodies");
	Dynamics::Options options;
	options.dt            = scene->dt / subSteps;
	options.linearDamping = linearDamping;
	options.domains       = domains;
	options.threads       = threads;
	options.instructions  = instructions;
	bool drag             = linearDamping > 0;
	for (const auto& material : now.materials)
		drag = drag || material.viscoelasticTime > 0;
	options.mechanisms = contact_law::mechanismsOf(sliding, rolling, twisting, drag);
	const bool continued = !memory.empty();
	if (continued) options.dt = smallStep;
	current   = std::shared_ptr<Run>(new Run { Dynamics(now.grains, now.materials, options, continued ? &memory : nullptr), now.grains, now.grains, now.states });
	smallStep = options.dt;
	const double unstable = current->dynamics.unstableStep();
	if (!(smallStep > 0 && smallStep < unstable)) {
		current.reset();
		refuse("the small step O.dt/subSteps is " + boost::lexical_cast<std::string>(smallStep) + " s, allowed: above 0 and below " + boost::lexical_cast<std::string>(unstable)
		       + " s, where every packing of these grains is unstable (dense ones, and drag, want less)");
	}
	if (continued && scene->trackEnergy) writeEnergies(true);
	memory.clear();
}

// Bodies that a script moved or pushed since the last step.
void JKRWadaEngine::takeChanges()
{
	if (scene->bodies->size() != current->written.size()) refuse("bodies were added or erased after the start; make a new engine");
	for (std::size_t k = 0; k < current->written.size(); ++k) {
		if (sameMotion(*current->states[k], current->written[k])) continue;
		const GrainInput now = grainOf(*current->states[k]);
		if (!finite(now)) refuse("body " + std::to_string(k) + " was given a position or velocity that is not a finite number");
		current->dynamics.set(int(k), now);
	}
}

void JKRWadaEngine::action()
{
	if (!current) start();
	else takeChanges();
	if (scene->dt / subSteps != smallStep) refuse("O.dt or subSteps changed after the start; make a new engine");
	current->dynamics.setThreads(threads);
	current->dynamics.run(subSteps);
	writeBodies();
	if (scene->trackEnergy) writeEnergies(false);
	actedAt = scene->iter;
}

void JKRWadaEngine::prepare()
{
	scene = Omega::instance().getScene().get();
	if (!current) start();
	if (scene->trackEnergy) writeEnergies(false);
}

void JKRWadaEngine::writeBodies()
{
	std::vector<GrainInput>& now = current->now;
	current->dynamics.read(now);
	for (std::size_t k = 0; k < now.size(); ++k)
		if (!finite(now[k])) // before anything is written: the bodies keep the last good state
			refuse("the run went wrong at t = " + boost::lexical_cast<std::string>(scene->time + scene->dt) + " s: body " + std::to_string(k)
			       + " has no finite position or velocity any more; O.bodies hold the state of t = " + boost::lexical_cast<std::string>(scene->time) + " s. A smaller step may help");
#pragma omp parallel for num_threads(current->dynamics.threadCount())
	for (std::size_t k = 0; k < now.size(); ++k) {
		State& s = *current->states[k];
		s.pos    = Vector3r(now[k].position[0], now[k].position[1], now[k].position[2]);
		s.vel    = Vector3r(now[k].velocity[0], now[k].velocity[1], now[k].velocity[2]);
		s.angVel = Vector3r(now[k].angularVelocity[0], now[k].angularVelocity[1], now[k].angularVelocity[2]);
	}
	current->written.swap(now);
}

void JKRWadaEngine::writeEnergies(bool known)
{
	const contact_law::Energies     now = current->dynamics.energies();
	const contact_law::Dissipation& d   = now.dissipated;
	channels.set(*scene, { now.kinetic, now.stored.normal, now.stored.sliding, now.stored.rolling, now.stored.twisting, d.sliding, d.rolling, d.twisting, d.connection, d.disconnection, d.drag }, known);
}

void JKRWadaEngine::preSave(JKRWadaEngine&) { memory = current ? current->dynamics.remember() : std::vector<Real>(); }

bool JKRWadaEngine::addContacts(std::vector<int>& pairs, std::vector<double>& normalForces) const
{
	if (!current) return false;
	current->dynamics.eachContact([&](const contact_law::Contact& contact, int first, int second, double normalForce) {
		(void)contact;
		pairs.push_back(first);
		pairs.push_back(second);
		normalForces.push_back(normalForce);
	});
	return true;
}

boost::python::dict JKRWadaEngine::statistics() const
{
	boost::python::dict result;
	if (!current) return result;
	result["contacts"]       = current->dynamics.contactCount();
	result["contactUpdates"] = current->dynamics.contactUpdates;
	result["events"]         = current->dynamics.events();
	result["farRebuilds"]    = current->dynamics.farRebuilds;
	result["nearRebuilds"]   = current->dynamics.nearRebuilds;
	result["instructions"]   = current->dynamics.instructions();
	return result;
}

} // namespace yade
