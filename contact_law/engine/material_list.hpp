// The constants of a material, listed once for those who go through them all.
#pragma once
#include "../kernel/pair_constants.hpp"
#include <iterator>

namespace contact_law {

struct MaterialRow {
	const char* name;
	double Material::*member;
};
constexpr MaterialRow materialList[] = {
	{ "young", &Material::young },
	{ "poisson", &Material::poisson },
	{ "density", &Material::density },
	{ "surfaceEnergy", &Material::surfaceEnergy },
	{ "criticalRolling", &Material::criticalRolling },
	{ "viscoelasticTime", &Material::viscoelasticTime },
};
static_assert(sizeof(Material) == std::size(materialList) * sizeof(double), "every constant of Material has its row");

} // namespace contact_law
