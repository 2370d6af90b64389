#include "JKRWadaSnapshot.hpp"
#include "JKRWada.hpp"
#include "JKRWadaEngine.hpp"
#include "RunningLoop.hpp"
#include <core/Body.hpp>
#include <core/Cell.hpp>
#include <core/Omega.hpp>
#include <core/State.hpp>
#include <pkg/common/Sphere.hpp>
#include <vector>

namespace yade {

YADE_PLUGIN((JKRWadaSnapshot));

namespace {
	struct Grains {
		std::vector<double> position, velocity, angularVelocity, radius;
		std::vector<int> ids, rowOf; // rowOf: by body id, -1 where the body is no sphere
	};

	template <class T> boost::python::object bytes(const std::vector<T>& values)
	{
		return boost::python::object(boost::python::handle<>(
		        PyBytes_FromStringAndSize(reinterpret_cast<const char*>(values.data()), Py_ssize_t(values.size() * sizeof(T)))));
	}

	void append(std::vector<double>& to, const Vector3r& v)
	{
		for (int i = 0; i < 3; ++i)
			to.push_back(v[i]);
	}

	/* NewtonIntegrator leaves positions a step, and velocities half a step, ahead of the forces: bring both to the moment of the forces. */
	// JKRWadaEngine leaves everything at one moment, and so needs nothing of this.
	void appendAtTimeOfForces(Grains& grains, const Body& body, Scene& scene)
	{
		const State& state = *body.state;
		const Vector3r force = scene.forces.getForce(body.getId()), torque = scene.forces.getTorque(body.getId());
		Vector3r velocity = state.vel, spin = state.angVel;
		for (int i = 0; i < 3; ++i) {
			if (!(state.blockedDOFs & (1u << i))) velocity[i] -= scene.dt / 2 * force[i] / state.mass;
			if (!(state.blockedDOFs & (8u << i))) spin[i] -= scene.dt / 2 * torque[i] / state.inertia[i];
		}
		append(grains.position, state.pos - scene.dt * state.vel);
		append(grains.velocity, velocity);
		append(grains.angularVelocity, spin);
	}

	const JKRWadaEngine* fusedEngine(const Scene& scene)
	{
		for (const auto& engine : scene.engines)
			if (const auto* fused = dynamic_cast<const JKRWadaEngine*>(engine.get())) return fused;
		return nullptr;
	}

	void appendAsItIs(Grains& grains, const Body& body)
	{
		append(grains.position, body.state->pos);
		append(grains.velocity, body.state->vel);
		append(grains.angularVelocity, body.state->angVel);
	}

	Grains readGrains(Scene& scene, bool asItIs)
	{
		Grains grains;
		grains.rowOf.assign(scene.bodies->size(), -1);
		scene.forces.sync();
		for (const auto& body : *scene.bodies) {
			if (!body) continue;
			const auto* sphere = dynamic_cast<const Sphere*>(body->shape.get());
			if (!sphere) continue;
			grains.rowOf[body->getId()] = int(grains.radius.size());
			grains.ids.push_back(body->getId());
			grains.radius.push_back(sphere->radius);
			if (asItIs)
				appendAsItIs(grains, *body);
			else
				appendAtTimeOfForces(grains, *body, scene);
		}
		return grains;
	}
}

boost::python::dict JKRWadaSnapshot::read() const
{
	requireLoopAtRest("contact_law.snapshot()");
	Scene& scene = *Omega::instance().getScene();
	const auto* fused = fusedEngine(scene);
	const auto rest = fused ? fused->atRest("contact_law.snapshot()") : std::unique_lock<std::mutex>();
	const Grains grains = readGrains(scene, fused);
	std::vector<int> pairs;
	std::vector<double> normalForce;
	std::vector<double> necks;
	const bool fromEngine = fused && fused->addContacts(pairs, normalForce, necks);
	for (const auto& interaction : *scene.interactions) {
		if (fromEngine) break;
		if (!interaction->isReal()) continue;
		const auto* phys = dynamic_cast<const JKRWadaPhys*>(interaction->phys.get());
		const auto* geometry = dynamic_cast<const GenericSpheresContact*>(interaction->geom.get());
		if (!phys || !geometry || !phys->touching) continue;
		pairs.push_back(grains.rowOf[interaction->getId1()]);
		pairs.push_back(grains.rowOf[interaction->getId2()]);
		normalForce.push_back(phys->normalForce.dot(geometry->normal));
		necks.push_back(phys->bonded ? phys->bond->neck : 0);
	}
	boost::python::dict result;
	result["time"] =
	        fromEngine && fused->inStep() ? scene.time + scene.dt : scene.time; // within a step the engine is at its end already
	result["ids"] = bytes(grains.ids);
	result["position"] = bytes(grains.position);
	result["velocity"] = bytes(grains.velocity);
	result["angular_velocity"] = bytes(grains.angularVelocity);
	result["radius"] = bytes(grains.radius);
	if (scene.isPeriodic) {
		std::vector<double> size;
		append(size, scene.cell->hSize.diagonal());
		result["cell_size"] = bytes(size);
	}
	result["contact_pairs"] = bytes(pairs);
	result["contact_normal_force"] = bytes(normalForce);
	result["contact_neck"] = bytes(necks);
	return result;
}

} // namespace yade
