// What contacts the functors can make: those of spheres with each other and with planes (Wall). Everything else is refused.
#pragma once
#include <core/Scene.hpp>
#include <atomic>
#include <string>

namespace yade {

class Wall;

// Of a body of an interaction, or null.
const Wall* wallOf(const Scene&, int id);

/* Refuses in the middle of a step, which threads make that could not pass an exception on: the run stops after this step, and Python's main
 * thread, which has made it, gets a RuntimeError. */
void refuseInStep(Scene&, const std::string& what);

class SceneShapes {
public:
	// Whether the law can hold between all bodies of JKRMat; refuses the scene in this step if not. From any thread; looks once a step.
	bool fit(Scene&);
	bool planes() const { return anyPlane; }

private:
	std::atomic<long> lookedAt { -2 };
	bool fine = true, anyPlane = false;
};

} // namespace yade
