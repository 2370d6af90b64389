// What is done once in each step of a scene, by whichever of InteractionLoop's threads comes first; the others wait for it.
#pragma once
#include <core/Scene.hpp>
#include <atomic>
#include <mutex>

namespace yade {

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
	// Whether the latest step of this scene had it done.
	bool wasDone(const Scene& scene) const { return known == scene.energy.get() && iteration == scene.iter - 1; }

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

} // namespace yade
