#include "ScenePlanes.hpp"
#include "../engine/contacts.hpp"
#include "KernelVectors.hpp"
#include "Refusal.hpp"
#include "SceneShapes.hpp"

namespace yade {

namespace {
	void requireFinite(const Body& body)
	{
		if (!body.state->pos.allFinite() || !body.state->vel.allFinite())
			refuseInEngine(bodyName(body.getId()) + ", a Wall, has a position or velocity that is not a finite number");
	}
}

void ScenePlanes::add(const shared_ptr<Body>& body, int kind)
{
	const State& state = *body->state;
	requireFinite(*body);
	kept.push_back({ int(body->getId()), body, body->state, body->shape, body->material.get(),
	        static_cast<const Wall&>(*body->shape).axis, body->groupMask, body->flags, kind, state.pos, state.vel });
}

std::vector<contact_law::PlaneInput> ScenePlanes::planes() const
{
	std::vector<contact_law::PlaneInput> all;
	for (const Kept& k : kept)
		all.push_back({ k.axis, k.kind, k.id, toKernel(k.state->pos), toKernel(k.state->vel) });
	return all;
}

int ScenePlanes::planeOf(int id) const
{
	for (int p = 0; p < size(); ++p)
		if (kept[p].id == id) return p;
	return -1;
}

bool ScenePlanes::isThere(const Scene& scene, int plane) const
{
	const std::size_t id = kept[plane].id;
	return id < scene.bodies->size() && (*scene.bodies)[id] == kept[plane].body;
}

void ScenePlanes::requireKept(const Scene& scene) const
{
	for (int p = 0; p < size(); ++p) {
		const Kept& k = kept[p];
		const bool same = isThere(scene, p) && k.body->state == k.state && k.body->shape == k.shape
		        && k.body->material.get() == k.material && static_cast<const Wall&>(*k.shape).axis == k.axis
		        && k.body->groupMask == k.mask && k.body->flags == k.flags;
		if (!same)
			refuseInEngine(bodyName(k.id)
			        + ", a Wall, was replaced or changed after the start: it must stay as it was; make a new engine");
	}
}

bool ScenePlanes::takeChanges(const Scene& scene, contact_law::Dynamics& dynamics)
{
	requireKept(scene);
	for (const Kept& k : kept) {
		const std::string fault = faultOf(*k.body, scene, InPeriodic::AtRest);
		if (!fault.empty()) refuseInEngine(fault);
		requireFinite(*k.body);
	}
	bool any = false;
	for (int p = 0; p < size(); ++p) {
		Kept& k = kept[p];
		if (k.state->pos == k.position && k.state->vel == k.velocity) continue;
		k.position = k.state->pos, k.velocity = k.state->vel;
		dynamics.setPlane(p, toKernel(k.position), toKernel(k.velocity));
		any = true;
	}
	return any;
}

std::string ScenePlanes::tooFast(Real step, Real smallestRadius) const
{
	for (const Kept& k : kept)
		if (!(k.state->vel.norm() * step <= 0.5 * smallestRadius))
			return bodyName(k.id) + ", a Wall, moves at " + rounded(k.state->vel.norm())
			        + " m/s: must be at most half the smallest radius in a small step";
	return "";
}

void ScenePlanes::setWritten(const contact_law::Dynamics& dynamics)
{
	for (int p = 0; p < size(); ++p) {
		kept[p].position = fromKernel(contact_law::planePosition(dynamics, p));
		kept[p].velocity = fromKernel(dynamics.state().planes[p].velocity);
	}
}

void ScenePlanes::write(const contact_law::Dynamics& dynamics, Real ahead)
{
	setWritten(dynamics);
	for (Kept& k : kept)
		k.state->pos = k.position += ahead * k.velocity;
}

void ScenePlanes::push(Scene& scene, const contact_law::Dynamics& dynamics) const
{
	for (int p = 0; p < size(); ++p)
		scene.forces.addForce(kept[p].id, fromKernel(contact_law::pushOn(dynamics, p)));
}

} // namespace yade
