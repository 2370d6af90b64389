// An infinite plane across an axis, through the body's position.
#pragma once
#include <core/Body.hpp>

namespace yade {

class Wall : public Shape {
public:
	Wall();
	~Wall() override;
	YADE_INTERFACE_OVERRIDES_(Wall)
	YADE_INTERFACE_INDEX_OVERRIDES_

	int sense; // side on which it meets spheres; 0: both
	int axis;
};

} // namespace yade
