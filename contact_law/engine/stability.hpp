// How long a run's small step may be.
#pragma once

namespace contact_law {

class Dynamics;

/* Steps from here on are unstable for every pair of like grains in the scene, in whatever packing [s] (MODEL.md, "Step limits"): half a time unit, at which
 * collisions were seen to blow up, m* over the drag coefficient, where drag overshoots with its velocity extrapolated, or 2 over the fastest vibration of a
 * bonded pair. */
double unstableStep(const Dynamics&);
// The same for bonds of another neck [s].
double unstableStepOfBonds(const Dynamics&, double neck);

} // namespace contact_law
