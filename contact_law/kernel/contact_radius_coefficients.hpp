// The root u = (a/a0)^(1/2) of 3u^4 - 2u = delta/delta0, as a polynomial in t: it interpolates the root at the 23 Chebyshev nodes, computed in
// 50-digit arithmetic. (tests/kernel compares it with roots found another way.)
#pragma once

namespace contact_law {

constexpr double largestFittedOverlap = 4;         // in units of the equilibrium overlap
constexpr double fittedScale = 0.9104574503644945; // t = fittedScale * y - 1
TABLE_ON_GPU constexpr double contactRadiusCoefficients[23] = {
	// of 1, t, t^2, ...
	0.9295726463451909,
	0.3158457918720127,
	-0.04519761207508414,
	0.01212297509907421,
	-0.00390807667173459,
	0.0013704575448902224,
	-0.0005024507222435101,
	0.00018870930656110423,
	-7.170104227390265e-05,
	2.7311701866027882e-05,
	-1.0349658265297492e-05,
	3.874356962501663e-06,
	-1.4165239207293003e-06,
	4.895173064292794e-07,
	-1.6068080394350048e-07,
	6.282424320834205e-08,
	-1.752992307076168e-08,
	-1.497833561419492e-08,
	9.25881723100515e-09,
	7.534724200189055e-09,
	-3.2870854740101802e-09,
	-3.686950094936537e-09,
	1.8287855122468886e-09,
};

} // namespace contact_law
