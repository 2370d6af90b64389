// Material properties, shared by bodies.
#pragma once
#include <declare/at_offset.hpp>
#include <declare/overrides.hpp>
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class State;

class Material : public Serializable, public Indexable {
public:
	~Material() override;
	virtual shared_ptr<State> newAssocState() const;
	virtual bool stateTypeOk(State*) const;
	Material() {} // not exported: the defaults below are YADE's
	YADE_INTERFACE_OVERRIDES_(Material)
	REGISTER_INDEX_COUNTER(Material);

	int id = -1; // in O.materials
	string label;
	Real density = 1000;
};
static_assert(sizeof(Material) == 80, "Material");
YADE_INTERFACE_AT_(Material, id, 32)
YADE_INTERFACE_AT_(Material, label, 40)
YADE_INTERFACE_AT_(Material, density, 72)

} // namespace yade

SAVED_BY_YADE(Material)
