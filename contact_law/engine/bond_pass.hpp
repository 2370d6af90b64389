// The pass over sintered bonds, for one pack type: included by each instruction set's file. One sweep, since a linear
// bond needs little room.
#pragma once
#include "../kernel/numbers.hpp"
#include "contact_lists.hpp"
#include "pass_access.hpp"

namespace contact_law {

template <class Pack> struct BondPasses {
	using P = PassAccess<Pack>;
	static constexpr int width = Pack::width;

	static BondConstants<Pack> constantsOf(const BondPass& pass, int index, int at)
	{
		BondConstants<Pack> to;
#pragma GCC unroll 32
		for (int k = 0; k < bondConstantCount; ++k)
			to.*bondConstantsOf<Pack>[k] = pass.constants ? Pack::load(pass.constants[index].field[k] + at)
			                                              : Pack(pass.uniform->*bondConstantsOf<double>[k]);
		return to;
	}

	static ContactHistory<Pack> historyOf(const BondBlock& block, int at)
	{
		return { { P::load(block.n1, at), P::load(block.n2, at) }, Pack::load(block.twist + at) };
	}

	// `width` bonds: carried through the step, their forces, and which of them break (bits).
	template <bool periodic>
	static unsigned sweep(
	        const BondPass& pass, Crossing<Pack, periodic>& crossing, int index, int at, BondBlock& before, LaneForces& out)
	{
		BondBlock& block = pass.blocks[index];
		const BondConstants<Pack> c = constantsOf(pass, index, at);
		auto pair = P::gatherPair(pass.grains, block, at);
		if constexpr (periodic) P::store(P::toImages(crossing.images, pair), crossing.shift[0], at);
		const ContactGeometry<Pack> g = geometryOf(pair.separation, Pack::load(block.rest + at));
		const ContactHistory<Pack> old = historyOf(block, at);
		const Pack dt(pass.dt);
		ContactHistory<Pack> h { { turnedALittle(old.pointers.n1, dt * pair.spin1),
			                         turnedALittle(old.pointers.n2, dt * pair.spin2) },
			old.twist + twisting::increment(g.normal, g.inverseDistance, pair.velocity, pair.spin1 - pair.spin2, dt) };
		const ContactForces<Pack> f = bondForces(c, g, h);
		const unsigned broken = bitsOf(bondBreaks(c, bondEnergy(c, g, f, h.twist)));
		P::store(f.normalForce * g.normal + f.sliding, out.force, at);
		P::store(f.torque1, out.torque1, at);
		P::store(f.torque2, out.torque2, at);
		P::keep(old, before, at);
		P::keep(h, block, at);
		return broken << at;
	}

	template <bool periodic> [[gnu::flatten]] static void forces(const BondPass& pass)
	{
		Crossing<Pack, periodic> crossing(pass.cell);
		alignas(64) int dummies[lanes]; // loaded as a block's indices are
		for (int& dummy : dummies)
			dummy = pass.dummy;
		for (int index = 0; index < pass.endBlock; ++index) {
			LaneForces out;
			BondBlock before;
			unsigned broken = 0;
			for (int at = 0; at < lanes; at += width)
				broken |= sweep(pass, crossing, index, at, before, out);
			const BondBlock& block = pass.blocks[index];
			if (__builtin_expect(broken != 0, 0)) pass.breaking(pass.owner, index, broken, before, out);
			const int* to1 = pass.addFirst ? block.i : dummies;
			const int* to2 = pass.addSecond ? block.j : dummies;
			for (int at = 0; at < lanes; at += width) {
				const Vec3<Pack> f = P::scatter(pass.grains, to1, to2, out, at);
				if constexpr (periodic) crossing.add(P::load(crossing.shift[0], at), f);
			}
		}
		if constexpr (periodic) crossing.addTo(*pass.crossing);
	}

	[[gnu::flatten]] static void energies(const BondPass& pass, StoredEnergy<double>& sums)
	{
		const Images<Pack> images(*pass.cell); // once a step at most: open scenes have their images here too, without a shift
		StoredEnergy<Pack> sum { Pack(0.), Pack(0.), Pack(0.), Pack(0.) };
		for (int index = 0; index < pass.endBlock; ++index)
			for (int at = 0; at < lanes; at += width) {
				const BondBlock& block = pass.blocks[index];
				const BondConstants<Pack> c = constantsOf(pass, index, at);
				auto pair = P::gatherPair(pass.grains, block, at);
				P::toImages(images, pair);
				const ContactGeometry<Pack> g = geometryOf(pair.separation, Pack::load(block.rest + at));
				const ContactHistory<Pack> h = historyOf(block, at);
				const StoredEnergy<Pack> e = bondEnergy(c, g, bondForces(c, g, h), h.twist);
				P::addUsed(e, block, at, pass.dummy, sum);
			}
		P::sumLanes(sum, sums);
	}
};

} // namespace contact_law
