// What contacts can be made: those of spheres with each other and with planes (Wall). Everything else is refused, by functors and fused
// engine.
#pragma once
#include "../yade_interface/yade.hpp"
#include <atomic>
#include <mutex>
#include <string>

namespace yade {

// What is done once in each step of a scene, by whichever of InteractionLoop's threads comes first; the others wait for it.
class OncePerStep {
public:
	template <class Action> void operator()(const Scene& scene, const Action& action)
	{
		if (isDone(scene)) return;
		const std::lock_guard<std::mutex> only(doing);
		if (isDone(scene)) return;
		iteration = none; // before the scene: other threads read it after that
		latest = scene.energy, known = latest.get();
		action();
		iteration = scene.iter;
	}

private:
	static constexpr long none = -2;

	bool isDone(const Scene& scene) const { return known == scene.energy.get() && iteration == scene.iter; }

	// Functors outlive scenes, and another scene may be at the same iteration. Each has an EnergyTracker of its own; while this one is
	// kept, no other has its address.
	shared_ptr<EnergyTracker> latest;
	std::atomic<const EnergyTracker*> known { nullptr };
	std::atomic<long> iteration { none };
	std::mutex doing;
};

// Of a body (of an interaction, by its id), or null.
const Wall* wallOf(const Body&);
const Wall* wallOf(const Scene&, int id);
// What is wrong with a body of JKRMat, in one line, or empty. Planes in a periodic cell at rest are the fused engine's only.
enum class InPeriodic { Refused, AtRest };
std::string faultOf(const Body&, const Scene&, InPeriodic);
constexpr const char* bondsOfPlanes = "neck: must be 0 in scenes with a Wall: there are no sintered bonds to planes";

/* Refuses in the middle of a step, which threads make that could not pass an exception on: the run stops after this step, and Python's main
 * thread, which has made it, gets a RuntimeError. */
void refuseInStep(Scene&, const std::string& what);

class SceneShapes {
public:
	// Whether the law can hold between all bodies of JKRMat; refuses the scene in this step if not. From any thread; looks once a step.
	bool fit(Scene&);

private:
	OncePerStep look;
	bool fine = true;
};

} // namespace yade
