// Contacts and grains exchanged with other owners of a scene (YADE's functors, another engine), in the middle of a run too.
#pragma once
#include "contacts.hpp"

namespace contact_law {

struct InheritedContact {
	int first, second;              // grains as given
	ContactHistory<double> history; // laboratory frame
	ContactBefore before;           // at the moment of the history
	bool bonded = false;
	double rest = 0, neck = 0; // of a bond
};

// Contacts that grains have when a run starts, in place of unstrained springs where they overlap.
struct Inherited {
	std::vector<InheritedContact> contacts;
	struct OnPlane {
		int grain, plane;     // as given
		PlaneContact contact; // but its grain, plane and constants
		Vec3<double> force;   // on the grain
	};
	std::vector<OnPlane> onPlanes;
	/* As a leapfrog leaves them: histories of the moment a small step before the positions, velocities of half a step before (of turned grains likewise), and in
	 * scenes with drag `previous`, the velocities another step before. Otherwise all is of one moment. */
	bool stepBehind = false;
	double step = 0; // that its owner makes, this run's small one at least [s]
	std::vector<Vec3<double>> previous;

	bool empty() const { return contacts.empty() && onPlanes.empty(); }

	std::vector<double> necks() const; // of the bonds, each once
};

// As YADE's loop leaves grains after a step: moved on by a small step, velocities of half a step before that, contacts as they are now.
// Orientations are turned from those of this run, or, where it follows none, from those given.
void readAhead(const Dynamics&, std::vector<GrainMotion>& grains);

} // namespace contact_law
