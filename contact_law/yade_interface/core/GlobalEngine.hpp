// What stands in O.engines.
#pragma once
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

class GlobalEngine : public Engine {
public:
	GlobalEngine() {} // not exported
	~GlobalEngine() override;
	YADE_INTERFACE_OVERRIDES_(GlobalEngine)
};

} // namespace yade

SAVED_BY_YADE(Engine)
SAVED_BY_YADE(GlobalEngine)
