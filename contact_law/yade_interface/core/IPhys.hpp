// Physics of a contact.
#pragma once
#include <declare/at_offset.hpp>
#include <declare/overrides.hpp>
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class IPhys : public Serializable, public Indexable {
public:
	IPhys() {}
	~IPhys() override;
	YADE_INTERFACE_OVERRIDES_(IPhys)
	REGISTER_INDEX_COUNTER(IPhys);
};
static_assert(sizeof(IPhys) == 32, "IPhys");

} // namespace yade

SAVED_BY_YADE(IPhys)
