// Sintered bonds (Sirono & Ueno 2017, "S17"; MODEL.md, "Sintered bonds"): an elastic disk between two rigid grains, which breaks at once. Geometry, constants, forces and energies.
#pragma once
#include "contact.hpp"

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
	inline double shrunkRadius(double beta) { return beta > 0 ? std::cbrt(1 - 2 * volume(beta)) : 1; }
}

/* Ordinary contacts between grains that sintering has shrunk, r1 and r2 their radii before (beta = 0: as they are). Mass is conserved: what the necks took
 * counts as if it were in the grains still. */
inline PairConstants<double> deriveShrunkPair(
        Material material1, double radius1, Material material2, double radius2, double linearDamping, double beta)
{
	const double shrunk = neck::shrunkRadius(beta), volume = shrunk * shrunk * shrunk;
	material1.density /= volume;
	material2.density /= volume;
	return derivePair(material1, shrunk * radius1, material2, shrunk * radius2, linearDamping);
}

// Derived once for each kind of pair. Names that tangentialForces() reads are those of PairConstants.
template <class T> struct BondConstants {
	T radius1, radius2, reducedRadius; // before the grains shrank [m]
	T neckRadius, neckLength;          // a, d [m]
	T normalStiffness;                 // k_ss [N/m]
	T slidingStiffness;                // k_st [N/m]
	T rollingStiffness;                // k_sr/R^2 [N/m]: on xi = R(n1 + n2), whose length is R times the angle of the tilt
	T twistingStiffness;               // k_sw [N m]
	T breakingEnergy;                  // pi a^2 gamma [J]
};

/* S17 (1)-(6). Unlike grains: R_g = 2 r1 r2/(r1 + r2), half of the disk of either material (1/E = mean of 1/E_i, G likewise), gamma as for any contact. */
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
	b.breakingEnergy = area * std::sqrt(material1.surfaceEnergy) * std::sqrt(material2.surfaceEnergy);
	return b;
}

/* Forces of a bond from how far it is from where it was made: n1 = -n_c, n2 = n_c, no twist, the centres `rest` apart.
 * g: geometryOf(separation, rest), so that its overlap is how far the bond is pressed together. */
template <class T> inline ContactForces<T> bondForces(const BondConstants<T>& b, const ContactGeometry<T>& g, const ContactHistory<T>& h)
{
	const Vec3<T> none { T(0.), T(0.), T(0.) };
	ContactForces<T> f { T(0.), T(0.), none, none, none, T(0.), none, none };
	f.normalForce = b.normalStiffness * g.overlap;
	tangentialForces<AllSprings>(b, g, h, f);
	return f;
}

template <class T>
inline StoredEnergy<T> bondEnergy(const BondConstants<T>& b, const ContactGeometry<T>& g, const ContactForces<T>& f, const T& twist)
{
	return { T(0.5) * b.normalStiffness * g.overlap * g.overlap,
		T(0.5) * b.slidingStiffness * dot(f.slidingDisplacement, f.slidingDisplacement),
		T(0.5) * b.rollingStiffness * dot(f.rollingDisplacement, f.rollingDisplacement),
		T(0.5) * b.twistingStiffness * twist * twist };
}

// Whether a bond breaks: when one mode alone holds what the neck's surfaces cost (S17 section 3.1).
template <class T> inline MaskOf<T> bondBreaks(const BondConstants<T>& b, const StoredEnergy<T>& e)
{
	return (b.breakingEnergy < e.normal) | (b.breakingEnergy < e.sliding) | (b.breakingEnergy < e.rolling)
	        | (b.breakingEnergy < e.twisting);
}

} // namespace contact_law
