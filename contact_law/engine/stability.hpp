// How long a run's small step may be.
#pragma once

namespace contact_law {

class Dynamics;

// Steps from here on are unstable for some pair that the scene's kinds of grains could make, with or without bonds, in whatever packing [s] (MODEL.md, "Step limits").
double unstableStep(const Dynamics&);
// The same for bonds of another neck [s].
double unstableStepOfBonds(const Dynamics&, double neck);

// The largest gap between grains that touch, or are bonded [m]: the neighbour lists must hold them so far apart, however small other grains are.
double mostStretched(const Dynamics&);

} // namespace contact_law
