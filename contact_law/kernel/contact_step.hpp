// One contact through one time step of a kick-drift-kick integrator: limits, formation and breaking as events located in the step, and the
// energy ledger.
//
// The ledger books the work that the integrator takes out of the grains. Over a step the grains move by velocity * dt, and the kicks are
// half the forces before and half the forces after it. A contact that forms (or breaks) inside the step acted for a fraction of the step
// only: its kick is the integral of its force over that fraction, which keeps the trajectory and the ledger of second order in dt.
// MODEL.md, "The integrator and the ledger", derives each line.
#pragma once
#include "cut.hpp"
#include "events.hpp"
#include "limits.hpp"
#include "spring_damping.hpp"

namespace contact_law {

/* The kicks of a contact that touches now: what belongs before this instant (`normalBefore` along the normal, a fraction of the springs'
 * forces, and what cut springs gave beyond that), and half a step's forces after it.
 * r.now is the contact at this instant. */
inline void setKicks(const ContactMotion& m, double normalBefore, double springsBefore, const events::Kicks& ofCuts, ContactStepResult& r)
{
	const double after = 0.5;
	r.forceBefore = normalBefore * r.geometry.normal + springsBefore * r.now.sliding + ofCuts.force;
	r.torqueBefore1 = springsBefore * r.now.torque1 + ofCuts.torque1;
	r.torqueBefore2 = springsBefore * r.now.torque2 + ofCuts.torque2;
	r.workBefore = events::work(m, r.forceBefore, r.torqueBefore1, r.torqueBefore2);
	r.force = r.forceBefore + after * ((r.now.normalForce + r.now.drag) * r.geometry.normal + r.now.sliding);
	r.torque1 = (springsBefore + after) * r.now.torque1 + ofCuts.torque1;
	r.torque2 = (springsBefore + after) * r.now.torque2 + ofCuts.torque2;
}

// The contact at this instant: displacements brought within their limits, forces, stored energies. velocity: v1 - v2 now; springsBefore: the
// fraction of the springs' forces that belongs before this instant. Returns what cut springs add to that.
template <unsigned mechanisms, class History>
inline events::Kicks evaluateNow(const PairConstants<double>& c, LimitRule limit, const ContactMotion& m, const ContactBefore& before,
        const Vec3<double>& velocity, double springsBefore, History& history, ContactStepResult& r)
{
	const ContactGeometry<double>& g = r.geometry;
	cut::Result cuts;
	if (limit == LimitRule::Cut) // a new spring is strained from the cut on: the motion's rate is the springs'
		cuts = cutAtLimits(mechanisms, c, g, m, before, springsBefore, history, r.dissipated);
	else {
		Displacements<double> trial {};
		if constexpr (bool(mechanisms & SpringDamping)) trial = spring_damping::displacements(c, g.normal, history);
		cuts.pointersMoved = returnToLimits<mechanisms>(c, g.normal, { before.sliding, before.rolling, before.twist },
		        { normalRate(g.normal, g.inverseDistance, m.velocity), m.spin1, m.spin2, m.dt }, history, true, r.dissipated);
		if constexpr (bool(mechanisms & SpringDamping))
			if (m.dt > 0)
				r.slipped = spring_damping::slipRates(
				        c, g.normal, trial, spring_damping::displacements(c, g.normal, history), m.dt);
	}
	r.pointersMoved = cuts.pointersMoved || !before.touching;
	r.touching = true;
	r.now = contactForces<mechanisms>(c, g, history, velocity);
	r.stored = storedEnergy(mechanisms, c, r.now, history.twist);
	return cuts.added;
}

// A contact that touched a step ago and does now.
template <unsigned mechanisms, class History>
inline ContactStepResult keptContact(const PairConstants<double>& c, LimitRule limit, const ContactMotion& m,
        const ContactGeometry<double>& g, const ContactBefore& before, History& history)
{
	ContactStepResult r;
	r.geometry = g;
	const events::Kicks ofCuts =
	        evaluateNow<mechanisms>(c, limit, m, before, drag::velocityNow(m.velocity, before.velocity), 0.5, history, r);
	bookDrag<double>({ before.drag, before.overlap }, { r.now.drag, g.overlap }, true, r.dissipated);
	setKicks(m, 0.5 * (r.now.normalForce + r.now.drag), 0.5, ofCuts, r);
	if constexpr (bool(mechanisms & SpringDamping)) spring_damping::add(c, m, before, history, 1, false, r);
	return r;
}

/* A contact that touches now and did not a step ago. Its springs grow from zero: half of their force over the fraction of the step.
 * One that overlapped a step ago already and has no history was placed there by the user: nothing is booked for it. */
template <unsigned mechanisms, class History>
inline ContactStepResult newContact(const PairConstants<double>& c, LimitRule limit, const ContactMotion& m,
        const ContactGeometry<double>& g, const ContactBefore& before, History& history)
{
	ContactStepResult r;
	r.geometry = g;
	const events::Formation formed = events::formationOf(events::overlapAStepAgo(m, g, c.radius1 + c.radius2, history), g.overlap);
	events::form(m, formed.fraction * m.dt, history);
	const double f = formed.fraction;
	const events::Kicks ofCuts = evaluateNow<mechanisms>(c, limit, m, before, m.velocity, formed.inStep ? f / 2 : 0.5, history, r);
	if (!formed.inStep) {
		setKicks(m, 0.5 * (r.now.normalForce + r.now.drag), 0.5, ofCuts, r);
		if constexpr (bool(mechanisms & SpringDamping)) spring_damping::add(c, m, before, history, 1, true, r);
		return r;
	}
	const double closing = g.overlap - formed.overlapBefore;
	const double normalBefore = normal::forceSinceFormation(c, r.stored.normal, closing) + f * r.now.drag;
	const double impulseBefore = normalBefore * m.dt, impulseAfter = 0.5 * (r.now.normalForce + r.now.drag) * m.dt;
	r.dissipated.connection = normal::connection(c, impulseBefore, impulseAfter, m.inverseMass);
	bookDragFraction(f, { r.now.drag, g.overlap }, closing, r.dissipated);
	setKicks(m, normalBefore, f / 2, ofCuts, r);
	if constexpr (bool(mechanisms & SpringDamping)) spring_damping::add(c, m, before, history, f, false, r);
	return r;
}

/* A contact that breaks inside the step. Its last kicks (a step ago) covered half a step; what is missing to the fraction follows now.
 * The springs' forces are those of this instant, not of the breaking, so that forces and torques balance where the grains are. Where a script has torn the
 * grains apart, which opens the contact by more than their motion does, the sliding spring is let go as it was, and no steps led to the breaking; where it was open
 * before the step already, so is all of it. */
template <unsigned mechanisms, class History>
inline ContactStepResult brokenContact(const PairConstants<double>& c, const ContactMotion& m, const ContactGeometry<double>& g,
        const ContactBefore& before, const History& h)
{
	ContactStepResult r;
	const double opening = before.overlap - g.overlap;
	if (m.dt == 0 || opening <= 0) {
		r.dissipated.disconnection = letGo(mechanisms, c, before);
		return r;
	}
	const double fraction = events::fractionUntilPullOff(c, before.overlap, opening);
	const normal::Breaking breaking = normal::forceUntilBreaking(c, before.overlap, opening, fraction);
	constexpr unsigned springs = mechanisms & AllSprings;
	const bool torn = events::isTorn(m, opening);
	const double push = breaking.force + (fraction - 0.5) * before.drag - (torn ? 0. : breaking.missed);
	ContactForces<double> f =
	        torn ? contactForces<springs & ~Sliding>(c, g, h, m.velocity) : contactForces<springs>(c, g, h, m.velocity);
	if (torn) f.slidingDisplacement = before.sliding;

	r.force = push * g.normal + (fraction - 0.5) * f.sliding;
	r.torque1 = (fraction - 0.5) * f.torque1;
	r.torque2 = (fraction - 0.5) * f.torque2;
	if constexpr (bool(mechanisms & SpringDamping)) spring_damping::addUntilBreaking(c, m, before, h, fraction, r, g);
	r.forceBefore = r.force;
	r.torqueBefore1 = r.torque1;
	r.torqueBefore2 = r.torque2;
	r.workBefore = events::work(m, r.force, r.torque1, r.torque2);
	r.dissipated.disconnection = normal::disconnection(c, push * m.dt, m.inverseMass);
	addSpringRelease<mechanisms>(c, before, f, h.twist, fraction, r.dissipated);
	bookDragFraction(fraction, { before.drag, before.overlap }, -opening, r.dissipated);
	return r;
}

/* The whole law for one contact and one step. `history` holds the pointers as the grains carried them to this instant, and the twist of
 * the step before; it comes back as it is after slips (and made anew for a contact that forms). touching = false in the result: no
 * contact now, and the history has no meaning. */
template <unsigned mechanisms, class History>
inline ContactStepResult contactStepAt(const PairConstants<double>& c, LimitRule limit, const ContactMotion& m,
        const ContactGeometry<double>& g, const ContactBefore& before, History& history)
{
	if (!before.touching) {
		if (g.overlap < 0) return {}; // the search finds grains that sintering has shrunk before they touch
		return newContact<mechanisms>(c, limit, m, g, before, history);
	}
	if constexpr (bool(mechanisms & Twisting))
		history.twist += twisting::increment(g.normal, g.inverseDistance, m.velocity, m.spin1 - m.spin2, m.dt);
	if (normal::beyondPullOff(c, g)) return brokenContact<mechanisms>(c, m, g, before, history);
	return keptContact<mechanisms>(c, limit, m, g, before, history);
}

/* The moment a step ago of a pair whose springs rest at a distance `rest`: the first grain stood at `then` from the second, and the pointers of `h`
 * had not turned yet. c: PairConstants, or a bond's. */
template <class Constants>
inline ContactBefore aStepAgo(const Constants& c, double rest, const Vec3<double>& then, const ContactHistory<double>& h)
{
	const double apart = std::sqrt(dot(then, then));
	ContactBefore before;
	before.touching = true;
	before.overlap = rest - apart;
	before.sliding = SlidingSpring::displacement(c, h.pointers, (1 / apart) * then);
	before.rolling = RollingSpring::displacement(c, h.pointers);
	before.twist = h.twist;
	return before;
}

// Pointers turn with their grains through a step.
inline void turnPointers(ContactHistory<double>& h, const ContactMotion& m)
{
	h.pointers = { turnedALittle(h.pointers.n1, m.dt * m.spin1), turnedALittle(h.pointers.n2, m.dt * m.spin2) };
}

template <unsigned mechanisms>
inline ContactStepResult contactStep(const PairConstants<double>& c, LimitRule limit, const ContactMotion& m, const ContactBefore& before,
        ContactHistory<double>& history)
{
	return contactStepAt<mechanisms>(c, limit, m, geometryOf(m.separation, c.radius1 + c.radius2), before, history);
}

// contactStep by its mechanisms, for callers that know them at run time only.
using ContactStep = ContactStepResult (*)(
        const PairConstants<double>&, LimitRule, const ContactMotion&, const ContactBefore&, ContactHistory<double>&);

constexpr ContactStep contactStepWith[mechanismSets] = CONTACT_LAW_ALL_MECHANISMS(contactStep);

// ---- a grain and a plane ----

/* A half-space of the plane's own material: the limit of contactStep() for an infinite second sphere, whose pointer is the plane's fixed normal.
 * Planes rest, or move at a velocity that contacts don't change, and do not turn. MODEL.md, "Planes". */
struct Plane {
	Vec3<double> position, normal, velocity; // of any of its points; unit vector towards the grain
	ON_GPU Vec3<double> across(const Vec3<double>& v) const { return v - dot(v, normal) * normal; }
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

constexpr PlaneStep planeStepWith[mechanismSets] = CONTACT_LAW_ALL_MECHANISMS(planeStep);

} // namespace contact_law
