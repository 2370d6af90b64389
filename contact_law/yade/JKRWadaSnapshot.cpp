#include "JKRWadaEngine.hpp"
#include "Refusal.hpp"
#include "SceneShapes.hpp"
#include <algorithm>
#include <vector>

namespace yade {

YADE_PLUGIN((JKRWadaSnapshot));

using contact_law::NormalForces;

namespace {
	// Numbers that Python reads and may change.
	template <class T> boost::python::object column(const std::vector<T>& values)
	{
		const char* bytes = reinterpret_cast<const char*>(values.data());
		return boost::python::object(
		        boost::python::handle<>(PyByteArray_FromStringAndSize(bytes, Py_ssize_t(values.size() * sizeof(T)))));
	}

	void append(std::vector<double>& to, const Vector3r& v) { to.insert(to.end(), { v[0], v[1], v[2] }); }

	// The JKRWadaEngine that moves the grains; otherwise a dead one that has the contacts.
	const JKRWadaEngine* fusedEngine(Scene& scene)
	{
		const JKRWadaEngine* dead = nullptr;
		for (const auto& engine : scene.engines) {
			const auto* fused = dynamic_cast<const JKRWadaEngine*>(engine.get());
			if (fused && !fused->dead) return fused;
			if (fused && fused->holdsContacts(scene)) dead = fused;
		}
		return dead;
	}

	struct Grains {
		std::vector<int> ids;
		std::vector<double> position, velocity, angularVelocity, radius;
	};

	/* asItIs: everything is of one moment. Otherwise NewtonIntegrator has left positions a step, and velocities half a step, ahead
	 * of the forces: both are brought to the moment of the forces. */
	Grains grainsOf(Scene& scene, bool asItIs)
	{
		Grains grains;
		scene.forces.sync();
		for (const auto& body : *scene.bodies) {
			const auto* sphere = body ? dynamic_cast<const Sphere*>(body->shape.get()) : nullptr;
			if (!sphere) continue;
			const State& state = *body->state;
			Vector3r position = state.pos, velocity = state.vel, spin = state.angVel;
			if (!asItIs) {
				const Vector3r force = scene.forces.getForce(body->getId()), torque = scene.forces.getTorque(body->getId());
				position -= scene.dt * state.vel;
				for (int i = 0; i < 3; ++i) {
					if (!(state.blockedDOFs & (1u << i))) velocity[i] -= scene.dt / 2 * force[i] / state.mass;
					if (!(state.blockedDOFs & (8u << i))) spin[i] -= scene.dt / 2 * torque[i] / state.inertia[i];
				}
			}
			grains.ids.push_back(int(body->getId()));
			append(grains.position, position);
			append(grains.velocity, velocity);
			append(grains.angularVelocity, spin);
			grains.radius.push_back(sphere->radius);
		}
		return grains;
	}

	struct Planes {
		std::vector<int> axis, ids;
		std::vector<double> position;

		Planes(const Scene& scene, bool asItIs)
		{
			for (const auto& body : *scene.bodies) {
				const Wall* wall = body ? wallOf(*body) : nullptr;
				if (!wall) continue;
				ids.push_back(int(body->getId()));
				axis.push_back(wall->axis);
				position.push_back((body->state->pos - (asItIs ? 0 : scene.dt) * body->state->vel)[wall->axis]);
			}
		}
	};

	int rowOf(const std::vector<int>& ids, int id) { return int(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin()); }

	bool isOfOneMoment(const Scene& scene)
	{
		bool anyReal = false;
		for (const auto& interaction : *scene.interactions) {
			if (!interaction->isReal()) continue;
			anyReal = true;
			const auto* phys = dynamic_cast<const JKRWadaPhys*>(interaction->phys.get());
			if (phys && phys->current) return true; // JKRWadaEngine has left it
		}
		return scene.iter == 0 && scene.subStep < 0 && !anyReal; // before the first step
	}

	// Between grains, and of grains on planes.
	void readContacts(const Scene& scene, const Grains& grains, const Planes& planes, NormalForces& between, NormalForces& onPlanes)
	{
		for (const auto& interaction : *scene.interactions) {
			if (!interaction->isReal()) continue;
			const auto* phys = dynamic_cast<const JKRWadaPhys*>(interaction->phys.get());
			const auto* geometry = dynamic_cast<const GenericSpheresContact*>(interaction->geom.get());
			if (!phys || !geometry || !phys->touching) continue;
			const int id1 = interaction->getId1(), row2 = rowOf(grains.ids, interaction->getId2());
			const bool onPlane = wallOf(scene, id1);
			NormalForces& found = onPlane ? onPlanes : between;
			if (onPlane)
				found.grains.insert(found.grains.end(), { row2, rowOf(planes.ids, id1) });
			else
				found.grains.insert(found.grains.end(), { rowOf(grains.ids, id1), row2 });
			found.forces.push_back(phys->normalForce.dot(geometry->normal));
			found.necks.push_back(phys->bonded ? phys->bond->neck : 0);
		}
	}

}

boost::python::dict JKRWadaSnapshot::read() const
{
	requireLoopAtRest("contact_law.snapshot()");
	Scene& scene = *Omega::instance().getScene();
	const auto* fused = fusedEngine(scene);
	const auto rest = fused ? fused->atRest("contact_law.snapshot()") : std::unique_lock<std::mutex>();
	const contact_law::Dynamics* dynamics = fused ? fused->dynamics() : nullptr;
	const bool asItIs = fused || isOfOneMoment(scene);
	boost::python::dict result;
	result["time"] = scene.time;
	// within a step the fused engine is at its end already; after one the moment of the functors' forces was before it
	if (dynamics && fused->inStep()) result["time"] = scene.time + scene.dt;
	if (!asItIs && scene.subStep < 0) result["time"] = scene.time - scene.dt;
	const Grains grains = grainsOf(scene, asItIs);
	const Planes planes(scene, asItIs);
	NormalForces contacts, onPlanes;
	if (dynamics)
		contacts = contact_law::normalForces(*dynamics), onPlanes = contact_law::normalForcesOnPlanes(*dynamics);
	else
		readContacts(scene, grains, planes, contacts, onPlanes);
	result["ids"] = column(grains.ids);
	result["position"] = column(grains.position);
	result["velocity"] = column(grains.velocity);
	result["angular_velocity"] = column(grains.angularVelocity);
	result["radius"] = column(grains.radius);
	result["contact_pairs"] = column(contacts.grains);
	result["contact_normal_force"] = column(contacts.forces);
	result["contact_neck"] = column(contacts.necks);
	if (!planes.ids.empty()) {
		result["plane_axis"] = column(planes.axis);
		result["plane_position"] = column(planes.position);
		result["plane_contacts"] = column(onPlanes.grains);
		result["plane_contact_normal_force"] = column(onPlanes.forces);
	}
	if (scene.isPeriodic) {
		std::vector<double> size;
		append(size, scene.cell->hSize.diagonal());
		result["cell_size"] = column(size);
	}
	return result;
}

} // namespace yade
