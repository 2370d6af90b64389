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
	void add(int index, const Grain& g, double itsRadius)
	{
		if (std::size_t(count + lanes) > x.size()) {
			for (auto* numbers : { &x, &y, &z, &radius })
				numbers->resize(2 * count + 64 * lanes);
			grain.resize(2 * count + 64 * lanes);
		}
		x[count] = g.x, y[count] = g.y, z[count] = g.z, radius[count] = itsRadius;
		grain[count++] = index;
	}
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

	static InstructionSet addTo(InstructionSet set)
	{
		set.closeGrains[false] = &closeGrains<false>;
		set.closeGrains[true] = &closeGrains<true>;
		return set;
	}
};

} // namespace contact_law
