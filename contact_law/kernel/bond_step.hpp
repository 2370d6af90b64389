// One bond through one time step of a kick-drift-kick integrator: its springs, and its breaking as an event located inside the step (as births and breaks of contacts in contact_step.hpp).
#pragma once
#include "bond.hpp"
#include "contact_step.hpp"
#include <algorithm>

namespace contact_law {

struct BondMotion {
	ContactMotion contact;
	double inverseInertia1, inverseInertia2; // 1/I of the grains
};

struct BondStepResult {
	ContactStepResult contact; // touching = false: nothing is left
	bool bonded = true;
	int mode = -1; // by which it broke (BondMode)
};

namespace bonds {
	struct Breaking {
		int mode = -1;
		double share = 2; // of the step, after which it broke
	};

	// The share of a step after which a displacement that goes from `before` to `now` has the length that is critical.
	inline double shareTo(const Vec3<double>& before, const Vec3<double>& now, double criticalSquared)
	{
		const Vec3<double> way = now - before;
		const double squared = dot(way, way), along = dot(before, way), missing = criticalSquared - dot(before, before);
		if (missing <= 0 || squared == 0) return 0;
		return std::min(1., (std::sqrt(along * along + squared * missing) - along) / squared);
	}

	inline Breaking firstBreaking(const BondConstants<double>& b, const ContactBefore& before, const ContactGeometry<double>& g,
	        const ContactForces<double>& f, double twist)
	{
		Breaking first;
		const auto look = [&](int mode, double stiffness, const Vec3<double>& then, const Vec3<double>& now) {
			if (0.5 * stiffness * dot(now, now) <= b.breakingEnergy) return;
			const double share = shareTo(then, now, 2 * b.breakingEnergy / stiffness);
			if (share < first.share) first = { mode, share };
		};
		look(ByStretching, b.normalStiffness, { before.overlap, 0, 0 }, { g.overlap, 0, 0 });
		look(BySliding, b.slidingStiffness, before.sliding, f.slidingDisplacement);
		look(ByRolling, b.rollingStiffness, before.rolling, f.rollingDisplacement);
		look(ByTwisting, b.twistingStiffness, { before.twist, 0, 0 }, { twist, 0, 0 });
		return first;
	}

	// Stored a step ago, less the work of the springs' half kick then over the step.
	inline double heldAfterHalfKick(const BondConstants<double>& b, const ContactBefore& before, const ContactGeometry<double>& g,
	        const ContactForces<double>& f, double twist)
	{
		return 0.5
		        * (b.normalStiffness * before.overlap * g.overlap + b.slidingStiffness * dot(before.sliding, f.slidingDisplacement)
		                + b.rollingStiffness * dot(before.rolling, f.rollingDisplacement)
		                + b.twistingStiffness * before.twist * twist);
	}

	// Kicks of one contact at this instant: what belongs before it and what after.
	struct Kicks {
		Vec3<double> force { 0, 0, 0 }, torque1 { 0, 0, 0 }, torque2 { 0, 0, 0 };

		void add(double shareOfNormal, double shareOfSprings, const ContactGeometry<double>& g, const ContactForces<double>& f)
		{
			force = force + (shareOfNormal * (f.normalForce + f.drag)) * g.normal + shareOfSprings * f.sliding;
			torque1 = torque1 + shareOfSprings * f.torque1;
			torque2 = torque2 + shareOfSprings * f.torque2;
		}
		double squared(const BondMotion& m) const // kinetic energy that they would give to grains at rest, twice over dt^2
		{
			return dot(force, force) * m.contact.inverseMass + dot(torque1, torque1) * m.inverseInertia1
			        + dot(torque2, torque2) * m.inverseInertia2;
		}
	};

	/* The bond broke after the share of the step: its last kicks covered half a step, what is missing to the share follows now. Shrunk grains that overlap
	 * now touch since then, or since they overlapped, with unstrained springs: S17's new contact. What disappears is all that the bond held, less what the
	 * new contact holds and what the kicks take out of the step, less what unequal half kicks lose in a leapfrog (contact_step.hpp). */
	template <unsigned mechanisms>
	inline BondStepResult broken(const BondConstants<double>& b, const PairConstants<double>& c, const BondMotion& motion,
	        const ContactBefore& before, const ContactGeometry<double>& bondGeometry, const ContactForces<double>& bond,
	        const Breaking& breaking, ContactHistory<double>& h)
	{
		const ContactMotion& m = motion.contact;
		BondStepResult result;
		ContactStepResult& r = result.contact;
		result.bonded = false;
		result.mode = breaking.mode;
		double gone = heldAfterHalfKick(b, before, bondGeometry, bond, h.twist);
		Kicks ahead, after;
		ahead.add(breaking.share - 0.5, breaking.share - 0.5, bondGeometry, bond);

		r.geometry = geometryOf(m.separation, c.radius1 + c.radius2);
		r.touching = r.geometry.overlap > 0;
		if (r.touching) {
			const double closing = bondGeometry.overlap - before.overlap, overlapBefore = r.geometry.overlap - closing;
			const double since = std::min(1 - breaking.share, overlapBefore < 0 ? r.geometry.overlap / closing : 1.);
			h = events::bornHistory(m, since * m.dt);
			r.pointersMoved = true;
			r.now = contactForces<mechanisms>(c, r.geometry, h, m.velocity);
			r.stored = storedEnergy(c, r.now, h.twist);
			r.dissipated.drag = since * r.now.drag * closing;
			ahead.add(since, since / 2, r.geometry, r.now); // springs grow from zero
			after.add(0.5, 0.5, r.geometry, r.now);
			gone -= r.stored.normal + r.stored.sliding + r.stored.rolling + r.stored.twisting + r.dissipated.drag;
		}
		r.forceBefore = ahead.force;
		r.workBefore = events::work(m, ahead.force, ahead.torque1, ahead.torque2);
		const double onBoth = r.workBefore + m.dt * dot(ahead.force, m.imageVelocity); // that on a periodic cell's boundaries too
		r.dissipated.bondBreaking[breaking.mode] =
		        gone - onBoth + (after.squared(motion) - ahead.squared(motion)) * m.dt * m.dt / 2;
		r.force = ahead.force + after.force;
		r.torque1 = ahead.torque1 + after.torque1;
		r.torque2 = ahead.torque2 + after.torque2;
		return result;
	}
}

// A bond's memory when it is made: the centres' distance, which is its own from now on, and pointers that meet.
inline double newBond(const Vec3<double>& separation, ContactHistory<double>& history)
{
	const double distance = std::sqrt(dot(separation, separation));
	const Vec3<double> normal = (1 / distance) * separation;
	history = { { -normal, normal }, 0 };
	return distance;
}

/* One bond for one step. `before`: displacements a step ago, overlap = rest - distance; `history` as for contactStep(). When it breaks and the shrunk grains of `c`
 * overlap, result and history are those of the ordinary contact that takes its place. `mechanisms` are those of ordinary contacts; a bond has all springs, and no drag. */
template <unsigned mechanisms>
inline BondStepResult bondStep(const BondConstants<double>& b, const PairConstants<double>& c, const BondMotion& motion,
        const ContactBefore& before, double rest, ContactHistory<double>& history)
{
	const ContactMotion& m = motion.contact;
	const ContactGeometry<double> g = geometryOf(m.separation, rest);
	history.twist += twisting::increment(g.normal, g.inverseDistance, m.velocity, m.spin1 - m.spin2, m.dt);
	const ContactForces<double> f = bondForces(b, g, history);
	const bonds::Breaking breaking = bonds::firstBreaking(b, before, g, f, history.twist);
	if (breaking.mode >= 0) return bonds::broken<mechanisms>(b, c, motion, before, g, f, breaking, history);

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
	r.workBefore = 0.5 * events::work(m, r.force, r.torque1, r.torque2);
	return result;
}

// bondStep by the mechanisms of ordinary contacts, for callers that know them at run time only.
using BondStep = BondStepResult (*)(const BondConstants<double>&, const PairConstants<double>&, const BondMotion&, const ContactBefore&,
        double, ContactHistory<double>&);

template <size_t... mechanisms> constexpr std::array<BondStep, sizeof...(mechanisms)> bondSteps(std::index_sequence<mechanisms...>)
{
	return { &bondStep<unsigned(mechanisms)>... };
}
constexpr auto bondStepWith = bondSteps(std::make_index_sequence<Everything + 1> {});

/* The fastest vibration of two equal grains with one bond between them [1/s]: leapfrog is unstable for it, and for it in any packing, at steps of 2 over this.
 * The two against each other along the normal; across it, both turning with the motion, or against each other's turning (tilt, twist). */
inline double fastestVibration(const BondConstants<double>& b, double inverseMass, double inverseInertia)
{
	const double r = b.radius1, R = b.reducedRadius;
	const double along = 2 * b.normalStiffness * inverseMass, across = 2 * b.slidingStiffness * (inverseMass + r * r * inverseInertia);
	const double tilt = 2 * b.rollingStiffness * R * R * inverseInertia, twist = 2 * b.twistingStiffness * inverseInertia;
	return std::sqrt(std::max({ along, across, tilt, twist }));
}

} // namespace contact_law
