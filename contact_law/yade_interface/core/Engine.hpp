// What stands in O.engines.
#pragma once
#include <declare/at_offset.hpp>
#include <declare/overrides.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class Scene;
class TimingDeltas;

class Engine : public Serializable {
public:
	Engine();
	~Engine() override;
	YADE_INTERFACE_OVERRIDES_(Engine)
	virtual bool isActivated();
	virtual void action();

	Scene* scene; // set before action() is called

private:
	long timingInfo[2]; // calls, nanoseconds
	shared_ptr<TimingDeltas> timingDeltas;

public:
	bool dead;
	int ompThreads;
	string label;
};
static_assert(sizeof(Engine) == 104, "Engine");
YADE_INTERFACE_AT_(Engine, scene, 24)
YADE_INTERFACE_AT_(Engine, dead, 64)
YADE_INTERFACE_AT_(Engine, ompThreads, 68)
YADE_INTERFACE_AT_(Engine, label, 72)

} // namespace yade

SAVED_BY_YADE(Engine)
