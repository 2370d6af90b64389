// Which of some grains lie close to a grain, for one pack type. Included by each instruction set's file.
#pragma once
#include "arrays.hpp"

namespace contact_law {

// Grains to choose from, by rising index; room for a whole pack behind the last one.
struct Candidates {
	Aligned<double> x, y, z, radius;
	std::vector<int> grain;
	int count = 0;

	void clear() { count = 0; }
	void makeRoomFor(int more)
	{
		if (std::size_t(count + more + lanes) <= x.size()) return;
		const std::size_t size = 2 * (count + more) + 64 * lanes;
		for (auto* numbers : { &x, &y, &z, &radius })
			numbers->resize(size);
		grain.resize(size);
	}
	void add(int index, const Grain& g, double itsRadius)
	{
		x[count] = g.x, y[count] = g.y, z[count] = g.z, radius[count] = itsRadius;
		grain[count++] = index;
	}
};

// A box, and the grains from `first` up to, but not including, `last`.
struct BoxSearch {
	const Grain* grains;
	const double* radius;
	const PeriodicCell& cell;
	Vec3<double> centre, half; // half its edges [m]
	int first, last;
};

// A grain at a position, and the candidates from `first` up to, but not including, `last`.
struct NeighbourSearch {
	const Candidates& candidates;
	const PeriodicCell& cell;
	const Grain& at;
	double reach; // its radius and the gap between surfaces
	int first, last;
};

template <class Pack> struct NeighbourPasses {
	static constexpr int width = Pack::width;

	// Adds the grains with their centres in the box to the candidates, which have room for all of the box's (makeRoomFor).
	template <bool periodic> static void addInBox(const BoxSearch& box, Candidates& to)
	{
		const Vec3<Pack> centre = Images<Pack>::spread(box.centre), half = Images<Pack>::spread(box.half);
		const Images<Pack> images(box.cell);
		for (int at = box.first; at < box.last; at += width) {
			alignas(64) int index[lanes];
			for (int k = 0; k < width; ++k)
				index[k] = std::min(at + k, box.last - 1);
			Pack g[9];
			gather(box.grains, index, g);
			Vec3<Pack> d { g[0] - centre.x, g[1] - centre.y, g[2] - centre.z };
			if constexpr (periodic) d = d + images.distance(images.shift(d));
			const unsigned outside = bitsOf((half.x < absolute(d.x)) | (half.y < absolute(d.y)) | (half.z < absolute(d.z)));
			const unsigned all = (1u << std::min(width, box.last - at)) - 1;
			for (unsigned inside = all & ~outside; inside; inside &= inside - 1) {
				const int grain = at + __builtin_ctz(inside);
				to.add(grain, box.grains[grain], box.radius[grain]);
			}
		}
	}

	// Candidates whose surfaces are closer than the gap, by rising index; returns how many.
	template <bool periodic> static int closeGrains(const NeighbourSearch& search, int* found)
	{
		const Candidates& c = search.candidates;
		const Vec3<Pack> here { Pack(search.at.x), Pack(search.at.y), Pack(search.at.z) };
		const Pack reach(search.reach);
		const Images<Pack> images(search.cell);
		int count = 0;
		for (int at = search.first / width * width; at < search.last; at += width) {
			Vec3<Pack> d { here.x - Pack::load(&c.x[at]), here.y - Pack::load(&c.y[at]), here.z - Pack::load(&c.z[at]) };
			if constexpr (periodic) d = d + images.distance(images.shift(d));
			const Pack far = reach + Pack::load(&c.radius[at]);
			unsigned bits = bitsOf(dot(d, d) < far * far);
			if (at < search.first) bits &= ~0u << (search.first - at);
			if (search.last - at < width) bits &= (1u << (search.last - at)) - 1;
			for (; bits; bits &= bits - 1)
				found[count++] = c.grain[at + __builtin_ctz(bits)];
		}
		return count;
	}
};

} // namespace contact_law
