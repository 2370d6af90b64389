// Grains sorted into cubic cells, to find neighbours.
#pragma once
#include "arrays.hpp"
#include <cmath>
#include <cstdint>

namespace contact_law {

class Grid {
public:
	// Cells of the given size around the first `count` grains; coarser where the box is so large that cells would be far more than grains.
	void build(const Grain* grains, int count, double cellSize)
	{
		double low[3] = { grains[0].x, grains[0].y, grains[0].z }, high[3] = { low[0], low[1], low[2] };
		for (int g = 0; g < count; ++g) {
			const double* x = &grains[g].x;
			for (int k = 0; k < 3; ++k) {
				low[k]  = x[k] < low[k] ? x[k] : low[k];
				high[k] = x[k] > high[k] ? x[k] : high[k];
			}
		}
		inverseSize = 1 / cellSize;
		for (;;) {
			double cells = 1;
			for (int k = 0; k < 3; ++k) {
				origin[k] = low[k];
				cells *= size[k] = int((high[k] - low[k]) * inverseSize) + 1;
			}
			if (cells <= 64. * count + 4096) break;
			inverseSize *= 0.8;
		}
		start.assign(std::size_t(size[0]) * size[1] * size[2] + 1, 0);
		cellOf.resize(count);
		members.resize(count);
		for (int g = 0; g < count; ++g)
			++start[(cellOf[g] = cellAt(&grains[g].x)) + 1];
		for (std::size_t c = 1; c < start.size(); ++c)
			start[c] += start[c - 1];
		std::vector<int> filled(start.begin(), start.end() - 1);
		for (int g = 0; g < count; ++g)
			members[filled[cellOf[g]]++] = g;
	}

	// Calls visit(grain) for every grain in the 27 cells around position x.
	template <class Visit> void around(const double* x, Visit&& visit) const
	{
		int at[3];
		for (int k = 0; k < 3; ++k)
			at[k] = int((x[k] - origin[k]) * inverseSize);
		for (int c = at[2] - 1; c <= at[2] + 1; ++c)
			for (int b = at[1] - 1; b <= at[1] + 1; ++b) {
				if (c < 0 || b < 0 || c >= size[2] || b >= size[1]) continue;
				const int first = at[0] > 0 ? at[0] - 1 : 0, last = at[0] + 1 < size[0] ? at[0] + 1 : size[0] - 1;
				const int row = (c * size[1] + b) * size[0];
				for (int m = start[row + first]; m < start[row + last + 1]; ++m)
					visit(members[m]);
			}
	}

private:
	int cellAt(const double* x) const
	{
		int at[3];
		for (int k = 0; k < 3; ++k)
			at[k] = int((x[k] - origin[k]) * inverseSize);
		return (at[2] * size[1] + at[1]) * size[0] + at[0];
	}

	double           origin[3] {}, inverseSize = 1;
	int              size[3] { 1, 1, 1 };
	std::vector<int> start, members, cellOf;
};

} // namespace contact_law
