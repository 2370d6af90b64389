// A sphere about the body's position.
#pragma once
#include <core/Body.hpp>

namespace yade {

class Sphere : public Shape {
public:
	Sphere();
	~Sphere() override;
	YADE_INTERFACE_OVERRIDES_(Sphere)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real radius;
};

} // namespace yade
