// Geometry of a sintered neck (Sirono & Ueno 2017, "S17", section 3), and what it takes from the grains.
#pragma once
#include "pair_constants.hpp"

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

} // namespace contact_law
