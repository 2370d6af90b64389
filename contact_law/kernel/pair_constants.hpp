// What two materials and two radii make of a contact: derived once for each pair, and read by every step.
// Symbols and sources: MODEL.md. A22 = Arakawa et al. 2022, K13 = Kataoka et al. 2013.
#pragma once
#include "numbers.hpp"
#include <algorithm>
#include <cmath>

namespace contact_law {

constexpr double pi = 3.14159265358979323846;
constexpr double criticalTwistingAngle = 1 / (16 * pi); // A22 (24), of every pair

// The constants of a material, listed once: name, and symbol with its unit.
#define CONTACT_LAW_MATERIAL(_)                                                                                                            \
	_(young, "E [Pa]")                                                                                                                 \
	_(poisson, "nu")                                                                                                                   \
	_(density, "rho [kg/m^3]")                                                                                                         \
	_(surfaceEnergy, "gamma [J/m^2]")                                                                                                  \
	_(criticalRolling, "xi_crit [m]")                                                                                                  \
	_(viscoelasticTime, "T_vis [s]")

struct Material {
#define CONTACT_LAW_NUMBER(name, ...) double name;
	CONTACT_LAW_MATERIAL(CONTACT_LAW_NUMBER)
};

/* What a scene sets for all its pairs, whatever they are made of, listed once: name, default, and what it is. From this list follow the
 * members below, the attributes of functor and engine, and what a checkpoint compares. */
#define CONTACT_LAW_PAIR_OPTIONS(_)                                                                                                        \
	_(linearDamping, 0, "k_n of the linear normal damping force -k_n (m0/t0) v (Kataoka et al. 2013, eq. 4); 0: none.")                \
	_(slidingStiffnessFactor, 1,                                                                                                       \
	        "k_s of ordinary contacts over 8 a0 G*. 1: Wada et al. (2007); 2: eqs 11 and 12 of Sirono & Ueno "                         \
	        "(2017) as printed.")                                                                                                      \
	_(rollingStiffnessFactor, 1, "k_r of ordinary contacts over 4 F_c/R (Wada et al. 2007).")                                          \
	_(springDamping, 0,                                                                                                                \
	        "Damps sliding, rolling and twisting springs of ordinary contacts: c of the force k c dD/dt beside k D [s]; 0: they "      \
	        "ring on.")                                                                                                                \
	_(mixedSurfaceEnergyFactor, 1, "Surface energy of a contact or bond of two unlike materials over the geometric mean of theirs.")

struct PairOptions {
#define CONTACT_LAW_OPTION(name, usual, ...) double name = usual;
	CONTACT_LAW_PAIR_OPTIONS(CONTACT_LAW_OPTION)
};

inline bool areAlike(const Material& a, const Material& b)
{
#define CONTACT_LAW_UNLIKE(name, ...)                                                                                                      \
	if (a.name != b.name) return false;
	CONTACT_LAW_MATERIAL(CONTACT_LAW_UNLIKE)
	return true;
}
inline double surfaceEnergy(const Material& a, const Material& b, const PairOptions& options)
{
	const double mean = std::sqrt(a.surfaceEnergy) * std::sqrt(b.surfaceEnergy);
	return areAlike(a, b) ? mean : options.mixedSurfaceEnergyFactor * mean;
}

/* The constants of a contact, listed once: name, whether a step's forces read it, and what it is. From this list follow the members
 * below, the attributes of JKRWadaConstants, their copying, and what the engine holds of a contact in scenes with several kinds of pairs
 * (engine/arrays.hpp). */
#define CONTACT_LAW_PAIR_CONSTANTS(_)                                                                                                      \
	_(radius1, true, "Radius of the first grain [m].")                                                                                 \
	_(radius2, true, "Radius of the second grain [m]; inf: a plane.")                                                                  \
	_(reducedRadius, true, "R = r1 r2/(r1+r2) [m].")                                                                                   \
	_(reducedMass, false, "m* = m1 m2/(m1+m2) of solid spheres [kg].")                                                                 \
	_(reducedYoung, false, "E* [Pa]: 1/E* = sum of (1-nu^2)/E.")                                                                       \
	_(reducedShear, false, "G* [Pa]: 1/G* = sum of (2-nu)/G.")                                                                         \
	_(equilibriumContactRadius, true, "a0 [m].")                                                                                       \
	_(equilibriumOverlap, false, "delta0 [m]: overlap at which the normal force vanishes.")                                            \
	_(pullOffOverlap, false, "delta_c [m]: the contact ends when the overlap falls below -delta_c.")                                   \
	_(pullOffForce, true, "F_c [N]: the largest pull.")                                                                                \
	_(rollingStiffness, true, "k_r [N/m].")                                                                                            \
	_(slidingStiffness, true, "k_s [N/m].")                                                                                            \
	_(twistingStiffness, true, "k_t [N m].")                                                                                           \
	_(criticalSliding, true, "zeta_crit [m].")                                                                                         \
	_(criticalRolling, true, "xi_crit [m].")                                                                                           \
	_(criticalTwisting, false, "phi_crit [rad].")                                                                                      \
	_(dragPerContactRadius, true, "2 T_vis E*/nu^2 [N s/m^2].")                                                                        \
	_(linearDrag, true, "k_n m0/t0 [N s/m].")                                                                                          \
	_(timeUnit, false, "t0 [s].")                                                                                                      \
	_(springDamping, false, "c [s]: beside k D springs have k c dD/dt.")

template <class T> struct PairConstants {
#define CONTACT_LAW_MEMBER(name, ...) T name;
	CONTACT_LAW_PAIR_CONSTANTS(CONTACT_LAW_MEMBER)
	T inverseEquilibriumOverlap; // 1/delta0 [1/m], because a division is expensive; no attribute of its own

	ON_GPU void complete() { inverseEquilibriumOverlap = 1 / equilibriumOverlap; } // from the attributes
};

// A constant, and whether a step's forces read it.
template <class T> struct PairConstant {
	T PairConstants<T>::*member;
	bool readByForces;
};
template <class T>
constexpr PairConstant<T> pairConstantsOf[] = {
#define CONTACT_LAW_ROW(name, readByForces, ...) { &PairConstants<T>::name, readByForces },
	CONTACT_LAW_PAIR_CONSTANTS(CONTACT_LAW_ROW)
#undef CONTACT_LAW_ROW
	        { &PairConstants<T>::inverseEquilibriumOverlap, true },
};

/* Unlike grains. The elastic moduli follow from contact mechanics: 1/E* = sum (1 - nu^2)/E, 1/G* = sum (2 - nu)/G,
 * 1/G' = sum 1/G. The sliding limit is the force G' a0^2/(2 pi), which is (2 - nu) a0/(16 pi) over k_s for equal materials
 * (A22 eqs 18, 19). The rest is a rule: geometric mean of the surface energies (times a factor that a script gives), arithmetic mean of xi_crit and of the
 * viscous coefficient T_vis/nu^2. A time unit for two unlike grains is that of equal ones of radius 2R and mass 2m*.
 * An infinite radius2 is a plane: R = r1, m* = m1. */
inline PairConstants<double> derivePair(
        const Material& material1, double radius1, const Material& material2, double radius2, const PairOptions& options = {})
{
	const Material &m1 = material1, &m2 = material2;
	const double G1 = m1.young / (2 * (1 + m1.poisson)), G2 = m2.young / (2 * (1 + m2.poisson));
	const double twistingShear = 1 / (1 / G1 + 1 / G2); // G'
	const double gamma = surfaceEnergy(m1, m2, options);
	const double mass1 = 4 * pi / 3 * m1.density * radius1 * radius1 * radius1;
	const double mass2 = 4 * pi / 3 * m2.density * radius2 * radius2 * radius2;
	const auto viscous = [](const Material& m) { return m.viscoelasticTime > 0 ? m.viscoelasticTime / (m.poisson * m.poisson) : 0.; };
	const double viscosity = (viscous(m1) + viscous(m2)) / 2;

	PairConstants<double> c;
	c.radius1 = radius1;
	c.radius2 = radius2;
	const bool plane = std::isinf(radius2);
	c.reducedRadius = plane ? radius1 : radius1 * radius2 / (radius1 + radius2);
	c.reducedMass = plane ? mass1 : mass1 * mass2 / (mass1 + mass2);
	c.reducedYoung = 1 / ((1 - m1.poisson * m1.poisson) / m1.young + (1 - m2.poisson * m2.poisson) / m2.young);
	c.reducedShear = 1 / ((2 - m1.poisson) / G1 + (2 - m2.poisson) / G2);

	const double R = c.reducedRadius;
	c.equilibriumContactRadius = cubeRoot(9 * pi * gamma * R * R / c.reducedYoung); // A22 (1)
	const double a0 = c.equilibriumContactRadius;
	c.equilibriumOverlap = a0 * a0 / (3 * R);
	c.pullOffOverlap = std::cbrt(9. / 16.) * c.equilibriumOverlap;                 // A22 (3)
	c.pullOffForce = 3 * pi * gamma * R;                                           // A22 (6)
	c.rollingStiffness = options.rollingStiffnessFactor * 4 * c.pullOffForce / R;  // A22 (14)
	c.slidingStiffness = options.slidingStiffnessFactor * 8 * a0 * c.reducedShear; // A22 (18)
	c.twistingStiffness = 16. / 3. * twistingShear * a0 * a0 * a0;                 // A22 (23)
	c.criticalSliding = twistingShear / c.reducedShear * a0 / (16 * pi);           // A22 (19)
	c.criticalRolling = (m1.criticalRolling + m2.criticalRolling) / 2;
	c.criticalTwisting = criticalTwistingAngle;
	c.dragPerContactRadius = 2 * viscosity * c.reducedYoung; // A22 (7)

	const double mass = 2 * c.reducedMass, radius = 2 * R;
	const double density = mass / (4 * pi / 3 * radius * radius * radius);
	// K13 (2) with E* for E (see MODEL.md)
	c.timeUnit = 0.95 * std::sqrt(density) * std::pow(radius, 7. / 6.) / (cubeRoot(c.reducedYoung) * std::pow(gamma, 1. / 6.));
	c.linearDrag = options.linearDamping * mass / c.timeUnit; // K13 (4)
	c.springDamping = options.springDamping;
	c.complete();
	return c;
}

/* Steps from here on are unstable for such a pair, in whatever packing [s] (MODEL.md, "Step limits"): half a time unit, at which collisions were seen to blow
 * up, or m* over the drag coefficient, where drag overshoots with its velocity extrapolated; where springs are damped, that of the pair's fastest vibration by them. NaN where the time unit is. lightness: mass of the grains (or moment of
 * inertia) over that of solid spheres of their materials, where it is less. */
inline double unstableStep(const PairConstants<double>& c, double lightness = 1)
{
	const double drag = c.dragPerContactRadius * c.equilibriumContactRadius + c.linearDrag;
	const double undamped = std::min(0.5 * c.timeUnit * std::sqrt(lightness), drag > 0 ? lightness * c.reducedMass / drag : 1e300);
	const double time = c.springDamping, ofTwisting = c.twistingStiffness / (c.reducedRadius * c.reducedRadius);
	if (time == 0) return undamped;
	const double stiffness = std::max({ 3.5 * c.slidingStiffness, 2.5 * c.rollingStiffness, 2.5 * ofTwisting });
	return std::min(undamped, 2 * (std::sqrt(time * time + lightness * c.reducedMass / stiffness) - time));
}
inline double massByInertia(double inertia, double radius) { return inertia / (0.4 * radius * radius); } // of a solid sphere
inline double lightness(double mass, double ofSolid)
{
	constexpr double rounding = 1e-9;
	return mass < (1 - rounding) * ofSolid ? mass / ofSolid : 1;
}

} // namespace contact_law
