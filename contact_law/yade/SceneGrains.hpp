// YADE's bodies as the fused engine's grains and planes: read at the start, written after each step, and compared with what was written to find what scripts have changed.
#pragma once
#include "../engine/dynamics.hpp"
#include "JKRWada.hpp"
#include "Refusal.hpp"
#include "ScenePlanes.hpp"
#include <core/Body.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>
#include <vector>

namespace yade {

class SceneGrains {
public:
	// Throws std::runtime_error for a body that the engine cannot move.
	explicit SceneGrains(const Scene&);

	// In the order of the ids, as the bodies are; for the start.
	std::vector<contact_law::GrainInput> grains() const;
	std::vector<contact_law::Material> materials() const;
	std::vector<contact_law::GrainMotion> motions() const;

	// The bodies get these motions, whose place the ones written before take. Orientations only when asked for.
	void write(std::vector<contact_law::GrainMotion>& now, bool orientations, int threads);
	// As if the bodies had been given these motions.
	void setWritten(const std::vector<contact_law::GrainMotion>& motions) { written = motions; }

	// Whether bodies were added behind those that are as they were. Throws std::runtime_error where these were changed too.
	bool hasMore(const Scene&) const;
	bool hasBody(const Scene&, int id) const; // whether there is still the body of that id
	// What the bodies are now, with what a script has changed, row by row: ids (size()), vectors (size(), 3), radii (size()). Throws likewise.
	struct Columns {
		int* id;
		double *position, *velocity, *angularVelocity, *radius;
	};
	void readNow(const Scene&, int threads, const Columns&) const;
	/* Calls changed(index, motion) for bodies that a script has moved, pushed or blocked since they were written or this was called.
	 * Throws std::runtime_error for a change that the engine cannot follow: of bodies, their radius, mass, inertia, material, shape or mask; of materials. */
	template <class Changed> void eachChange(const Scene&, bool orientations, int threads, Changed&& changed);

	const State& stateOf(std::size_t k) const { return *bodies[k].state; }
	std::size_t size() const { return bodies.size(); }
	int idOf(std::size_t k) const { return bodies[k].id; }
	int grainOf(int id) const { return id < int(grainOfId.size()) ? grainOfId[id] : -1; } // -1: none

	ScenePlanes planes;

private:
	struct Kept { // what a body must stay; pointers are the body's own
		shared_ptr<Body> body;
		shared_ptr<State> state;
		shared_ptr<Sphere> sphere;
		const Material* material;
		Real radius, mass, inertia;
		int mask, flags, kind, id;
	};
	struct Kind {
		shared_ptr<JKRMat> material;
		contact_law::Material values;
	};

	Kept read(const shared_ptr<Body>&, int kind) const;
	std::string nameOf(std::size_t k) const { return bodyName(idOf(k)); }
	static std::size_t endOfIds(const Scene&); // behind the last body; those that were erased behind it count no more
	bool hasMoreIds(const Scene&) const;
	bool hasAllBodies(const Scene& scene) const { return endOfIds(scene) == grainOfId.size() && !hasMoreIds(scene); }
	int kindOf(const shared_ptr<JKRMat>&);
	std::string firstBodyOf(int kind) const;
	bool isThere(const Scene& scene, std::size_t k) const
	{
		return std::size_t(idOf(k)) < scene.bodies->size() && (*scene.bodies)[idOf(k)] == bodies[k].body;
	}
	bool sameBody(std::size_t k) const;
	void requireSame(const Scene&) const;
	void requireKept(const Scene&) const; // of the bodies that there were
	[[noreturn]] void refuseChange(std::size_t k) const;
	void requireSameMaterials() const;

	std::vector<Kept> bodies;
	std::vector<int> grainOfId, erased; // erased: ids without a body when this was made
	std::vector<Kind> kinds;
	std::vector<contact_law::GrainMotion> written;
};

contact_law::GrainMotion motionOf(const State&);
bool sameMotion(const State&, const contact_law::GrainMotion&, bool orientations);
bool finite(const contact_law::GrainMotion&);

// Whether it is so for every body; asked by all threads, since reading every body takes about a small step.
template <class Is> bool forAll(std::size_t bodies, int threads, const Is& is)
{
	bool so = true;
#pragma omp parallel for num_threads(threads) reduction(&& : so)
	for (std::size_t k = 0; k < bodies; ++k)
		so = so && is(k);
	return so;
}

template <class Changed> void SceneGrains::eachChange(const Scene& scene, bool orientations, int threads, Changed&& changed)
{
	requireSameMaterials();
	const auto moved = [&](std::size_t k) { return !sameMotion(*bodies[k].state, written[k], orientations); };
	const auto untouched = [&](std::size_t k) { return isThere(scene, k) && sameBody(k) && !moved(k); };
	if (hasAllBodies(scene) && forAll(size(), threads, untouched)) return;
	requireSame(scene);
	for (std::size_t k = 0; k < size(); ++k) {
		if (!moved(k)) continue;
		const contact_law::GrainMotion motion = motionOf(*bodies[k].state);
		changed(k, motion);
		written[k] = motion;
	}
}

} // namespace yade
