// Geometry of a contact.
#pragma once
#include <declare/at_offset.hpp>
#include <declare/overrides.hpp>
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class IGeom : public Serializable, public Indexable {
public:
	IGeom() {}
	~IGeom() override;
	YADE_INTERFACE_OVERRIDES_(IGeom)
	REGISTER_INDEX_COUNTER(IGeom);
};
static_assert(sizeof(IGeom) == 32, "IGeom");

} // namespace yade

SAVED_BY_YADE(IGeom)
