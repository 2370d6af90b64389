// Contact with a normal and a shear force, which YADE's recorders and stress functions read: the base of JKRWadaPhys.
#pragma once
#include <core/Interaction.hpp>

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

class NormShearPhys : public NormPhys {
public:
	NormShearPhys();
	~NormShearPhys() override;
	YADE_INTERFACE_OVERRIDES_(NormShearPhys)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real ks;
	Vector3r shearForce;
};

} // namespace yade

SAVED_BY_YADE(NormPhys)
SAVED_BY_YADE(NormShearPhys)
