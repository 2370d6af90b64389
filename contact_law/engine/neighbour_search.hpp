// Which members of a grid's rows lie close to a grain, for one pack type. Included by each instruction set's file.
#pragma once
#include "arrays.hpp"
#include "grid.hpp"

namespace contact_law {

template <class Pack> struct NeighbourPasses {
	static constexpr int width = Pack::width;

	// Grains of the rows whose surfaces are closer than search.gap to the one at search.position, itself among them, by rising rows; returns how many.
	template <bool periodic> static int closeMembers(const NeighbourSearch& search, int* found)
	{
		const GridMembers& m = search.members;
		const double* x = search.position;
		const Vec3<Pack> here { Pack(x[0]), Pack(x[1]), Pack(x[2]) };
		const Pack reach(search.radius + search.gap);
		const Images<Pack> images(*search.cell);
		int count = 0;
		for (int row = 0; row < search.rowCount; ++row) {
			const GridRow range = search.rows[row];
			for (int at = range.first / width * width; at < range.last; at += width) {
				Vec3<Pack> d { here.x - Pack::load(m.x + at), here.y - Pack::load(m.y + at),
					here.z - Pack::load(m.z + at) };
				if constexpr (periodic) d = d + images.distance(images.shift(d));
				const Pack far = reach + Pack::load(m.radius + at);
				unsigned bits = bitsOf(dot(d, d) < far * far);
				if (at < range.first) bits &= ~0u << (range.first - at);
				if (range.last - at < width) bits &= (1u << (range.last - at)) - 1;
				for (; bits; bits &= bits - 1)
					found[count++] = m.grain[at + __builtin_ctz(bits)];
			}
		}
		return count;
	}

	static InstructionSet addTo(InstructionSet set)
	{
		set.closeMembers[false] = &closeMembers<false>;
		set.closeMembers[true] = &closeMembers<true>;
		return set;
	}
};

} // namespace contact_law
