// Sintered bonds (Sirono & Ueno 2017, "S17", section 3; MODEL.md, "Sintered bonds"): an elastic disk between two rigid grains, which breaks
// at once.
// Constants, displacements, forces, energies, the limit of each mode, and the stability of a step.
#pragma once
#include "contact.hpp"
#include "events.hpp"
#include "neck.hpp"
#include <algorithm>

namespace contact_law {

/* The constants of a bond, listed once: name and what it is. From this list follow the members below, the attributes of JKRWadaBond,
 * their copying, and what the engine holds of bonds in scenes with several kinds of pairs (engine/bond_list.hpp). Names that the
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
inline BondConstants<double> deriveBond(const Material& material1, double radius1, const Material& material2, double radius2, double beta)
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
	b.breakingEnergy = area * std::sqrt(material1.surfaceEnergy) * std::sqrt(material2.surfaceEnergy);
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
	return { T(0.5) * b.normalStiffness * g.overlap * g.overlap, sliding::energy(b, f.slidingDisplacement),
		rolling::energy(b, f.rollingDisplacement), twisting::energy(b, twist) };
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

} // namespace contact_law
