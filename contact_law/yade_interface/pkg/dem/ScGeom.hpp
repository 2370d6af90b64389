// Geometry of two touching spheres, as Ig2_Sphere_Sphere_ScGeom makes it. Read here, never derived from.
#pragma once
#include <core/Interaction.hpp>

namespace yade {

class GenericSpheresContact : public IGeom {
public:
	~GenericSpheresContact() override;
	YADE_INTERFACE_OVERRIDES_(GenericSpheresContact)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Vector3r normal; // from body 1 to body 2
	Vector3r contactPoint;
	Real refR1, refR2;

protected:
	GenericSpheresContact(); // made by YADE only
};

class ScGeom : public GenericSpheresContact {
	Vector3r twist_axis, orthonormal_axis;

public:
	ScGeom();
	~ScGeom() override;
	YADE_INTERFACE_OVERRIDES_(ScGeom)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real& radius1; // = refR1
	Real& radius2; // = refR2
	Real penetrationDepth;
	Vector3r shearInc;
};

} // namespace yade
