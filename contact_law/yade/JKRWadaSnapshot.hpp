// Reads a scene of JKR-Wada grains out in bulk, everything at one and the same moment.
#pragma once
#include <lib/serialization/Serializable.hpp>

namespace yade {

class JKRWadaSnapshot : public Serializable {
public:
	boost::python::dict read() const;
	virtual ~JKRWadaSnapshot() {}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(JKRWadaSnapshot, Serializable,
		"Arrays of the grains and contacts of the current scene, for :yref:`contact_law.snapshot`.",
		,
		,
		.def("read", &JKRWadaSnapshot::read,
			"Dict of bytearrays (double or 32-bit int, in the order of body ids) and the time [s]. Call it from a PyRunner that stands last among the engines.")
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(JKRWadaSnapshot);

} // namespace yade
