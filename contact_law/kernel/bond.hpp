// Sintered bonds (Sirono & Ueno 2017, "S17", section 3; MODEL.md, "Sintered bonds"): an elastic disk between two rigid grains, which breaks at
// once. The neck's geometry, constants, forces, energies, the limit of each mode, one bond through one step, and the stability of a step.
#pragma once
#include "contact_step.hpp"
#include <algorithm>

namespace contact_law {

constexpr double largestNeck = 0.7; // S17's; the fillet's circle grows without bound towards 1

// Of a neck whose radius is beta times that of its grains; lengths in units of that radius R_g.
namespace neck {
	inline double filletRadius(double beta) { return beta * beta / (2 * (1 - beta)); } // x, S17 (1)
	inline double length(double beta)                                                  // d, S17 (2)
	{
		const double x = filletRadius(beta);
		return 2 * x / (1 + x);
	}
	// What the fillet adds between two touching spheres, over the volume of one.
	inline double volume(double beta)
	{
		const double x = filletRadius(beta), h = length(beta) / 2, c = beta + x; // the circle's centre lies c from the axis
		const double fillet =
		        2 * (h * c * c - c * (h * std::sqrt(x * x - h * h) + x * x * std::asin(h / x)) + x * x * h - h * h * h / 3);
		const double spheres = 2 * h * h * (1 - h / 3);
		return 0.75 * (fillet - spheres);
	}
	// R'/R_g: what is left of a grain's radius when it has given two necks (S17 section 3.3, Fig. 4)
	inline double shrunkRadius(double beta) { return beta > 0 ? cubeRoot(1 - 2 * volume(beta)) : 1; }
}

/* Ordinary contacts between grains that sintering has shrunk, r1 and r2 their radii before (beta = 0: as they are). Mass is conserved:
 * what the necks took counts as if it were in the grains still. */
inline PairConstants<double> deriveShrunkPair(
        Material material1, double radius1, Material material2, double radius2, const PairOptions& options, double beta)
{
	const double shrunk = neck::shrunkRadius(beta), volume = shrunk * shrunk * shrunk;
	material1.density /= volume;
	material2.density /= volume;
	return derivePair(material1, shrunk * radius1, material2, shrunk * radius2, options);
}

/* The constants of a bond, listed once: name and what it is. From this list follow the members below, the attributes of JKRWadaBond,
 * their copying, and what the engine holds of bonds in scenes with several kinds of pairs (engine/contact_lists.hpp). Names that the
 * mechanisms read are those of PairConstants. */
#define CONTACT_LAW_BOND_CONSTANTS(_)                                                                                                      \
	_(radius1, "Radius of the first grain before sintering [m].")                                                                      \
	_(radius2, "Radius of the second grain before sintering [m].")                                                                     \
	_(reducedRadius, "R = r1 r2/(r1+r2) of these [m].")                                                                                \
	_(neckRadius, "a [m].")                                                                                                            \
	_(neckLength, "d [m].")                                                                                                            \
	_(normalStiffness, "k_ss [N/m].")                                                                                                  \
	_(slidingStiffness, "k_st [N/m].")                                                                                                 \
	_(rollingStiffness, "k_sr/R^2 [N/m], on the rolling displacement R(n1+n2), whose length is R times the angle of the tilt.")        \
	_(twistingStiffness, "k_sw [N m].")                                                                                                \
	_(breakingEnergy, "pi a^2 gamma [J]: the bond breaks when one mode holds it.")                                                     \
	_(neck, "beta: neckRadius [m] over R_g = 2 r1 r2/(r1 + r2) [m].")

template <class T> struct BondConstants {
#define CONTACT_LAW_MEMBER(name, ...) T name;
	CONTACT_LAW_BOND_CONSTANTS(CONTACT_LAW_MEMBER)
};
template <class T>
constexpr T BondConstants<T>::*bondConstantsOf[] = {
#define CONTACT_LAW_ROW(name, ...) &BondConstants<T>::name,
	CONTACT_LAW_BOND_CONSTANTS(CONTACT_LAW_ROW)
#undef CONTACT_LAW_ROW
};

/* S17 (1)-(6). Unlike grains: R_g = 2 r1 r2/(r1 + r2), half of the disk of either material (1/E = mean of 1/E_i, G likewise), gamma as
 * for any contact. */
inline BondConstants<double> deriveBond(
        const Material& material1, double radius1, const Material& material2, double radius2, const PairOptions& options, double beta)
{
	const double E1 = material1.young, E2 = material2.young;
	const double G1 = E1 / (2 * (1 + material1.poisson)), G2 = E2 / (2 * (1 + material2.poisson));
	const double E = 2 * E1 * E2 / (E1 + E2), G = 2 * G1 * G2 / (G1 + G2);
	const double R = radius1 * radius2 / (radius1 + radius2), a = beta * 2 * R, d = neck::length(beta) * 2 * R, area = pi * a * a;
	BondConstants<double> b;
	b.radius1 = radius1;
	b.radius2 = radius2;
	b.reducedRadius = R;
	b.neckRadius = a;
	b.neckLength = d;
	b.normalStiffness = area * E / d;                        // S17 (3)
	b.slidingStiffness = area * G / d;                       // S17 (4)
	b.rollingStiffness = area * a * a * E / (4 * d * R * R); // S17 (5)
	b.twistingStiffness = area * a * a * G / (2 * d);        // polar moment of a disk; S17 is planar and has none
	b.neck = beta;
	b.breakingEnergy = area * surfaceEnergy(material1, material2, options);
	return b;
}

/* Forces of a bond from how far it is from where it was made: n1 = -n_c, n2 = n_c, no twist, the centres `rest` apart.
 * g: geometryOf(separation, rest), so that its overlap is how far the bond is pressed together. */
template <class T> inline ContactForces<T> bondForces(const BondConstants<T>& b, const ContactGeometry<T>& g, const ContactHistory<T>& h)
{
	ContactForces<T> f = ContactForces<T>::none();
	f.normalForce = b.normalStiffness * g.overlap;
	tangentialForces<AllSprings>(b, g, h, f);
	return f;
}

template <class T>
inline StoredEnergy<T> bondEnergy(const BondConstants<T>& b, const ContactGeometry<T>& g, const ContactForces<T>& f, const T& twist)
{
	return { T(0.5) * b.normalStiffness * g.overlap * g.overlap, springEnergy<SlidingSpring>(b, f.slidingDisplacement),
		springEnergy<RollingSpring>(b, f.rollingDisplacement), twisting::energy(b, twist) };
}

// ---- breaking ----

// Limit: a bond breaks when one mode alone holds pi a^2 gamma, whether the neck is stretched or pressed (S17 section 3.1, eq 6). gamma is per
// surface (F_c = 3 pi gamma R): the two surfaces that a break leaves have twice this energy.
template <class T> inline MaskOf<T> bondBreaks(const BondConstants<T>& b, const StoredEnergy<T>& e)
{
	return (b.breakingEnergy < e.normal) | (b.breakingEnergy < e.sliding) | (b.breakingEnergy < e.rolling)
	        | (b.breakingEnergy < e.twisting);
}

namespace bonds {
	struct Breaking {
		int mode = -1;       // none
		double fraction = 2; // of the step, after which it broke
	};

	// The mode that reaches its limit first within the step; g, f, twist: at its end.
	inline Breaking firstBreaking(const BondConstants<double>& b, const ContactBefore& before, const ContactGeometry<double>& g,
	        const ContactForces<double>& f, double twist)
	{
		Breaking first;
		const auto consider = [&](int mode, double stiffness, const Vec3<double>& then, const Vec3<double>& now) {
			if (0.5 * stiffness * dot(now, now) <= b.breakingEnergy) return;
			const double fraction = events::fractionUntilLength(then, now, 2 * b.breakingEnergy / stiffness);
			if (fraction < first.fraction) first = { mode, fraction };
		};
		consider(ByStretching, b.normalStiffness, { before.overlap, 0, 0 }, { g.overlap, 0, 0 });
		consider(BySliding, b.slidingStiffness, before.sliding, f.slidingDisplacement);
		consider(ByRolling, b.rollingStiffness, before.rolling, f.rollingDisplacement);
		consider(ByTwisting, b.twistingStiffness, { before.twist, 0, 0 }, { twist, 0, 0 });
		return first;
	}

	// Stored a step ago: by each mode no more than it can hold, as of a contact (letGo() of contact.hpp).
	inline double held(const BondConstants<double>& b, const ContactBefore& before)
	{
		const auto held = [&](double stiffness, double squared) { return std::min(0.5 * stiffness * squared, b.breakingEnergy); };
		return held(b.normalStiffness, before.overlap * before.overlap)
		        + held(b.slidingStiffness, dot(before.sliding, before.sliding))
		        + held(b.rollingStiffness, dot(before.rolling, before.rolling))
		        + held(b.twistingStiffness, before.twist * before.twist);
	}

	// The same, less the work of the springs' half kick then over the step.
	inline double heldAfterHalfKick(const BondConstants<double>& b, const ContactBefore& before, const ContactGeometry<double>& g,
	        const ContactForces<double>& f, double twist)
	{
		return 0.5
		        * (b.normalStiffness * before.overlap * g.overlap + b.slidingStiffness * dot(before.sliding, f.slidingDisplacement)
		                + b.rollingStiffness * dot(before.rolling, f.rollingDisplacement)
		                + b.twistingStiffness * before.twist * twist);
	}
}

// ---- stability ----

/* Steps from here on are unstable for two grains with one bond between them, and for it in any packing [s]: leapfrog is, at 2 over the fastest vibration.
 * The two against each other along the normal; across it, both turning with the motion, or against each other's turning (tilt, twist).
 * inverseMass: 1/m1 + 1/m2. */
inline double unstableStep(const BondConstants<double>& b, double inverseMass, double inverseInertia1, double inverseInertia2)
{
	const double r1 = b.radius1, r2 = b.radius2, R = b.reducedRadius, turning = inverseInertia1 + inverseInertia2;
	const double along = b.normalStiffness * inverseMass;
	const double across = b.slidingStiffness * (inverseMass + r1 * r1 * inverseInertia1 + r2 * r2 * inverseInertia2);
	const double tilt = b.rollingStiffness * R * R * turning, twist = b.twistingStiffness * turning;
	return 2 / std::sqrt(std::max({ along, across, tilt, twist }));
}

// ---- one step ----

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
		double existed = 0; // of the step, the new contact
		if (!torn) ahead.add(breaking.fraction - 0.5, breaking.fraction - 0.5, bondGeometry, bond);

		r.geometry = geometryOf(m.separation, c.radius1 + c.radius2);
		r.touching = r.geometry.overlap > 0;
		if (r.touching) {
			const double closing = bondGeometry.overlap - before.overlap, overlapBefore = r.geometry.overlap - closing;
			const double since = std::min(1 - breaking.fraction, overlapBefore < 0 ? r.geometry.overlap / closing : 1.);
			existed = since;
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
		r.dissipated.*bondModes[breaking.mode].lost =
		        released - ahead.workOnPair(m) + (after.squared(m) - ahead.squared(m)) * m.dt * m.dt / 2;
		r.force = ahead.force + after.force;
		r.torque1 = ahead.torque1 + after.torque1;
		r.torque2 = ahead.torque2 + after.torque2;
		if constexpr (bool(mechanisms & SpringDamping))
			if (r.touching) spring_damping::add(c, m, {}, h, existed, false, r);
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

constexpr BondStep bondStepWith[mechanismSets] = CONTACT_LAW_ALL_MECHANISMS(bondStep);

} // namespace contact_law
