// One bond through one time step of a kick-drift-kick integrator: its springs, and its breaking as an event located inside the step (as
// formation and breaking of contacts in contact_step.hpp).
#pragma once
#include "bond.hpp"
#include "contact_step.hpp"

namespace contact_law {

struct BondStepResult {
	ContactStepResult contact; // touching = false: nothing is left
	bool bonded = true;
	int mode = -1; // by which it broke (BondMode)
};

namespace bonds {
	// Whether stretch and slip have changed over the step by more than twice what the grains' motion does.
	inline bool isTorn(const BondConstants<double>& b, const ContactMotion& m, const ContactBefore& before,
	        const ContactGeometry<double>& g, const ContactForces<double>& f)
	{
		const auto length = [](const Vec3<double>& v) { return std::sqrt(dot(v, v)); };
		const double most = 2 * m.dt * (length(m.velocity) + b.radius1 * length(m.spin1) + b.radius2 * length(m.spin2));
		const double opening = g.overlap - before.overlap;
		const Vec3<double> slip = f.slidingDisplacement - before.sliding;
		return opening * opening + dot(slip, slip) > most * most;
	}

	/* The bond broke after a fraction of the step: its last kicks covered half a step, what is missing to the fraction follows now.
	 * Shrunk grains that overlap now touch since then, or since they overlapped, with unstrained springs: S17's new contact. What
	 * disappears is all that the bond held, less what the new contact holds and what the kicks take out of the step, less what
	 * unequal half kicks lose in a leapfrog (contact_step.hpp). Where a script has torn the grains apart, by more than their motion
	 * does, no steps led to the breaking: the bond is let go as it was, with what it held then. */
	template <unsigned mechanisms>
	inline BondStepResult broken(const BondConstants<double>& b, const PairConstants<double>& c, const ContactMotion& m,
	        const ContactBefore& before, const ContactGeometry<double>& bondGeometry, const ContactForces<double>& bond,
	        const Breaking& breaking, ContactHistory<double>& h)
	{
		BondStepResult result;
		ContactStepResult& r = result.contact;
		result.bonded = false;
		result.mode = breaking.mode;
		const bool torn = m.dt == 0 || isTorn(b, m, before, bondGeometry, bond);
		double released = torn ? held(b, before) : heldAfterHalfKick(b, before, bondGeometry, bond, h.twist);
		events::Kicks ahead, after;
		if (!torn) ahead.add(breaking.fraction - 0.5, breaking.fraction - 0.5, bondGeometry, bond);

		r.geometry = geometryOf(m.separation, c.radius1 + c.radius2);
		r.touching = r.geometry.overlap > 0;
		if (r.touching) {
			const double closing = bondGeometry.overlap - before.overlap, overlapBefore = r.geometry.overlap - closing;
			const double since = std::min(1 - breaking.fraction, overlapBefore < 0 ? r.geometry.overlap / closing : 1.);
			h = events::formedHistory(m, since * m.dt);
			r.pointersMoved = true;
			r.now = contactForces<mechanisms>(c, r.geometry, h, m.velocity);
			r.stored = storedEnergy(mechanisms, c, r.now, h.twist);
			bookDragFraction(since, { r.now.drag, r.geometry.overlap }, closing, r.dissipated);
			ahead.add(since, since / 2, r.geometry, r.now); // springs grow from zero
			after.add(0.5, 0.5, r.geometry, r.now);
			released -= total(r.stored) + total(r.dissipated);
		}
		r.forceBefore = ahead.force;
		r.torqueBefore1 = ahead.torque1;
		r.torqueBefore2 = ahead.torque2;
		r.workBefore = ahead.work(m);
		r.dissipated.*bondBreakingBy[breaking.mode] =
		        released - ahead.workOnPair(m) + (after.squared(m) - ahead.squared(m)) * m.dt * m.dt / 2;
		r.force = ahead.force + after.force;
		r.torque1 = ahead.torque1 + after.torque1;
		r.torque2 = ahead.torque2 + after.torque2;
		return result;
	}
}

// A bond's history when it is made: the centres' distance, which is its own from now on, and pointers that meet.
inline double newBond(const Vec3<double>& separation, ContactHistory<double>& history)
{
	const double distance = std::sqrt(dot(separation, separation));
	const Vec3<double> normal = (1 / distance) * separation;
	history = { { -normal, normal }, 0 };
	return distance;
}

/* One bond for one step. `before`: displacements a step ago, overlap = rest - distance; `history` as for contactStep(). When it breaks
 * and the shrunk grains of `c` overlap, result and history are those of the ordinary contact that takes its place. `mechanisms` are
 * those of ordinary contacts; a bond has all springs, and no drag. */
template <unsigned mechanisms>
inline BondStepResult bondStep(const BondConstants<double>& b, const PairConstants<double>& c, const ContactMotion& m,
        const ContactBefore& before, double rest, ContactHistory<double>& history)
{
	const ContactGeometry<double> g = geometryOf(m.separation, rest);
	history.twist += twisting::increment(g.normal, g.inverseDistance, m.velocity, m.spin1 - m.spin2, m.dt);
	const ContactForces<double> f = bondForces(b, g, history);
	const bonds::Breaking breaking = bonds::firstBreaking(b, before, g, f, history.twist);
	if (breaking.mode >= 0) return bonds::broken<mechanisms>(b, c, m, before, g, f, breaking, history);

	BondStepResult result;
	ContactStepResult& r = result.contact;
	r.touching = true;
	r.geometry = g;
	r.now = f;
	r.stored = bondEnergy(b, g, f, history.twist);
	r.force = f.normalForce * g.normal + f.sliding;
	r.torque1 = f.torque1;
	r.torque2 = f.torque2;
	r.forceBefore = 0.5 * r.force;
	r.torqueBefore1 = 0.5 * r.torque1;
	r.torqueBefore2 = 0.5 * r.torque2;
	r.workBefore = 0.5 * events::work(m, r.force, r.torque1, r.torque2);
	return result;
}

// bondStep by the mechanisms of ordinary contacts, for callers that know them at run time only.
using BondStep = BondStepResult (*)(const BondConstants<double>&, const PairConstants<double>&, const ContactMotion&, const ContactBefore&,
        double, ContactHistory<double>&);

template <size_t... mechanisms> constexpr std::array<BondStep, sizeof...(mechanisms)> bondSteps(std::index_sequence<mechanisms...>)
{
	return { &bondStep<unsigned(mechanisms)>... };
}
constexpr auto bondStepWith = bondSteps(std::make_index_sequence<mechanismSets> {});

} // namespace contact_law
