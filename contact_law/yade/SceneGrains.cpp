#include "SceneGrains.hpp"
#include "JKRWada.hpp"
#include <core/Body.hpp>
#include <core/State.hpp>
#include <pkg/common/Sphere.hpp>
#include <algorithm>

namespace yade {

using contact_law::GrainInput;

namespace {
	void copy(const Vector3r& from, double (&to)[3])
	{
		for (int k = 0; k < 3; ++k)
			to[k] = from[k];
	}
	bool same(const Vector3r& x, const double (&y)[3]) { return x[0] == y[0] && x[1] == y[1] && x[2] == y[2]; }
	Vector3r eigen(const double (&x)[3]) { return Vector3r(x[0], x[1], x[2]); }
}

GrainInput grainOf(const State& s)
{
	GrainInput g {};
	copy(s.pos, g.position);
	copy(s.vel, g.velocity);
	copy(s.angVel, g.angularVelocity);
	g.mass = s.mass;
	g.inertia = s.inertia[0];
	g.blocked = s.blockedDOFs;
	g.orientation = { s.ori.w(), s.ori.x(), s.ori.y(), s.ori.z() };
	return g;
}

bool sameMotion(const State& s, const GrainInput& g, bool orientations)
{
	const contact_law::Orientation& q = g.orientation;
	if (orientations && !(s.ori.w() == q.w && s.ori.x() == q.x && s.ori.y() == q.y && s.ori.z() == q.z)) return false;
	return same(s.pos, g.position) && same(s.vel, g.velocity) && same(s.angVel, g.angularVelocity) && s.blockedDOFs == g.blocked;
}

void write(const GrainInput& g, State& s, bool orientations)
{
	s.pos = eigen(g.position);
	s.vel = eigen(g.velocity);
	s.angVel = eigen(g.angularVelocity);
	if (orientations) s.ori = Quaternionr(g.orientation.w, g.orientation.x, g.orientation.y, g.orientation.z);
}

bool finite(const GrainInput& g)
{
	const auto all = [](const double(&x)[3]) { return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]); };
	return all(g.position) && all(g.velocity) && all(g.angularVelocity);
}

SceneGrains readGrains(const Scene& scene)
{
	SceneGrains result;
	std::vector<const JKRMat*> kinds;
	for (size_t id = 0; id < scene.bodies->size(); ++id) {
		const auto& body = (*scene.bodies)[id];
		const std::string who = "body " + std::to_string(id);
		if (!body) refuseInEngine(who + " was erased: erased bodies are not supported, make the scene without them");
		const auto* sphere = dynamic_cast<const Sphere*>(body->shape.get());
		const auto* material = dynamic_cast<const JKRMat*>(body->material.get());
		if (!sphere || !material) refuseInEngine(who + " is not a sphere of JKRMat; this engine moves nothing else");
		GrainInput g = grainOf(*body->state);
		g.radius = sphere->radius;
		if (!finite(g)) refuseInEngine(who + " has a position or velocity that is not a finite number");
		if (!(g.radius > 0) || !(g.mass > 0) || !(g.inertia > 0))
			refuseInEngine(who + ": radius, mass and moment of inertia must be positive");
		const auto known = std::find(kinds.begin(), kinds.end(), material);
		g.kind = int(known - kinds.begin());
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

} // namespace yade
