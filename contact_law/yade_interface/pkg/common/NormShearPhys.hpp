// Contact with a normal and a shear force, which YADE's recorders and stress functions read: the base of JKRWadaPhys.
#pragma once
#include <core/IPhys.hpp>

namespace yade {

class NormPhys : public IPhys {
public:
	NormPhys();
	~NormPhys() override;
	YADE_INTERFACE_OVERRIDES_(NormPhys)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real kn;
	Vector3r normalForce;
};
static_assert(sizeof(NormPhys) == 64, "NormPhys");
YADE_INTERFACE_AT_(NormPhys, kn, 32)
YADE_INTERFACE_AT_(NormPhys, normalForce, 40)

class NormShearPhys : public NormPhys {
public:
	NormShearPhys();
	~NormShearPhys() override;
	YADE_INTERFACE_OVERRIDES_(NormShearPhys)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real ks;
	Vector3r shearForce;
};
static_assert(sizeof(NormShearPhys) == 96, "NormShearPhys");
YADE_INTERFACE_AT_(NormShearPhys, ks, 64)
YADE_INTERFACE_AT_(NormShearPhys, shearForce, 72)

} // namespace yade

SAVED_BY_YADE(NormPhys)
SAVED_BY_YADE(NormShearPhys)
