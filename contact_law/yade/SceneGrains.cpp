#include "SceneGrains.hpp"
#include "../engine/contacts.hpp"
#include "SceneShapes.hpp"
#include <algorithm>

namespace yade {

using contact_law::GrainInput;
using contact_law::GrainMotion;

namespace {
	GrainMotion motionOf(const State& s)
	{
		return { toKernel(s.pos), toKernel(s.vel), toKernel(s.angVel), s.blockedDOFs,
			{ s.ori.w(), s.ori.x(), s.ori.y(), s.ori.z() } };
	}

	bool sameMotion(const State& s, const GrainMotion& g, bool orientations)
	{
		const contact_law::Orientation& q = g.orientation;
		if (orientations && !(s.ori.w() == q.w && s.ori.x() == q.x && s.ori.y() == q.y && s.ori.z() == q.z)) return false;
		return toKernel(s.pos) == g.position && toKernel(s.vel) == g.velocity && toKernel(s.angVel) == g.angularVelocity
		        && s.blockedDOFs == g.blocked;
	}

	shared_ptr<JKRMat> requireOfLaw(const Scene& scene, const shared_ptr<Body>& body, const Body& first)
	{
		const std::string who = bodyName(body->getId());
		const auto material = boost::dynamic_pointer_cast<JKRMat>(body->material);
		if (!material) refuseInEngine(who + " must be a sphere or a Wall of JKRMat; this engine moves nothing else");
		refuseIfAny(faultOf(*body, scene, InPeriodic::AtRest));
		if (!body->isBounded() || body->groupMask == 0)
			refuseInEngine(who + " must be bounded, with a mask other than 0: all bodies meet all others");
		if (body->groupMask != first.groupMask)
			refuseInEngine(who + ": mask = " + text(body->groupMask) + ", must be " + text(first.groupMask) + " as "
			        + bodyName(first.getId()) + "'s: all bodies meet all others");
		return material;
	}

	void requireFinite(const Body& wall)
	{
		if (!wall.state->pos.allFinite() || !wall.state->vel.allFinite())
			refuseInEngine(bodyName(wall.getId()) + ", a Wall, has a position or velocity that is not a finite number");
	}

	bool isotropic(const Vector3r& inertia) { return inertia[0] == inertia[1] && inertia[1] == inertia[2]; }
}

bool finite(const GrainMotion& g)
{
	const auto all = [](const contact_law::Vec3<double>& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
	const contact_law::Orientation& q = g.orientation;
	return all(g.position) && all(g.velocity) && all(g.angularVelocity) && std::isfinite(q.w + q.x + q.y + q.z);
}

// ---- at the start ----

SceneGrains::Grain::Grain(const shared_ptr<Body>& body, int kind)
        : Kept { body, kind }
{
	const std::string who = bodyName(id);
	if (!finite(motionOf(*state))) refuseInEngine(who + " has a position, orientation or velocity that is not a finite number");
	if (!(radius > 0 && mass > 0 && state->inertia.minCoeff() > 0))
		refuseInEngine(who + ": radius, mass and moments of inertia must be > 0");
	if (!isotropic(state->inertia)) refuseInEngine(who + ": its three moments of inertia must be the same, those of a sphere");
}

std::size_t SceneGrains::endOfIds(const Scene& scene)
{
	std::size_t end = scene.bodies->size();
	while (end > 0 && !(*scene.bodies)[int(end) - 1])
		--end;
	return end;
}

SceneGrains::SceneGrains(const Scene& scene)
{
	const int end = int(endOfIds(scene));
	bodies.reserve(end);
	grainOfId.assign(end, -1);
	const Body* first = nullptr;
	for (int id = 0; id < end; ++id) {
		const shared_ptr<Body>& body = (*scene.bodies)[id];
		if (!body) {
			erased.push_back(id);
			continue;
		}
		if (!first) first = body.get();
		const shared_ptr<JKRMat> material = requireOfLaw(scene, body, *first);
		if (const Wall* wall = wallOf(*body)) {
			requireFinite(*body);
			walls.push_back({ { body, kindOf(material) }, wall->axis, body->state->pos, body->state->vel });
			continue;
		}
		grainOfId[id] = int(bodies.size());
		bodies.emplace_back(body, kindOf(material));
	}
	written = motions();
}

int SceneGrains::kindOf(const shared_ptr<JKRMat>& material)
{
	const auto known = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& kind) { return kind.material == material; });
	if (known != kinds.end()) return int(known - kinds.begin());
	material->requireInRange();
	kinds.push_back({ material, material->forKernel() });
	return int(kinds.size() - 1);
}

std::vector<GrainInput> SceneGrains::grains() const
{
	std::vector<GrainInput> all;
	all.reserve(size());
	for (const Grain& grain : bodies) {
		GrainInput g {};
		static_cast<GrainMotion&>(g) = motionOf(*grain.state);
		g.radius = grain.radius, g.mass = grain.mass, g.inertia = grain.inertia;
		g.kind = grain.kind, g.id = grain.id;
		all.push_back(g);
	}
	return all;
}

std::vector<contact_law::PlaneInput> SceneGrains::planes() const
{
	std::vector<contact_law::PlaneInput> all;
	for (const Plane& plane : walls)
		all.push_back({ plane.axis, plane.kind, plane.id, toKernel(plane.state->pos), toKernel(plane.state->vel) });
	return all;
}

std::vector<contact_law::Material> SceneGrains::materials() const
{
	std::vector<contact_law::Material> all;
	for (const Kind& kind : kinds)
		all.push_back(kind.values);
	return all;
}

std::vector<GrainMotion> SceneGrains::motions() const
{
	std::vector<GrainMotion> all;
	all.reserve(size());
	for (const Grain& grain : bodies)
		all.push_back(motionOf(*grain.state));
	return all;
}

int SceneGrains::planeOf(int id) const
{
	for (std::size_t p = 0; p < walls.size(); ++p)
		if (walls[p].id == id) return int(p);
	return -1;
}

// ---- after a step ----

void SceneGrains::write(std::vector<GrainMotion>& now, bool orientations, int threads)
{
#pragma omp parallel for num_threads(threads)
	for (std::size_t k = 0; k < now.size(); ++k) {
		State& s = *bodies[k].state;
		s.pos = fromKernel(now[k].position);
		s.vel = fromKernel(now[k].velocity);
		s.angVel = fromKernel(now[k].angularVelocity);
		const contact_law::Orientation& q = now[k].orientation;
		if (orientations) s.ori = Quaternionr(q.w, q.x, q.y, q.z);
	}
	written.swap(now);
}

void SceneGrains::takePlanes(const contact_law::Dynamics& dynamics)
{
	for (std::size_t p = 0; p < walls.size(); ++p) {
		walls[p].position = fromKernel(contact_law::planePosition(dynamics, int(p)));
		walls[p].velocity = fromKernel(dynamics.state().planes[p].velocity);
	}
}

void SceneGrains::writePlanes(const contact_law::Dynamics& dynamics)
{
	takePlanes(dynamics);
	for (Plane& plane : walls)
		plane.state->pos = plane.position;
}

void SceneGrains::setWritten(const std::vector<GrainMotion>& motions, const contact_law::Dynamics& dynamics)
{
	written = motions;
	takePlanes(dynamics);
}

void SceneGrains::pushPlanes(Scene& scene, const contact_law::Dynamics& dynamics) const
{
	for (std::size_t p = 0; p < walls.size(); ++p)
		scene.forces.addForce(walls[p].id, fromKernel(contact_law::pushOn(dynamics, int(p))));
}

std::string SceneGrains::tooFast(Real step, Real smallestRadius) const
{
	for (const Plane& plane : walls)
		if (!(plane.state->vel.norm() * step <= 0.5 * smallestRadius))
			return bodyName(plane.id) + ", a Wall, moves at " + rounded(plane.state->vel.norm())
			        + " m/s: must be at most half the smallest radius in a small step";
	return "";
}

// ---- what scripts change ----

bool SceneGrains::takeChanges(const Scene& scene, bool orientations, contact_law::Dynamics& dynamics)
{
	requireSameMaterials();
	const int threads = dynamics.threadCount();
	const auto moved = [&](std::size_t k) { return !sameMotion(*bodies[k].state, written[k], orientations); };
	const auto untouched = [&](std::size_t k) { return bodies[k].isThere(scene) && !bodies[k].changed() && !moved(k); };
	bool any = false;
	if (!(hasAllBodies(scene) && forAll(size(), threads, untouched))) {
		requireSame(scene);
		for (std::size_t k = 0; k < size(); ++k) {
			if (!moved(k)) continue;
			const GrainMotion motion = motionOf(*bodies[k].state);
			if (!finite(motion))
				refuseInEngine(
				        bodyName(idOf(k)) + " was given a position, orientation or velocity that is not a finite number");
			dynamics.set(int(k), motion);
			written[k] = motion;
			any = true;
		}
	}
	requireKeptPlanes(scene);
	for (std::size_t p = 0; p < walls.size(); ++p) {
		Plane& plane = walls[p];
		if (plane.state->pos == plane.position && plane.state->vel == plane.velocity) continue;
		plane.position = plane.state->pos, plane.velocity = plane.state->vel;
		dynamics.setPlane(int(p), toKernel(plane.position), toKernel(plane.velocity));
		any = true;
	}
	return any;
}

bool SceneGrains::hasMoreIds(const Scene& scene) const
{
	const auto isThere = [&](int id) { return id < int(scene.bodies->size()) && (*scene.bodies)[id]; };
	return endOfIds(scene) > grainOfId.size() || std::any_of(erased.begin(), erased.end(), isThere);
}

bool SceneGrains::hasMore(const Scene& scene) const
{
	if (!hasMoreIds(scene)) return false;
	requireSameMaterials();
	requireKept(scene);
	return true;
}

bool SceneGrains::hasBody(const Scene& scene, int id) const
{
	const int grain = grainOf(id);
	return grain >= 0 ? bodies[grain].isThere(scene) : walls[planeOf(id)].isThere(scene);
}

bool SceneGrains::Kept::isThere(const Scene& scene) const { return std::size_t(id) < scene.bodies->size() && (*scene.bodies)[id] == body; }

const char* SceneGrains::Kept::changed() const
{
	return body->state != state                ? "state"
	        : body->shape != shape             ? "shape"
	        : body->material.get() != material ? "material"
	        : body->groupMask != mask          ? "mask"
	        : body->flags != flags             ? "flag (bounded or aspherical)"
	                                           : nullptr;
}

const char* SceneGrains::Grain::changed() const
{
	if (const char* what = Kept::changed()) return what;
	return sphere().radius != radius                                     ? "radius"
	        : state->mass != mass                                        ? "mass"
	        : state->inertia[0] != inertia || !isotropic(state->inertia) ? "moment of inertia"
	                                                                     : nullptr;
}

void SceneGrains::requireSame(const Scene& scene) const
{
	if (scene.bodies->size() < grainOfId.size() || hasMoreIds(scene))
		refuseInEngine("there are " + std::to_string(endOfIds(scene)) + " bodies, must be the " + std::to_string(grainOfId.size())
		        + " of the latest step: bodies were cleared");
	requireKept(scene);
}

void SceneGrains::requireKept(const Scene& scene) const
{
	for (const Grain& grain : bodies)
		if (!grain.isThere(scene))
			refuseInEngine(bodyName(grain.id) + ((*scene.bodies)[grain.id] ? " was replaced by another" : " was erased")
			        + " after the start: bodies must stay; make a new engine");
	for (const Grain& grain : bodies)
		if (const char* what = grain.changed())
			refuseInEngine("the " + std::string(what) + " of " + bodyName(grain.id)
			        + " was changed after the start: it must stay as it was; make a new engine");
	requireKeptPlanes(scene);
}

void SceneGrains::requireKeptPlanes(const Scene& scene) const
{
	for (const Plane& plane : walls) {
		if (!(plane.isThere(scene) && !plane.changed() && static_cast<const Wall&>(*plane.shape).axis == plane.axis))
			refuseInEngine(bodyName(plane.id)
			        + ", a Wall, was replaced or changed after the start: it must stay as it was; make a new engine");
		refuseIfAny(faultOf(*plane.body, scene, InPeriodic::AtRest));
		requireFinite(*plane.body);
	}
}

std::string SceneGrains::firstBodyOf(int kind) const
{
	const auto first = std::find_if(bodies.begin(), bodies.end(), [kind](const Grain& grain) { return grain.kind == kind; });
	return first == bodies.end() ? "a Wall" : bodyName(first->id);
}

void SceneGrains::requireSameMaterials() const
{
	for (std::size_t k = 0; k < kinds.size(); ++k) {
		const contact_law::Material& was = kinds[k].values;
		const contact_law::Material now = kinds[k].material->forKernel();
		for (const contact_law::MaterialRow& row : contact_law::materialList)
			if (now.*row.member != was.*row.member)
				refuseInEngine(
				        std::string("the ") + row.name + " of the material of " + firstBodyOf(int(k)) + changedMaterial);
	}
}

} // namespace yade
