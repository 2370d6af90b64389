/* Grains sorted into cells, to find neighbours. Made in parts that threads share: each stretch of grains counts and places its own.
 * Where the cells around all grains would be far more than grains (fragments apart), several cells take the same place in a table of some four places a grain: neighbours are then
 * looked for among a few strangers too, and may be met twice. */
#pragma once
#include "arrays.hpp"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace contact_law {

// Grains of a grid, those of a cell side by side, and cells of a row likewise.
struct GridMembers {
	const double *x, *y, *z, *radius;
	const int* grain;
};
struct GridRow {
	int first, last; // members, the last one not among them
};
// A grain at a position, and the rows of members around it.
struct NeighbourSearch {
	GridMembers members;
	const PeriodicCell* cell;
	double radius, gap; // between surfaces
	const double* position;
	GridRow rows[36]; // 27 cells in 9 rows, each of one or two parts, each of which the table's end may cut in two
	int rowCount;

	int most() const // members to look at
	{
		int sum = 0;
		for (int k = 0; k < rowCount; ++k)
			sum += rows[k].last - rows[k].first;
		return sum;
	}
};

class Grid {
public:
	/* A grid is made by these, each for all parts (stretches of grains by rising index) before the next, begin and layOut once; the parts of one may run side by side.
	 * In each cell members stand in the order of their indices, however many parts there are. */
	void begin(int parts_, int count_)
	{
		count = count_;
		parts.resize(parts_);
	}
	void measure(int part, const Grain* grains, int first, int last)
	{
		Part& p = parts[part];
		p.first = first, p.last = last;
		for (int k = 0; k < 3; ++k)
			p.low[k] = p.high[k] = (&grains[first].x)[k];
		for (int g = first; g < last; ++g) {
			const double* x = &grains[g].x;
			for (int k = 0; k < 3; ++k) {
				p.low[k] = std::min(p.low[k], x[k]);
				p.high[k] = std::max(p.high[k], x[k]);
			}
		}
	}
	// Cells of at least the given size around the grains, or filling the periodic cell.
	void layOut(double cellSize, const PeriodicCell& periodicCell)
	{
		double low[3], high[3];
		for (int k = 0; k < 3; ++k) {
			low[k] = parts[0].low[k], high[k] = parts[0].high[k];
			for (const Part& p : parts)
				low[k] = std::min(low[k], p.low[k]), high[k] = std::max(high[k], p.high[k]);
			extent[k] = high[k] - low[k];
		}
		periodic = periodicCell.on;
		const double lengths[3] = { periodicCell.size.x, periodicCell.size.y, periodicCell.size.z };
		double cells = 1;
		for (int k = 0; k < 3; ++k) {
			length[k] = lengths[k];
			origin[k] = periodic ? 0 : low[k];
			size[k] = periodic ? std::max(1, int(std::min(length[k] / cellSize, 1e6)))
			                   : int(std::min((high[k] - low[k]) / cellSize, 1e6)) + 1;
			inverseSize[k] = periodic ? size[k] / length[k] : 1 / cellSize;
			cells *= size[k];
		}
		const bool own = cells <= 4. * count + 64; // a place for each cell
		places = 64;
		while (places < (own ? cells : 4. * count))
			places *= 2;
		stride[0] = own ? size[0] : 73856093; // or primes, which put rows of cells anywhere
		stride[1] = own ? size[0] * size[1] : 19349663;
		start.resize(places + 1);
		placeOf.resize(count);
		members.resize(count);
		for (auto* numbers : { &x, &y, &z, &radius })
			numbers->resize((count + lanes - 1) / lanes * lanes);
	}
	void countGrains(int part, const Grain* grains)
	{
		Part& p = parts[part];
		p.next.assign(places, 0);
		for (int g = p.first; g < p.last; ++g)
			++p.next[placeOf[g] = placeAt(&grains[g].x)];
	}
	// A part sums up a fraction of the places.
	void sum(int part)
	{
		int total = 0;
		for (const Part& p : parts)
			for (unsigned c = firstPlace(part); c < firstPlace(part + 1); ++c)
				total += p.next[c];
		parts[part].total = total;
	}
	void findStarts(int part)
	{
		int next = 0;
		for (int before = 0; before < part; ++before)
			next += parts[before].total;
		for (unsigned c = firstPlace(part); c < firstPlace(part + 1); ++c) {
			start[c] = next;
			for (Part& p : parts) {
				const int here = p.next[c];
				p.next[c] = next;
				next += here;
			}
		}
		if (part + 1 == int(parts.size())) start[places] = count;
	}
	void place(int part, const Grain* grains, const double* radii)
	{
		Part& p = parts[part];
		for (int g = p.first; g < p.last; ++g) {
			const int at = p.next[placeOf[g]]++;
			members[at] = g, radius[at] = radii[g];
			x[at] = grains[g].x, y[at] = grains[g].y, z[at] = grains[g].z;
		}
	}

	// A search for neighbours of a grain in the 27 cells (or as many as there are) around it.
	NeighbourSearch search(const double* position, double ownRadius, double gap, const PeriodicCell& cell) const
	{
		NeighbourSearch s { { x.data(), y.data(), z.data(), radius.data(), members.data() }, &cell, ownRadius, gap, position, {},
			0 };
		Span spans[3][2];
		int parts[3];
		for (int k = 0; k < 3; ++k)
			parts[k] = spansAround(k, cellAlong(k, position[k]), spans[k]);
		for (int c = 0; c < parts[2]; ++c)
			for (int high = spans[2][c].first; high <= spans[2][c].last; ++high)
				for (int b = 0; b < parts[1]; ++b)
					for (int middle = spans[1][b].first; middle <= spans[1][b].last; ++middle)
						for (int a = 0; a < parts[0]; ++a)
							addRow(s, placeOfCell(spans[0][a].first, middle, high),
							        spans[0][a].last - spans[0][a].first + 1);
		return s;
	}

	// By how many cells' lengths the images of any two grains may be apart, each axis, until they have moved by more than a grain.
	double mostCells(int axis) const { return extent[axis] / length[axis] + 1; }

private:
	struct Span {
		int first, last; // cells along an axis
	};
	struct Part {
		int first, last, total; // grains; and how many are in this part's fraction of the places
		double low[3], high[3];
		std::vector<int> next; // by place: first how many grains, then where the next one goes
	};

	unsigned firstPlace(int part) const { return unsigned(std::size_t(places) * part / parts.size()); }
	unsigned placeOfCell(int a, int b, int c) const
	{
		return (unsigned(a) + unsigned(b) * stride[0] + unsigned(c) * stride[1]) & (places - 1);
	}
	void addRow(NeighbourSearch& s, unsigned place, unsigned cells) const
	{
		const unsigned end = std::min(place + cells, places), rest = place + cells - end;
		s.rows[s.rowCount++] = { start[place], start[end] };
		if (rest > 0) s.rows[s.rowCount++] = { start[0], start[rest] };
	}

	int cellAlong(int k, double x) const
	{
		const double cells = x / length[k],
		             at = periodic ? (cells - std::floor(cells)) * size[k] : (x - origin[k]) * inverseSize[k];
		return std::max(0, std::min(int(at), size[k] - 1)); // also where a run has broken down and x is no number
	}
	unsigned placeAt(const double* x) const { return placeOfCell(cellAlong(0, x[0]), cellAlong(1, x[1]), cellAlong(2, x[2])); }

	int spansAround(int k, int at, Span spans[2]) const
	{
		const int first = at - 1, last = at + 1, end = size[k];
		if (!periodic || end <= 3) {
			spans[0] = periodic ? Span { 0, end - 1 } : Span { std::max(first, 0), std::min(last, end - 1) };
			return 1;
		}
		spans[0] = { std::max(first, 0), std::min(last, end - 1) };
		if (first >= 0 && last < end) return 1;
		spans[1] = first < 0 ? Span { end - 1, end - 1 } : Span { 0, 0 };
		return 2;
	}

	std::vector<Part> parts;
	double origin[3] {}, inverseSize[3] { 1, 1, 1 }, length[3] { 1, 1, 1 }, extent[3] {};
	int size[3] { 1, 1, 1 }, count = 0;
	unsigned places = 1, stride[2] { 1, 1 }; // places: a power of two
	bool periodic = false;
	std::vector<int> start, members;
	std::vector<unsigned> placeOf;   // of each grain
	Aligned<double> x, y, z, radius; // of the members
};

} // namespace contact_law
