// Forces and torques on bodies. All work is done by functions that libyade exports; the members are room only.
#pragma once
#include <core/Body.hpp>

namespace yade {

class ForceContainer {
	char room[264 + declare::mutex] __attribute__((aligned(8)));
	ForceContainer(); // made by YADE only, inside of Scene
	ForceContainer(const ForceContainer&);

public:
	// safe from InteractionLoop's threads
	void addForce(Body::id_t, const Vector3r&);
	void addTorque(Body::id_t, const Vector3r&);
	// valid after sync()
	const Vector3r& getForce(Body::id_t);
	const Vector3r& getTorque(Body::id_t);
	// permanent ones (O.forces.setPermF, setPermT); valid after sync()
	const Vector3r& getPermForce(Body::id_t);
	const Vector3r& getPermTorque(Body::id_t);
	void setPermForce(Body::id_t, const Vector3r&);
	void setPermTorque(Body::id_t, const Vector3r&);
	bool getPermForceUsed() const; // whether any was ever set
	void sync();
	void reset(long iter, bool resetAll = false); // resetAll: permanent forces (O.forces.setPermF) too
};
static_assert(sizeof(ForceContainer) == 264 + declare::mutex, "ForceContainer");

} // namespace yade
