// Elastic material: the base of JKRMat.
#pragma once
#include <core/Body.hpp>

namespace yade {

class ElastMat : public Material {
public:
	ElastMat() { createIndex(); } // not exported; an index of its own, as every class below the topmost
	~ElastMat() override;
	YADE_INTERFACE_OVERRIDES_(ElastMat)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real young = 1e9;
	Real poisson = 0.25;
};

} // namespace yade

SAVED_BY_YADE(ElastMat)
