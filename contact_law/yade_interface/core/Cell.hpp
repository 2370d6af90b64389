// The periodic cell. Made by YADE only; no function of it that shifts positions is exported.
#pragma once
#include <declare/at_offset.hpp>
#include <declare/overrides.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class Cell : public Serializable {
public:
	Cell();
	~Cell() override;
	void integrateAndUpdate(Real dt); // deforms it by velGrad through dt [s]
	YADE_INTERFACE_OVERRIDES_(Cell)

private:
	char room[568] __attribute__((aligned(8))); // shear and size derived from hSize

public:
	Matrix3r trsf;
	Matrix3r refHSize;
	Matrix3r hSize; // columns are the cell's edges
	Matrix3r prevHSize;
	Matrix3r velGrad;
	Matrix3r nextVelGrad;
	Matrix3r prevVelGrad;
	int homoDeform;
	bool velGradChanged, flipFlippable;
};
static_assert(sizeof(Cell) == 1104, "Cell");
YADE_INTERFACE_AT_(Cell, trsf, 592)
YADE_INTERFACE_AT_(Cell, refHSize, 664)
YADE_INTERFACE_AT_(Cell, hSize, 736)
YADE_INTERFACE_AT_(Cell, prevHSize, 808)
YADE_INTERFACE_AT_(Cell, velGrad, 880)
YADE_INTERFACE_AT_(Cell, nextVelGrad, 952)
YADE_INTERFACE_AT_(Cell, prevVelGrad, 1024)
YADE_INTERFACE_AT_(Cell, homoDeform, 1096)
YADE_INTERFACE_AT_(Cell, velGradChanged, 1100)

} // namespace yade
