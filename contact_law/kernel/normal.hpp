// Normal motion of two adhesive elastic spheres (Johnson, Kendall & Roberts 1971): elastic force, energy, and the contact's formation and
// pull-off.
// In units that make it one function for all pairs: overlap/delta0, force/F_c, energy/(F_c delta_c), each through u = (a/a0)^(1/2). A22 eqs
// 2, 5, 8; A24 eqs 5, 6.
#pragma once
#include "contact_state.hpp"
#include "pair_constants.hpp"

namespace contact_law {

// The root u = (a/a0)^(1/2) of 3u^4 - 2u = delta/delta0, as a polynomial in t: it interpolates the root at the 23 Chebyshev nodes, computed in
// 50-digit arithmetic. (tests/kernel compares it with roots found another way.)
constexpr double largestFittedOverlap = 4;         // in units of the equilibrium overlap
constexpr double fittedScale = 0.9104574503644945; // t = fittedScale * y - 1
// of 1, t, t^2, ...
TABLE_ON_GPU constexpr double contactRadiusCoefficients[23] = { 0.9295726463451909, 0.3158457918720127, -0.04519761207508414,
	0.01212297509907421, -0.00390807667173459, 0.0013704575448902224, -0.0005024507222435101, 0.00018870930656110423,
	-7.170104227390265e-05, 2.7311701866027882e-05, -1.0349658265297492e-05, 3.874356962501663e-06, -1.4165239207293003e-06,
	4.895173064292794e-07, -1.6068080394350048e-07, 6.282424320834205e-08, -1.752992307076168e-08, -1.497833561419492e-08,
	9.25881723100515e-09, 7.534724200189055e-09, -3.2870854740101802e-09, -3.686950094936537e-09, 1.8287855122468886e-09 };

namespace normal {

	constexpr double pullOffRatio = 0.8254818122236567; // delta_c/delta0 = (9/16)^(1/3), A22 (3)

	// overlap/delta0 for a given u
	template <class T> inline T overlap(const T& u) { return T(3.) * (u * u) * (u * u) - T(2.) * u; }

	// c[0] + c[1] t + ... + c[22] t^22 as four polynomials in t^4 side by side: a quarter of the waiting of Horner's one chain.
	template <class T> inline T polynomial(const double (&c)[23], const T& t)
	{
		const T square = t * t, fourth = square * square;
		T part[4] = { T(c[20]), T(c[21]), T(c[22]), T(c[19]) };
		for (int first = 16; first >= 0; first -= 4) {
			for (int k = 0; k < 3; ++k)
				part[k] = part[k] * fourth + T(c[first + k]);
			if (first > 0) part[3] = part[3] * fourth + T(c[first - 1]);
		}
		return part[0] + part[1] * t + (part[2] + part[3] * t) * square;
	}

	/* u for a given overlap/delta0 >= -(9/16)^(1/3), on the branch u >= 6^(-1/3): a polynomial in
 * y = (overlap/delta0 + (9/16)^(1/3))^(1/2), in which the branch point at pull-off is smooth; beyond the fitted range Newton's method. */
	template <class T> inline T rootOfContactRadius(const T& overlap)
	{
		const T shifted = choose(overlap < T(largestFittedOverlap), overlap, T(largestFittedOverlap)) + T(pullOffRatio);
		const T t = T(fittedScale) * root(choose(T(0.) < shifted, shifted, T(0.))) - T(1.);
		T u = polynomial(contactRadiusCoefficients, t);
		const auto beyond = T(largestFittedOverlap) < overlap;
		if (anyOf(beyond)) {
			T far = root(root(overlap * T(1. / 3.) + T(1.)));
			for (int iteration = 0; iteration < 6; ++iteration)
				far = far - (normal::overlap(far) - overlap) / (T(12.) * far * far * far - T(2.));
			u = choose(beyond, far, u);
		}
		return u;
	}

	// force/F_c, positive when repulsive (A22 eq 5)
	template <class T> inline T force(const T& u)
	{
		const T cube = u * u * u;
		return T(4.) * cube * (cube - T(1.));
	}

	// stored energy/(F_c delta_c), zero for separated grains (A22 eq 8)
	template <class T> inline T energy(const T& u)
	{
		const T square = u * u, cube = square * u, fourth = square * square;
		return T(4. * 1.8171205928321397) * fourth * (T(0.8) * cube * cube - T(4. / 3.) * cube + T(1. / 3.));
	}

	constexpr double energyAtConnection = -0.8466138943830397; // -(8/15) 2^(2/3), A22 eq 9
	constexpr double energyAtPullOff = 4. / 45.;               // A22 eq 10

	/* Just before pull-off the force is F(-delta_c) + pullOffSlope F_c (x/delta0)^(1/2), x = overlap + delta_c. A sum over steps h
	 * that ends at x = fraction * h (trapezoidal rule) misses the integral of x^(1/2) by h^(3/2) times the value returned here,
	 * whatever the steps before (Euler-Maclaurin at a branch point; Hurwitz's zeta(-1/2, fraction) is summed over its first terms). */
	constexpr double pullOffSlope = -1.0376956216346809; // -8 u/18^(1/2) at u = 6^(-1/3)
	inline double sumMinusIntegralAtPullOff(double fraction)
	{
		constexpr int terms = 8;
		double zeta = 0;
		for (int k = 0; k < terms; ++k)
			zeta += std::sqrt(fraction + k);
		const double rest = fraction + terms, squareRoot = std::sqrt(rest);
		zeta += squareRoot * (0.5 - 2. / 3. * rest) - 1 / (24 * squareRoot) + 1 / (1920 * squareRoot * rest * rest);
		return zeta + std::sqrt(fraction) * (2. / 3. * fraction - 0.5);
	}

	// ---- of a pair ----

	// The contact radius's root u and the elastic force along n_c on grain 1.
	template <class T> inline void addForces(const PairConstants<T>& c, const ContactGeometry<T>& g, ContactForces<T>& f)
	{
		f.contactRadiusRoot = rootOfContactRadius(g.overlap * c.inverseEquilibriumOverlap);
		f.normalForce = c.pullOffForce * force(f.contactRadiusRoot);
	}
	template <class T> inline T energyUnit(const PairConstants<T>& c) { return c.pullOffForce * c.pullOffOverlap; }
	template <class T> inline T energy(const PairConstants<T>& c, const T& contactRadiusRoot)
	{
		return energyUnit(c) * energy(contactRadiusRoot);
	}

	// Limit: a contact that exists is lost beyond pull-off.
	inline bool beyondPullOff(const PairConstants<double>& c, const ContactGeometry<double>& g)
	{
		return g.overlap < -c.pullOffOverlap;
	}

	// Force times the fraction of a step since a contact formed, whose overlap changed by `closing` in the whole step: from the energy
	// stored since, f F = [U(delta) - U(0)]/closing.
	inline double forceSinceFormation(const PairConstants<double>& c, double stored, double closing)
	{
		return (stored - energyUnit(c) * energyAtConnection) / closing;
	}
	// What connection takes: -U(0), and what a leapfrog loses when the half kicks (impulses) before and after this instant are not
	// equal.
	inline double connection(const PairConstants<double>& c, double impulseBefore, double impulseAfter, double inverseMass)
	{
		return -energyUnit(c) * energyAtConnection
		        + (impulseAfter * impulseAfter - impulseBefore * impulseBefore) * inverseMass / 2;
	}

	/* Of a contact that breaks after a fraction of the step in which its overlap falls by `opening`: the force times that fraction,
	 * from the energy (which the branch point at pull-off leaves smooth), less the half step that was given a step ago; and what the
	 * steps before missed of the force's last rise. */
	struct Breaking {
		double force, missed;
	};
	inline Breaking forceUntilBreaking(const PairConstants<double>& c, double overlapBefore, double opening, double fraction)
	{
		const double u = rootOfContactRadius(overlapBefore / c.equilibriumOverlap);
		const double work = energyUnit(c) * (energy(u) - energyAtPullOff);
		const double missed = c.pullOffForce * pullOffSlope * std::sqrt(opening * c.inverseEquilibriumOverlap)
		        * sumMinusIntegralAtPullOff(fraction);
		return { work / opening - c.pullOffForce * force(u) / 2, missed };
	}
	// What disconnection takes of the normal motion: U(-delta_c), and what a leapfrog loses by the one kick that has no other half.
	inline double disconnection(const PairConstants<double>& c, double impulse, double inverseMass)
	{
		return energyUnit(c) * energyAtPullOff - impulse * impulse * inverseMass / 2;
	}

} // namespace normal
} // namespace contact_law
