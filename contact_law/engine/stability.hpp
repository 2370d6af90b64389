// How long a run's small step may be.
#pragma once

namespace contact_law {

class Dynamics;

// Steps from here on are unstable for some pair that the scene's kinds of grains could make, with or without bonds, in whatever packing [s] (MODEL.md, "Step limits").
double unstableStep(const Dynamics&);
// The same for bonds of another neck [s].
double unstableStepOfBonds(const Dynamics&, double neck);

} // namespace contact_law
