// Why a run broke down: which grain, which contact.
#pragma once

namespace contact_law {

class Dynamics;

// A grain, and what it touches, another or a plane; both as their owner calls them, -1: none.
struct Diagnosis {
	int grain = -1, other = -1;
	double speed = 0, overlap = 0, force = 0; // of the grain [m/s]; over the smaller radius; along the normal [N]
};

enum { FastestGrain = -1 };
// The grain as given, or the one that moves fastest, with its contact that had the largest force before the grains moved.
Diagnosis diagnoseGrain(const Dynamics&, int grain = FastestGrain);
// The contact with the largest force of all.
Diagnosis largestForce(const Dynamics&);
// The contact that overlaps most, by more than the smaller of its radii (no law holds there); speed and force are left out. Grain -1: none does.
Diagnosis deepestOverlap(const Dynamics&);

} // namespace contact_law
