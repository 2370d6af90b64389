// Where a body is and how it moves. Made by YADE only (its constructor is exported).
#pragma once
#include <declare/at_offset.hpp>
#include <declare/overrides.hpp>
#include <declare/mutex.hpp>
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class State : public Serializable, public Indexable {
public:
	enum {
		DOF_NONE = 0,
		DOF_X = 1,
		DOF_Y = 2,
		DOF_Z = 4,
		DOF_RX = 8,
		DOF_RY = 16,
		DOF_RZ = 32,
		DOF_ALL = 63,
		DOF_XYZ = 7,
		DOF_RXRYRZ = 56
	};

	State();
	~State() override;
	YADE_INTERFACE_OVERRIDES_(State)
	REGISTER_INDEX_COUNTER(State);

	Vector3r& pos;    // = se3.position
	Quaternionr& ori; // = se3.orientation
	declare::Mutex updateMutex;
	Se3r se3;
	Vector3r vel;
	Real mass;
	Vector3r angVel;
	Vector3r angMom;
	Vector3r inertia;
	Vector3r refPos;
	Quaternionr refOri;
	unsigned int blockedDOFs;
	bool isDamped;
	Real densityScaling;
};
static_assert(sizeof(State) == 280 + declare::mutex, "State");
YADE_INTERFACE_AT_(State, se3, 48 + declare::mutex)
YADE_INTERFACE_AT_(State, vel, 104 + declare::mutex)
YADE_INTERFACE_AT_(State, mass, 128 + declare::mutex)
YADE_INTERFACE_AT_(State, angVel, 136 + declare::mutex)
YADE_INTERFACE_AT_(State, angMom, 160 + declare::mutex)
YADE_INTERFACE_AT_(State, inertia, 184 + declare::mutex)
YADE_INTERFACE_AT_(State, refPos, 208 + declare::mutex)
YADE_INTERFACE_AT_(State, refOri, 232 + declare::mutex)
YADE_INTERFACE_AT_(State, blockedDOFs, 264 + declare::mutex)
YADE_INTERFACE_AT_(State, isDamped, 268 + declare::mutex)
YADE_INTERFACE_AT_(State, densityScaling, 272 + declare::mutex)

} // namespace yade

SAVED_BY_YADE(State)
