#include "JKRWadaSnapshot.hpp"
#include "JKRWada.hpp"
#include "JKRWadaEngine.hpp"
#include "RunningLoop.hpp"
#include "SceneShapes.hpp"
#include <core/Body.hpp>
#include <core/Omega.hpp>
#include <pkg/common/Sphere.hpp>
#include <algorithm>
#include <vector>

namespace yade {

YADE_PLUGIN((JKRWadaSnapshot));

using contact_law::NormalForces;

namespace {
	// Numbers that Python reads and may change.
	template <class T> struct Column {
		boost::python::object bytes;
		explicit Column(std::size_t size)
		        : bytes(boost::python::handle<>(PyByteArray_FromStringAndSize(nullptr, Py_ssize_t(size * sizeof(T)))))
		{
		}
		explicit Column(const std::vector<T>& values)
		        : Column(values.size())
		{
			std::copy(values.begin(), values.end(), data());
		}
		T* data() { return reinterpret_cast<T*>(PyByteArray_AS_STRING(bytes.ptr())); }
	};

	struct Grains {
		std::vector<double> position, velocity, angularVelocity, radius;
		std::vector<int> ids, rowOf; // rowOf: by body id, -1 where the body is no sphere
	};

	void append(std::vector<double>& to, const Vector3r& v)
	{
		for (int i = 0; i < 3; ++i)
			to.push_back(v[i]);
	}

	/* NewtonIntegrator leaves positions a step, and velocities half a step, ahead of the forces: bring both to the moment of the forces. */
	// JKRWadaEngine leaves everything at one moment, and a scene before its first step has it so.
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

	// That moves the grains; otherwise a dead one that has the contacts.
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

	bool isOfOneMoment(const Scene& scene)
	{
		const auto current = [](const shared_ptr<Interaction>& interaction) {
			const auto* phys = interaction->isReal() ? dynamic_cast<const JKRWadaPhys*>(interaction->phys.get()) : nullptr;
			return phys && phys->current;
		};
		const auto real = [](const shared_ptr<Interaction>& interaction) { return interaction->isReal(); };
		const auto any = [&](const auto& is) { return std::any_of(scene.interactions->begin(), scene.interactions->end(), is); };
		const bool notBegun = scene.iter == 0 && scene.subStep < 0 && !any(real);
		return notBegun || any(current);
	}

	struct Planes {
		std::vector<int> axis, ofId; // ofId: by body id, -1 where the body is no Wall
		std::vector<double> position;
	};
	Planes readPlanes(const Scene& scene, bool asItIs)
	{
		Planes planes;
		planes.ofId.assign(scene.bodies->size(), -1);
		for (const auto& body : *scene.bodies) {
			const Wall* wall = body ? wallOf(*body) : nullptr;
			if (!wall) continue;
			planes.ofId[body->getId()] = int(planes.axis.size());
			planes.axis.push_back(wall->axis);
			planes.position.push_back((body->state->pos - (asItIs ? 0 : scene.dt) * body->state->vel)[wall->axis]);
		}
		return planes;
	}

	struct GrainColumns {
		Column<int> ids;
		Column<double> position, velocity, angularVelocity, radius;
	};
	GrainColumns columnsOf(const Grains& grains)
	{
		return { Column(grains.ids), Column(grains.position), Column(grains.velocity), Column(grains.angularVelocity),
			Column(grains.radius) };
	}
	GrainColumns columnsOf(const JKRWadaEngine& fused)
	{
		const std::size_t count = fused.bodyCount();
		GrainColumns all { Column<int>(count), Column<double>(3 * count), Column<double>(3 * count), Column<double>(3 * count),
			Column<double>(count) };
		fused.readBodies(
		        { all.ids.data(), all.position.data(), all.velocity.data(), all.angularVelocity.data(), all.radius.data() });
		return all;
	}

	void putGrains(boost::python::dict& result, const GrainColumns& all)
	{
		result["ids"] = all.ids.bytes;
		result["position"] = all.position.bytes;
		result["velocity"] = all.velocity.bytes;
		result["angular_velocity"] = all.angularVelocity.bytes;
		result["radius"] = all.radius.bytes;
	}

	template <class T> boost::python::object joined(const std::vector<NormalForces>& parts, std::vector<T> NormalForces::*member)
	{
		std::size_t size = 0;
		for (const NormalForces& part : parts)
			size += (part.*member).size();
		Column<T> all(size);
		T* to = all.data();
		for (const NormalForces& part : parts)
			to = std::copy((part.*member).begin(), (part.*member).end(), to);
		return all.bytes;
	}

	void putPlanes(boost::python::dict& result, const Planes& planes, const NormalForces& contacts)
	{
		if (planes.axis.empty()) return;
		result["plane_axis"] = Column(planes.axis).bytes;
		result["plane_position"] = Column(planes.position).bytes;
		result["plane_contacts"] = Column(contacts.grains).bytes;
		result["plane_contact_normal_force"] = Column(contacts.forces).bytes;
	}

	void putContacts(boost::python::dict& result, const std::vector<NormalForces>& parts)
	{
		result["contact_pairs"] = joined(parts, &NormalForces::grains);
		result["contact_normal_force"] = joined(parts, &NormalForces::forces);
		result["contact_neck"] = joined(parts, &NormalForces::necks);
	}

	// Between grains, and of grains on planes.
	void readContacts(const Scene& scene, const Grains& grains, const Planes& planes, NormalForces& between, NormalForces& onPlanes)
	{
		for (const auto& interaction : *scene.interactions) {
			if (!interaction->isReal()) continue;
			const auto* phys = dynamic_cast<const JKRWadaPhys*>(interaction->phys.get());
			const auto* geometry = dynamic_cast<const GenericSpheresContact*>(interaction->geom.get());
			if (!phys || !geometry || !phys->touching) continue;
			const int id1 = interaction->getId1(), id2 = interaction->getId2(), plane = planes.ofId[id1];
			NormalForces& found = plane < 0 ? between : onPlanes;
			found.grains.push_back(grains.rowOf[plane < 0 ? id1 : id2]);
			found.grains.push_back(plane < 0 ? grains.rowOf[id2] : plane);
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
	boost::python::dict result;
	result["time"] = scene.time;
	if (fused && fused->hasStarted()) {
		if (fused->inStep()) result["time"] = scene.time + scene.dt; // within a step the engine is at its end already
		putGrains(result, columnsOf(*fused));
		putContacts(result, fused->normalForces());
		putPlanes(result, readPlanes(scene, true), fused->normalForcesOnPlanes());
	} else {
		const bool asItIs = fused || isOfOneMoment(scene);
		if (!asItIs && scene.subStep < 0)
			result["time"] = scene.time - scene.dt; // the step is over: the forces' moment was before it
		const Grains grains = readGrains(scene, asItIs);
		const Planes planes = readPlanes(scene, asItIs);
		NormalForces between, onPlanes;
		readContacts(scene, grains, planes, between, onPlanes);
		putGrains(result, columnsOf(grains));
		putContacts(result, { between });
		putPlanes(result, planes, onPlanes);
	}
	if (scene.isPeriodic) {
		std::vector<double> size;
		append(size, scene.cell->hSize.diagonal());
		result["cell_size"] = Column(size).bytes;
	}
	return result;
}

} // namespace yade
