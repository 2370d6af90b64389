// The simulation: bodies, interactions, forces, time. Made by YADE only.
#pragma once
#include <core/BodyContainer.hpp>
#include <core/Cell.hpp>
#include <core/EnergyTracker.hpp>
#include <core/ForceContainer.hpp>
#include <core/InteractionContainer.hpp>

namespace yade {

class Engine;

class Scene : public Serializable {
public:
	Scene();
	~Scene() override;
	YADE_INTERFACE_OVERRIDES_(Scene)

private:
	unsigned int hostNameMax;

public:
	ForceContainer forces;

private:
	char room1[104] __attribute__((aligned(8))); // speed of the last steps, renderer, clock

public:
	Real dt;
	long iter;
	bool subStepping;
	int subStep;
	Real time;
	Real speed;
	long stopAtIter;
	Real stopAtTime;
	bool isPeriodic;
	bool trackEnergy;
	bool doSort;
	bool runInternalConsistencyChecks;

private:
	char room2[4 + declare::subdomain] __attribute__((aligned(4))); // selected body, subdomain

public:
	std::vector<std::string> tags;
	std::vector<shared_ptr<Engine>> engines;
	std::vector<shared_ptr<Engine>> _nextEngines;
	shared_ptr<BodyContainer> bodies;
	shared_ptr<InteractionContainer> interactions;
	shared_ptr<EnergyTracker> energy;
	std::vector<shared_ptr<Material>> materials;
	shared_ptr<Bound> bound;
	shared_ptr<Cell> cell;

private:
	char room3[48] __attribute__((aligned(8))); // parameters for display and others
};
static_assert(sizeof(Scene) == 688 + declare::mutex + declare::subdomain, "Scene");
YADE_INTERFACE_AT_(Scene, forces, 32)
YADE_INTERFACE_AT_(Scene, dt, 400 + declare::mutex)
YADE_INTERFACE_AT_(Scene, iter, 408 + declare::mutex)
YADE_INTERFACE_AT_(Scene, subStep, 420 + declare::mutex)
YADE_INTERFACE_AT_(Scene, time, 424 + declare::mutex)
YADE_INTERFACE_AT_(Scene, stopAtIter, 440 + declare::mutex)
YADE_INTERFACE_AT_(Scene, stopAtTime, 448 + declare::mutex)
YADE_INTERFACE_AT_(Scene, isPeriodic, 456 + declare::mutex)
YADE_INTERFACE_AT_(Scene, trackEnergy, 457 + declare::mutex)
YADE_INTERFACE_AT_(Scene, doSort, 458 + declare::mutex)
YADE_INTERFACE_AT_(Scene, tags, 464 + declare::mutex + declare::subdomain)
YADE_INTERFACE_AT_(Scene, engines, 488 + declare::mutex + declare::subdomain)
YADE_INTERFACE_AT_(Scene, bodies, 536 + declare::mutex + declare::subdomain)
YADE_INTERFACE_AT_(Scene, interactions, 552 + declare::mutex + declare::subdomain)
YADE_INTERFACE_AT_(Scene, energy, 568 + declare::mutex + declare::subdomain)
YADE_INTERFACE_AT_(Scene, materials, 584 + declare::mutex + declare::subdomain)
YADE_INTERFACE_AT_(Scene, cell, 624 + declare::mutex + declare::subdomain)

} // namespace yade
