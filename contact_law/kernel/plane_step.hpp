// A grain and a plane (a half-space of the plane's own material) through one time step: the limit of contactStep() for an infinite second
// sphere, whose pointer is the plane's fixed normal. Planes rest, or move at a velocity that contacts don't change, and do not turn.
// MODEL.md, "Planes".
#pragma once
#include "contact_step.hpp"

namespace contact_law {

struct Plane {
	Vec3<double> position, normal, velocity; // of any of its points; unit vector towards the grain
	Vec3<double> across(const Vec3<double>& v) const { return v - dot(v, normal) * normal; }
};

// A grain's motion past a plane. What the plane's velocity does is not the grain's own motion: booked apart, as a periodic cell's boundaries.
inline ContactMotion motionPast(const Plane& plane, const Vec3<double>& position, const Vec3<double>& velocity, const Vec3<double>& spin,
        double dt, double inverseMass, double inverseInertia)
{
	return { dot(position - plane.position, plane.normal) * plane.normal, velocity - plane.velocity, spin, { 0, 0, 0 }, dt, inverseMass,
		-plane.velocity, inverseInertia, 0 };
}

/* As contactStep(), for a motion made by motionPast() and constants with an infinite radius2. `history.pointers` are those of this instant
 * (of a contact that may form: n2 alone). Of the result, the force is the grain's (minus it: the plane's) and torque2 has no meaning. */
template <unsigned mechanisms>
inline ContactStepResult planeStep(
        const PairConstants<double>& c, LimitRule limit, const ContactMotion& m, const ContactBefore& before, PlaneHistory<double>& history)
{
	const Vec3<double>& n = history.pointers.n2;
	return contactStepAt<mechanisms>(c, limit, m, { n, 0, c.radius1 - dot(m.separation, n) }, before, history);
}

// planeStep by its mechanisms, for callers that know them at run time only.
using PlaneStep = ContactStepResult (*)(
        const PairConstants<double>&, LimitRule, const ContactMotion&, const ContactBefore&, PlaneHistory<double>&);

template <size_t... mechanisms> constexpr std::array<PlaneStep, sizeof...(mechanisms)> planeSteps(std::index_sequence<mechanisms...>)
{
	return { &planeStep<unsigned(mechanisms)>... };
}
constexpr auto planeStepWith = planeSteps(std::make_index_sequence<mechanismSets> {});

} // namespace contact_law
