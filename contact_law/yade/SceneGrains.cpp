#include "SceneGrains.hpp"
#include "../engine/material_list.hpp"
#include "SceneShapes.hpp"
#include <algorithm>

namespace yade {

using contact_law::GrainInput;
using contact_law::GrainMotion;

namespace {
	void copy(const Vector3r& from, double* to)
	{
		for (int k = 0; k < 3; ++k)
			to[k] = from[k];
	}
	bool same(const Vector3r& x, const double (&y)[3]) { return x[0] == y[0] && x[1] == y[1] && x[2] == y[2]; }
	Vector3r eigen(const double (&x)[3]) { return Vector3r(x[0], x[1], x[2]); }
	shared_ptr<JKRMat> requireOfLaw(const Scene& scene, const shared_ptr<Body>& body, const Body& first)
	{
		const std::string who = bodyName(body->getId());
		const auto material = boost::dynamic_pointer_cast<JKRMat>(body->material);
		if (!material) refuseInEngine(who + " must be a sphere or a Wall of JKRMat; this engine moves nothing else");
		const std::string fault = faultOf(*body, scene, InPeriodic::AtRest);
		if (!fault.empty()) refuseInEngine(fault);
		if (!body->isBounded() || body->groupMask == 0)
			refuseInEngine(who + " must be bounded, with a mask other than 0: all bodies meet all others");
		if (body->groupMask != first.groupMask)
			refuseInEngine(who + ": mask = " + text(body->groupMask) + ", must be " + text(first.groupMask) + " as "
			        + bodyName(first.getId()) + "'s: all bodies meet all others");
		return material;
	}

	bool isotropic(const Vector3r& inertia) { return inertia[0] == inertia[1] && inertia[1] == inertia[2]; }

	void write(const GrainMotion& g, State& s, bool orientations)
	{
		s.pos = eigen(g.position);
		s.vel = eigen(g.velocity);
		s.angVel = eigen(g.angularVelocity);
		if (orientations) s.ori = Quaternionr(g.orientation.w, g.orientation.x, g.orientation.y, g.orientation.z);
	}

	std::string changed(const std::string& what, Real was, Real is)
	{
		return what + " was changed after the start: it must stay " + text(was) + ", not " + text(is) + "; make a new engine";
	}
}

GrainMotion motionOf(const State& s)
{
	GrainMotion g {};
	copy(s.pos, g.position);
	copy(s.vel, g.velocity);
	copy(s.angVel, g.angularVelocity);
	g.blocked = s.blockedDOFs;
	g.orientation = { s.ori.w(), s.ori.x(), s.ori.y(), s.ori.z() };
	return g;
}

bool sameMotion(const State& s, const GrainMotion& g, bool orientations)
{
	const contact_law::Orientation& q = g.orientation;
	if (orientations && !(s.ori.w() == q.w && s.ori.x() == q.x && s.ori.y() == q.y && s.ori.z() == q.z)) return false;
	return same(s.pos, g.position) && same(s.vel, g.velocity) && same(s.angVel, g.angularVelocity) && s.blockedDOFs == g.blocked;
}

bool finite(const GrainMotion& g)
{
	const auto all = [](const double(&x)[3]) { return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]); };
	const contact_law::Orientation& q = g.orientation;
	return all(g.position) && all(g.velocity) && all(g.angularVelocity) && std::isfinite(q.w + q.x + q.y + q.z);
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
		if (wallOf(*body)) {
			planes.add(body, kindOf(material));
			continue;
		}
		grainOfId[id] = int(bodies.size());
		bodies.push_back(read(body, kindOf(material)));
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

SceneGrains::Kept SceneGrains::read(const shared_ptr<Body>& body, int kind) const
{
	const std::string who = bodyName(body->getId());
	const auto sphere = boost::static_pointer_cast<Sphere>(body->shape);
	const State& state = *body->state;
	if (!finite(motionOf(state))) refuseInEngine(who + " has a position, orientation or velocity that is not a finite number");
	if (!(sphere->radius > 0 && state.mass > 0 && state.inertia.minCoeff() > 0))
		refuseInEngine(who + ": radius, mass and moments of inertia must be > 0");
	if (!isotropic(state.inertia)) refuseInEngine(who + ": its three moments of inertia must be the same, those of a sphere");
	return { body, body->state, sphere, body->material.get(), sphere->radius, state.mass, state.inertia[0], body->groupMask,
		body->flags, kind, int(body->getId()) };
}

std::vector<GrainInput> SceneGrains::grains() const
{
	std::vector<GrainInput> all;
	all.reserve(size());
	for (const Kept& kept : bodies) {
		GrainInput g {};
		static_cast<GrainMotion&>(g) = motionOf(*kept.state);
		g.radius = kept.radius, g.mass = kept.mass, g.inertia = kept.inertia;
		g.kind = kept.kind, g.id = kept.id;
		all.push_back(g);
	}
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
	for (const Kept& kept : bodies)
		all.push_back(motionOf(*kept.state));
	return all;
}

void SceneGrains::write(std::vector<GrainMotion>& now, bool orientations, int threads)
{
#pragma omp parallel for num_threads(threads)
	for (std::size_t k = 0; k < now.size(); ++k)
		yade::write(now[k], *bodies[k].state, orientations);
	written.swap(now);
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

void SceneGrains::readNow(const Scene& scene, int threads, const Columns& to) const
{
	const auto read = [&](std::size_t k) {
		const Kept& kept = bodies[k];
		to.id[k] = kept.id;
		copy(kept.state->pos, to.position + 3 * k);
		copy(kept.state->vel, to.velocity + 3 * k);
		copy(kept.state->angVel, to.angularVelocity + 3 * k);
		to.radius[k] = kept.sphere->radius;
		return isThere(scene, k) && kept.body->state == kept.state && kept.body->shape == kept.sphere;
	};
	if (hasAllBodies(scene) && forAll(size(), threads, read)) return;
	requireSame(scene);
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
	for (std::size_t k = 0; k < size(); ++k)
		if (!isThere(scene, k))
			refuseInEngine(nameOf(k) + ((*scene.bodies)[idOf(k)] ? " was replaced by another" : " was erased")
			        + " after the start: bodies must stay; make a new engine");
	for (std::size_t k = 0; k < size(); ++k)
		if (!sameBody(k)) refuseChange(k);
	planes.requireKept(scene);
}

bool SceneGrains::hasBody(const Scene& scene, int id) const
{
	const int grain = grainOf(id);
	return grain >= 0 ? isThere(scene, std::size_t(grain)) : planes.isThere(scene, planes.planeOf(id));
}

bool SceneGrains::sameBody(std::size_t k) const
{
	const Kept& kept = bodies[k];
	const Body& body = *kept.body;
	const State& state = *kept.state;
	return body.state == kept.state && body.shape == kept.sphere && body.material.get() == kept.material && body.groupMask == kept.mask
	        && body.flags == kept.flags && state.mass == kept.mass && state.inertia[0] == kept.inertia && isotropic(state.inertia)
	        && kept.sphere->radius == kept.radius;
}

void SceneGrains::refuseChange(std::size_t k) const
{
	const Kept& kept = bodies[k];
	const Body& body = *kept.body;
	const auto replaced = [&](const char* what) {
		refuseInEngine(nameOf(k) + " was given another " + what + " after the start: it must keep its own; make a new engine");
	};
	if (body.state != kept.state) replaced("state");
	if (body.shape != kept.sphere) replaced("shape");
	if (body.material.get() != kept.material) replaced("material");
	const std::string of = " of " + nameOf(k);
	if (body.groupMask != kept.mask) refuseInEngine(changed("the mask" + of, kept.mask, body.groupMask));
	if (kept.sphere->radius != kept.radius) refuseInEngine(changed("the radius" + of, kept.radius, kept.sphere->radius));
	if (kept.state->mass != kept.mass) refuseInEngine(changed("the mass" + of, kept.mass, kept.state->mass));
	for (int i = 0; i < 3; ++i)
		if (kept.state->inertia[i] != kept.inertia)
			refuseInEngine(changed("the moment of inertia" + of, kept.inertia, kept.state->inertia[i]));
	refuseInEngine(nameOf(k) + ": bounded or aspherical was changed after the start: it must stay as it was; make a new engine");
}

std::string SceneGrains::firstBodyOf(int kind) const
{
	const auto first = std::find_if(bodies.begin(), bodies.end(), [kind](const Kept& kept) { return kept.kind == kind; });
	return first == bodies.end() ? "a Wall" : bodyName(first->id);
}

void SceneGrains::requireSameMaterials() const
{
	for (std::size_t k = 0; k < kinds.size(); ++k) {
		const Kind& kind = kinds[k];
		const contact_law::Material now = kind.material->forKernel();
		for (const contact_law::MaterialRow& row : contact_law::materialList)
			if (now.*row.member != kind.values.*row.member)
				refuseInEngine(changed(row.name + std::string(" of the material of ") + firstBodyOf(int(k)),
				        kind.values.*row.member, now.*row.member));
	}
}

} // namespace yade
