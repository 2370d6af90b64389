// The order in which grains are stored: along a space-filling curve, of which each domain takes a stretch.
#include "dynamics.hpp"
#include <algorithm>
#include <numeric>

namespace contact_law {

namespace {
	// Interleaved bits of three cell numbers: grains close in this order are close in space.
	std::uint64_t spread(std::uint64_t x)
	{
		x &= 0x1fffff;
		x = (x | x << 32) & 0x1f00000000ffffULL;
		x = (x | x << 16) & 0x1f0000ff0000ffULL;
		x = (x | x << 8) & 0x100f00f00f00f00fULL;
		x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
		return (x | x << 2) & 0x1249249249249249ULL;
	}
}

/* Cells of about a grain's diameter, a power of two of them along the longest axis: the order's halves then meet where that axis is halved, and of two
 * like aggregates each is a half. (Cells of just a diameter put 5 % of the contacts across the border of two domains.) */
void Dynamics::orderGrains(const std::vector<GrainInput>& grains)
{
	double low[3], high[3], smallest = grains[0].radius;
	for (int k = 0; k < 3; ++k)
		low[k] = high[k] = grains[0].position[k];
	for (const auto& g : grains) {
		smallest = std::min(smallest, g.radius);
		for (int k = 0; k < 3; ++k) {
			low[k] = std::min(low[k], g.position[k]);
			high[k] = std::max(high[k], g.position[k]);
		}
	}
	const double longest = std::max({ high[0] - low[0], high[1] - low[1], high[2] - low[2] });
	std::uint64_t cells = 1;
	while (cells < (1u << 21) && double(cells) * 2.5 * smallest < longest)
		cells *= 2;
	const double cellsPerLength = longest > 0 ? double(cells) / longest : 0;
	std::vector<std::uint64_t> keys(count);
	for (int g = 0; g < count; ++g) {
		keys[g] = 0;
		for (int k = 0; k < 3; ++k)
			keys[g] |= spread(std::min(std::uint64_t((grains[g].position[k] - low[k]) * cellsPerLength), cells - 1)) << k;
	}
	original.resize(count);
	std::iota(original.begin(), original.end(), 0);
	std::sort(original.begin(), original.end(), [&](int a, int b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
}

} // namespace contact_law
