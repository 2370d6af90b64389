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
static_assert(sizeof(State) == 320, "State");
YADE_INTERFACE_AT_(State, se3, 88)
YADE_INTERFACE_AT_(State, vel, 144)
YADE_INTERFACE_AT_(State, mass, 168)
YADE_INTERFACE_AT_(State, angVel, 176)
YADE_INTERFACE_AT_(State, angMom, 200)
YADE_INTERFACE_AT_(State, inertia, 224)
YADE_INTERFACE_AT_(State, refPos, 248)
YADE_INTERFACE_AT_(State, refOri, 272)
YADE_INTERFACE_AT_(State, blockedDOFs, 304)
YADE_INTERFACE_AT_(State, isDamped, 308)
YADE_INTERFACE_AT_(State, densityScaling, 312)

} // namespace yade

SAVED_BY_YADE(State)
