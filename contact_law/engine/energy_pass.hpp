// The pass that sums the energies that contacts store, for one pack type: included by each instruction set's file.
#pragma once
#include "pass_access.hpp"

namespace contact_law {

template <class Pack> struct EnergyPasses {
	using P = PassAccess<Pack>;

	template <unsigned mechanisms, bool uniform>
	[[gnu::flatten]] static void energies(const ForcePass& pass, StoredEnergy<double>& sums)
	{
		const PairConstants<Pack> same = P::spread(*pass.uniform);
		const Images<Pack> images(*pass.cell); // once a step at most: open scenes have their images here too, without a shift
		StoredEnergy<Pack> sum { Pack(0.), Pack(0.), Pack(0.), Pack(0.) };
		for (int b = pass.firstBlock; b < pass.endBlock; ++b) {
			P::template fetchBlock<uniform>(pass, b + blocksAhead);
			P::fetchGrains(pass, b + grainsAhead);
			ContactBlock& block = pass.blocks[b];
			for (int at = 0; at < lanes; at += P::width) {
				const PairConstants<Pack> c = P::constants(pass, same, b, at, std::bool_constant<uniform>());
				auto pair = P::gatherPair(pass.grains, block, at);
				P::toImages(images, pair);
				const ContactGeometry<Pack> g = geometryOf(pair.separation, c.radius1 + c.radius2);
				const ContactHistory<Pack> h { { P::load(block.n1, at), P::load(block.n2, at) },
					Pack::load(block.twist + at) };
				const StoredEnergy<Pack> e = storedEnergy(
				        mechanisms, c, contactForces<mechanisms & AllSprings>(c, g, h, Vec3<Pack> {}), h.twist);
				P::addUsed(e, block, at, pass.dummy, sum);
			}
		}
		P::sumLanes(sum, sums);
	}

	// The set with the passes over energies of all mechanisms.
	static InstructionSet addTo(InstructionSet set)
	{
		fill<0>(set);
		return set;
	}

private:
	template <unsigned mechanisms> static void fill(InstructionSet& set)
	{
		set.energies[mechanisms][false] = &energies<mechanisms, false>;
		set.energies[mechanisms][true] = &energies<mechanisms, true>;
		if constexpr (mechanisms < Everything) fill<mechanisms + 1>(set);
	}
};

} // namespace contact_law
