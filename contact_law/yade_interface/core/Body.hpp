// A body: material, state and shape.
#pragma once
#include <core/Material.hpp>
#include <core/Shape.hpp>
#include <core/State.hpp>
#include <map>

namespace yade {

class Bound;
class Interaction;

class Body : public Serializable {
public:
	using id_t = int;
	using mask_t = int;
	using MapId2IntrT = std::map<id_t, shared_ptr<Interaction>>;
	static constexpr id_t ID_NONE = -1;

	Body();
	~Body() override;
	YADE_INTERFACE_OVERRIDES_(Body)
	const id_t& getId() const { return id; }

	// exported by libyade; each reads one or two bits of flags
	bool isDynamic() const;
	bool isClump() const;
	bool isClumpMember() const;
	bool isStandalone() const;
	bool isAspherical() const;
	bool isBounded() const;

	id_t id;
	mask_t groupMask;
	int flags;
	int subdomain;
	shared_ptr<Material> material;
	shared_ptr<State> state;
	shared_ptr<Shape> shape;
	shared_ptr<Bound> bound;
	MapId2IntrT intrs; // by the other body's id
	id_t clumpId;
	long iterBorn;
	Real timeBorn;
};
static_assert(sizeof(Body) == 176, "Body");
YADE_INTERFACE_AT_(Body, id, 24)
YADE_INTERFACE_AT_(Body, groupMask, 28)
YADE_INTERFACE_AT_(Body, flags, 32)
YADE_INTERFACE_AT_(Body, material, 40)
YADE_INTERFACE_AT_(Body, state, 56)
YADE_INTERFACE_AT_(Body, shape, 72)
YADE_INTERFACE_AT_(Body, bound, 88)
YADE_INTERFACE_AT_(Body, intrs, 104)
YADE_INTERFACE_AT_(Body, clumpId, 152)

} // namespace yade
