/* YADE's bodies as the fused engine's grains and planes (Walls): read at the start, written after each step, and compared with what was
 * written to find what scripts have changed. */
#pragma once
#include "../engine/dynamics.hpp"
#include "JKRWada.hpp"
#include "Refusal.hpp"
#include <vector>

namespace yade {

class SceneGrains {
public:
	// Throws std::runtime_error for a body that the engine cannot move.
	explicit SceneGrains(const Scene&);

	// In the order of the ids, as the bodies are; for the start.
	std::vector<contact_law::GrainInput> grains() const;
	std::vector<contact_law::PlaneInput> planes() const;
	std::vector<contact_law::Material> materials() const;
	std::vector<contact_law::GrainMotion> motions() const;

	// The bodies get these motions, whose place the ones written before take. Orientations only where they are followed.
	void write(std::vector<contact_law::GrainMotion>& now, bool orientations, int threads);
	void writePlanes(const contact_law::Dynamics&);
	void pushPlanes(Scene&, const contact_law::Dynamics&) const;
	// As if the bodies had been given these motions, and the planes' places of a run.
	void setWritten(const std::vector<contact_law::GrainMotion>&, const contact_law::Dynamics&);

	// Whether bodies were added to those that are as they were. Throws std::runtime_error where these were changed too.
	bool hasMore(const Scene&) const;
	bool hasBody(const Scene&, int id) const; // whether there is still the body of that id
	// Throws std::runtime_error where bodies were added or are others than those that were written.
	void requireSame(const Scene&) const;
	/* Gives a run what a script has moved, pushed or blocked since bodies and planes were written; whether there was anything.
	 * Throws std::runtime_error for a change that the engine cannot follow: of bodies, their radius, mass, inertia, material, shape
	 * or mask; of materials. */
	bool takeChanges(const Scene&, bool orientations, contact_law::Dynamics&);
	// Empty, or which Wall moves too fast for this small step [s].
	std::string tooFast(Real step, Real smallestRadius) const;

	std::size_t size() const { return bodies.size(); }
	bool hasPlanes() const { return !walls.empty(); }
	int idOf(std::size_t k) const { return bodies[k].id; }
	int grainOf(int id) const { return id < int(grainOfId.size()) ? grainOfId[id] : -1; } // -1: none
	int planeOf(int id) const;                                                            // likewise

private:
	struct Kept { // what a body must stay; pointers are the body's own
		shared_ptr<Body> body;
		int kind;
		int id = int(body->getId());
		shared_ptr<State> state = body->state;
		shared_ptr<Shape> shape = body->shape;
		const Material* material = body->material.get();
		int mask = body->groupMask, flags = body->flags;

		bool isThere(const Scene&) const;
		const char* changed() const; // what of it, or null
	};
	struct Grain : Kept {
		Real radius = sphere().radius, mass = state->mass, inertia = state->inertia[0];

		Grain(const shared_ptr<Body>&, int kind); // throws std::runtime_error for one that the engine cannot move
		const Sphere& sphere() const { return static_cast<const Sphere&>(*shape); }
		const char* changed() const;
	};
	struct Plane : Kept {
		int axis;
		Vector3r position, velocity; // as written
	};
	struct Kind {
		shared_ptr<JKRMat> material;
		contact_law::Material values;
	};

	static std::size_t endOfIds(const Scene&); // behind the last body; those that were erased behind it count no more
	bool hasMoreIds(const Scene&) const;
	bool hasAllBodies(const Scene& scene) const { return endOfIds(scene) == grainOfId.size() && !hasMoreIds(scene); }
	int kindOf(const shared_ptr<JKRMat>&);
	std::string firstBodyOf(int kind) const;
	void requireKept(const Scene&) const; // of the bodies that there were
	void requireKeptPlanes(const Scene&) const;
	void requireSameMaterials() const;
	void takePlanes(const contact_law::Dynamics&);

	std::vector<Grain> bodies;
	std::vector<Plane> walls;
	std::vector<int> grainOfId, erased; // erased: ids without a body when this was made
	std::vector<Kind> kinds;
	std::vector<contact_law::GrainMotion> written;
};

bool finite(const contact_law::GrainMotion&);

// Whether it is so for every body; by all threads, since reading every body takes about a small step.
template <class Is> bool forAll(std::size_t bodies, int threads, const Is& is)
{
	bool so = true;
#pragma omp parallel for num_threads(threads) reduction(&& : so)
	for (std::size_t k = 0; k < bodies; ++k)
		so = so && is(k);
	return so;
}

} // namespace yade
