// A sphere about the body's position.
#pragma once
#include <core/Shape.hpp>

namespace yade {

class Sphere : public Shape {
public:
	Sphere();
	~Sphere() override;
	YADE_INTERFACE_OVERRIDES_(Sphere)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real radius;
};
static_assert(sizeof(Sphere) == 104, "Sphere");
YADE_INTERFACE_AT_(Sphere, radius, 96)

} // namespace yade
