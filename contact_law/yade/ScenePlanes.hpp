// YADE's Walls as the fused engine's planes: read at the start, moved on and pushed after each step, and compared with what was written to find what scripts have changed.
#pragma once
#include "../engine/dynamics.hpp"
#include <core/Body.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Wall.hpp>
#include <string>
#include <vector>

namespace yade {

class ScenePlanes {
public:
	void add(const shared_ptr<Body>&, int kind); // a Wall that faultOf() finds nothing wrong with; kind: of its material

	std::vector<contact_law::PlaneInput> planes() const;
	bool empty() const { return kept.empty(); }
	int size() const { return int(kept.size()); }
	int planeOf(int id) const; // -1: none

	bool isThere(const Scene&, int plane) const;
	void requireKept(const Scene&) const; // throws std::runtime_error for Walls that are not those of the start any more
	// Walls that a script has moved or given another velocity. Throws std::runtime_error for a change that the engine cannot follow.
	bool takeChanges(const Scene&, contact_law::Dynamics&); // whether there were any
	// Empty, or which Wall moves too fast for this small step [s].
	std::string tooFast(Real step, Real smallestRadius) const;
	void write(const contact_law::Dynamics&, Real ahead = 0); // where they are, or will be that much later [s]
	void push(Scene&, const contact_law::Dynamics&) const;    // what the grains do to them: to O.forces
	// As if they had been written.
	void setWritten(const contact_law::Dynamics&);

private:
	struct Kept {
		int id; // the body loses its own where it is erased
		shared_ptr<Body> body;
		shared_ptr<State> state;
		shared_ptr<Shape> shape;
		const Material* material;
		int axis, mask, flags, kind;
		Vector3r position, velocity; // as written
	};
	std::vector<Kept> kept;
};

} // namespace yade
