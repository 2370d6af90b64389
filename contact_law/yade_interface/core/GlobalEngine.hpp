// An engine that acts on the whole scene.
#pragma once
#include <core/Engine.hpp>

namespace yade {

class GlobalEngine : public Engine {
public:
	GlobalEngine() {} // not exported
	~GlobalEngine() override;
	YADE_INTERFACE_OVERRIDES_(GlobalEngine)
};
static_assert(sizeof(GlobalEngine) == 104, "GlobalEngine");

} // namespace yade

SAVED_BY_YADE(GlobalEngine)
