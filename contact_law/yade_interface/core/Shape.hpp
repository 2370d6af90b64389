// What a body looks like to colliders and geometry functors.
#pragma once
#include <declare/at_offset.hpp>
#include <declare/overrides.hpp>
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class Shape : public Serializable, public Indexable {
public:
	~Shape() override;
	YADE_INTERFACE_OVERRIDES_(Shape)
	REGISTER_INDEX_COUNTER(Shape);

private:
	// caches of functors; this file needs no more of them than their room
	shared_ptr<Factorable> boundFunctor, internalForceFunctor;

public:
	Vector3r color;
	bool wire, highlight;

protected:
	Shape(); // made by YADE only
};
static_assert(sizeof(Shape) == 96, "Shape");
YADE_INTERFACE_AT_(Shape, color, 64)

} // namespace yade
