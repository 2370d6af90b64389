// The passes over contacts and grains that make a step, for one pack type: included once by each instruction set's file, which also brings
// gather() and scatterAdd() for its packs. The formulas are the kernel's, evaluated with packs of contacts. What contactStep() of the
// kernel does for one contact at a time is repeated here, in sweeps, for contacts that stay: the turning of pointers, the velocity that
// drag sees, the displacements before a slip, the booking of drag and slips.
// tests/equivalence holds it to the functors and to tests/reference_law.py. Contacts that form or break go through contactStep() itself.
#pragma once
#include "../kernel/limits.hpp"
#include "../kernel/numbers.hpp"
#include "../kernel/spring_damping.hpp"
#include "bond_pass.hpp"
#include "neighbour_search.hpp"
#include "pass_access.hpp"
#include "plane_pass.hpp"

namespace contact_law {

struct alignas(64) BatchBuffer {
	double spin1[3][lanes], spin2[3][lanes];
	double normal[3][lanes], velocity[3][lanes], inverseDistance[lanes], overlap[lanes], normalForce[lanes], twistIncrement[lanes];
	double drag[lanes];          // in scenes with drag
	double slipped[2][3][lanes]; // SpringRates of slips, where springs are damped
	unsigned events, slips;      // lanes (bits) that need scalar treatment; that slip
	LaneForces out;
};

template <class Pack> struct Passes : PassAccess<Pack> {
	using Access = PassAccess<Pack>;
	using typename Access::Pair;
	using Access::allLanes, Access::fetchGrains, Access::gatherPair, Access::keep, Access::load, Access::maskOf, Access::scatter,
	        Access::spread, Access::store, Access::toImages, Access::width;

	// First sweep: where `width` contacts stand, and how far they twisted.
	template <unsigned mechanisms, bool periodic>
	static void sweepGeometry(const ForcePass& pass, Crossing<Pack, periodic>& crossing, const PairConstants<Pack>& c, int index,
	        BatchBuffer& buffer, int at)
	{
		Pair pair = gatherPair(pass.grains, pass.blocks[index], at);
		if constexpr (periodic) store(toImages(crossing.images, pair), crossing.shift[(index - pass.firstBlock) % batchSize], at);
		const ContactGeometry<Pack> g = geometryOf(pair.separation, c.radius1 + c.radius2);
		const Pack inUnits = g.overlap * c.inverseEquilibriumOverlap;
		// normal::beyondPullOff() without a division; where the two differ by rounding, contactStep() decides
		const typename Pack::Mask care = (inUnits < Pack(-normal::pullOffRatio)) | (Pack(largestFittedOverlap) < inUnits);
		if constexpr (bool(mechanisms & Twisting))
			twisting::increment(g.normal, g.inverseDistance, pair.velocity, pair.spin1 - pair.spin2, Pack(pass.dt))
			        .store(buffer.twistIncrement + at);
		store(pair.spin1, buffer.spin1, at);
		store(pair.spin2, buffer.spin2, at);
		store(g.normal, buffer.normal, at);
		store(pair.velocity, buffer.velocity, at);
		g.inverseDistance.store(buffer.inverseDistance + at);
		g.overlap.store(buffer.overlap + at);
		buffer.events |= bitsOf(care) << at;
	}

	/* Second sweep: normal forces of all blocks of a batch side by side. They are one long chain of operations, and a processor
	 * that waits for it doesn't look far enough ahead to begin with the next block. Of blocks behind the last one, what the buffers
	 * hold is taken. */
	using Batch = Several<Pack, batchSize>;
	template <unsigned mechanisms, bool uniform>
	static void sweepNormal(const ForcePass& pass, const PairConstants<Pack>& same, int first, BatchBuffer* buffers, int at)
	{
		const auto index = [&](int b) { return std::min(first + b, pass.endBlock - 1); };
		const auto buffered = [&](double(BatchBuffer::*field)[lanes]) {
			return Batch::each([&](int b) { return Pack::load(buffers[b].*field + at); });
		};
		const auto axes = [&](const auto& rows) { // rows(b): three rows of lanes
			const auto axis = [&](int k) { return Batch::each([&](int b) { return Pack::load(rows(b)[k] + at); }); };
			return Vec3<Batch> { axis(0), axis(1), axis(2) };
		};
		const auto constant = [&](int k, int b) {
			if constexpr (uniform)
				return same.*keptConstants<Pack>[k];
			else
				return Pack::load(pass.constants[index(b)].field[k] + at);
		};
		const auto c = Access::template fromKept<Batch>([&](int k) { return Batch::each([&](int b) { return constant(k, b); }); });
		const ContactGeometry<Batch> g { axes([&](int b) { return buffers[b].normal; }), buffered(&BatchBuffer::inverseDistance),
			buffered(&BatchBuffer::overlap) };
		ContactForces<Batch> f;
		Vec3<Batch> velocity {};
		if constexpr (bool(mechanisms & Drag))
			velocity = drag::velocityNow(axes([&](int b) { return buffers[b].velocity; }),
			        axes([&](int b) { return pass.drags[index(b)].velocity; }));
		normalForces<mechanisms>(c, g, velocity, f);
		for (int b = 0; b < batchSize; ++b) {
			Pack radial = f.normalForce.part[b];
			if constexpr (bool(mechanisms & Drag)) {
				f.drag.part[b].store(buffers[b].drag + at);
				radial = radial + f.drag.part[b];
			}
			radial.store(buffers[b].normalForce + at);
		}
	}

	// Third sweep: the pointers turn with the grains; springs, and the sum of all forces. For blocks with slips or events `before`
	// keeps the history before the step.
	template <unsigned mechanisms>
	static void sweepTangential(const ForcePass& pass, const PairConstants<Pack>& c, int index, BatchBuffer& buffer,
	        ContactBlock& before, int at, DissipationOf<Pack>& lost)
	{
		ContactBlock& block = pass.blocks[index];
		const Pack dt(pass.dt);
		const ContactGeometry<Pack> g { load(buffer.normal, at), Pack::load(buffer.inverseDistance + at), Pack(0.) };
		const ContactHistory<Pack> old { { load(block.n1, at), load(block.n2, at) }, Pack::load(block.twist + at) };
		ContactHistory<Pack> h = old;
		if constexpr (bool(mechanisms & (Sliding | Rolling)))
			h.pointers = { turnedALittle(h.pointers.n1, dt * load(buffer.spin1, at)),
				turnedALittle(h.pointers.n2, dt * load(buffer.spin2, at)) };
		if constexpr (bool(mechanisms & Twisting)) h.twist = h.twist + Pack::load(buffer.twistIncrement + at);
		ContactForces<Pack> f = ContactForces<Pack>::none();
		tangentialForces<mechanisms>(c, g, h, f);
		storeForces(g, f, buffer, at);
		unsigned events = buffer.events >> at & allLanes, slips = bitsOf(beyondLimits<mechanisms>(c, f, h)) & ~events;
		if (__builtin_expect((events | slips) != 0, 0)) {
			keep(old, before, at);
			if (pass.cut) {
				buffer.events |= slips << at;
				events |= slips;
				slips = 0;
			}
		}
		if constexpr (bool(mechanisms & Drag)) keepDrag(pass.drags[index], buffer, events, at, lost);
		if constexpr (bool(mechanisms & SpringDamping)) writeSlips({}, buffer, at);
		buffer.slips |= slips << at;
		keep(h, block, at);
	}

	static void storeForces(const ContactGeometry<Pack>& g, const ContactForces<Pack>& f, BatchBuffer& buffer, int at)
	{
		store(Pack::load(buffer.normalForce + at) * g.normal + f.sliding, buffer.out.force, at);
		store(f.torque1, buffer.out.torque1, at);
		store(f.torque2, buffer.out.torque2, at);
	}

	// Lanes that slip, again: their displacements returned to the limits, the forces that follow, and what that dissipates.
	template <unsigned mechanisms>
	static void sweepSlips(const ForcePass& pass, const PairConstants<Pack>& c, int index, BatchBuffer& buffer,
	        const ContactBlock& before, int at, DissipationOf<Pack>& lost)
	{
		const unsigned slipping = buffer.slips >> at & allLanes;
		if (!slipping) return;
		ContactBlock& block = pass.blocks[index];
		const ContactGeometry<Pack> g { load(buffer.normal, at), Pack::load(buffer.inverseDistance + at), Pack(0.) };
		const Vec3<Pack> velocity = load(buffer.velocity, at),
		                 then = g.normal - (Pack(pass.dt) * g.inverseDistance) * velocity; // over the distance now
		const Pointers<Pack> old { load(before.n1, at), load(before.n2, at) };
		// the functors save these; here they follow from the pointers before they turned, as in aStepAgo() of touching_pairs.cpp
		const Displacements<Pack> aStepAgo { SlidingSpring::displacement(c, old, inverseRoot(dot(then, then)) * then),
			RollingSpring::displacement(c, old), Pack::load(before.twist + at) };
		ContactHistory<Pack> h { { load(block.n1, at), load(block.n2, at) }, Pack::load(block.twist + at) };
		const ContactHistory<Pack> trial = h;
		returnToLimits<mechanisms>(c, g.normal, aStepAgo,
		        { normalRate(g.normal, g.inverseDistance, velocity), load(buffer.spin1, at), load(buffer.spin2, at),
		                Pack(pass.dt) },
		        h, maskOf(slipping), lost);
		ContactForces<Pack> f = ContactForces<Pack>::none();
		tangentialForces<mechanisms>(c, g, h, f);
		storeForces(g, f, buffer, at);
		if (mechanisms & SpringDamping && pass.dt > 0)
			writeSlips(spring_damping::slipRates(c, g.normal, spring_damping::displacements(c, g.normal, trial),
			                   spring_damping::displacements(c, g.normal, h), Pack(pass.dt)),
			        buffer, at);
		keep(h, block, at);
		*pass.slips += __builtin_popcount(slipping);
	}

	static void writeSlips(const SpringRates<Pack>& slipped, BatchBuffer& buffer, int at)
	{
		store(slipped.sliding, buffer.slipped[0], at), store(slipped.turning, buffer.slipped[1], at);
	}

	// Behind slips: the springs' damping. Events do it for themselves, and keep the step before, which they need.
	static void sweepDamping(
	        const ForcePass& pass, const PairConstants<Pack>& c, int index, BatchBuffer& buffer, int at, DissipationOf<Pack>& lost)
	{
		auto& kept = pass.dampings[index].moment;
		const Pack dt(pass.dt), time(pass.springDamping);
		const typename Pack::Mask plain = maskOf(~buffer.events >> at);
		const ContactGeometry<Pack> g { load(buffer.normal, at), Pack::load(buffer.inverseDistance + at), Pack(0.) };
		const DampingMoment<Pack> before { { load(kept[0], at), load(kept[1], at) }, { load(kept[2], at), load(kept[3], at) } };
		const SpringRates<Pack> slipped { load(buffer.slipped[0], at), load(buffer.slipped[1], at) };
		const Pointers<Pack> p {};
		const auto way =
		        spring_damping::motion(c, g, p, load(buffer.velocity, at), load(buffer.spin1, at), load(buffer.spin2, at), dt);
		const DampingMoment<Pack> now = spring_damping::now(way.rates - slipped, before.through);
		spring_damping::book(c, way, before.now, now.now, slipped, time, dt, plain, lost);
		ContactForces<Pack> f = ContactForces<Pack>::none();
		spring_damping::addForces(c, g, p, now.now, time, f);
		store(load(buffer.out.force, at) + f.sliding, buffer.out.force, at);
		store(load(buffer.out.torque1, at) + f.torque1, buffer.out.torque1, at);
		store(load(buffer.out.torque2, at) + f.torque2, buffer.out.torque2, at);
		const auto to = vectorsOf(now), old = vectorsOf(before);
		for (const int k : { 0, 1, 2, 3 })
			store(choose<Pack>(plain, *to[k], *old[k]), kept[k], at);
	}

	// Events keep the step before, which they need.
	static void keepDrag(DragBlock& d, const BatchBuffer& buffer, unsigned events, int at, DissipationOf<Pack>& lost)
	{
		const DragMoment<Pack> before { Pack::load(d.drag + at), Pack::load(d.overlap + at) };
		const DragMoment<Pack> now { Pack::load(buffer.drag + at), Pack::load(buffer.overlap + at) };
		DragMoment<Pack> kept = now;
		Vec3<Pack> velocity = load(buffer.velocity, at);
		typename Pack::Mask plain = Pack(0.) < Pack(1.);
		if (__builtin_expect(events != 0, 0)) {
			plain = maskOf(~events);
			velocity = choose<Pack>(plain, velocity, load(d.velocity, at));
			kept = { choose(plain, now.force, before.force), choose(plain, now.overlap, before.overlap) };
		}
		bookDrag(before, now, plain, lost);
		store(velocity, d.velocity, at);
		kept.force.store(d.drag + at);
		kept.overlap.store(d.overlap + at);
	}

	template <unsigned mechanisms, bool uniform, bool periodic> [[gnu::flatten]] static void forces(const ForcePass& pass)
	{
		BatchBuffer buffers[batchSize];
		ContactBlock before[batchSize];
		for (BatchBuffer& buffer : buffers) // of blocks that there may not be
			std::fill_n(buffer.overlap, lanes, 0.);
		const PairConstants<Pack> same = spread(*pass.uniform);
		DissipationOf<Pack> lost;
		Crossing<Pack, periodic> crossing(pass.cell);
		alignas(64) int dummies[lanes]; // loaded as a block's indices are
		for (int& dummy : dummies)
			dummy = pass.dummy;

		for (int first = pass.firstBlock, batch = 0; first < pass.endBlock; first += batchSize, ++batch) {
			const int count = pass.endBlock - first < batchSize ? pass.endBlock - first : batchSize;
			ContactBlock* blocks = pass.blocks + first;
			const auto c = [&](int b, int at) -> decltype(auto) {
				return Access::template constants<uniform>(pass, same, first + b, at);
			};
			for (int b = 0; b < count; ++b) {
				fetchGrains(pass, first + b + grainsAhead);
				buffers[b].events = buffers[b].slips = 0;
				for (int at = 0; at < lanes; at += width)
					sweepGeometry<mechanisms, periodic>(pass, crossing, c(b, at), first + b, buffers[b], at);
			}
			for (int at = 0; at < lanes; at += width)
				sweepNormal<mechanisms, uniform>(pass, same, first, buffers, at);
			for (int b = 0; b < count; ++b) {
				Access::template fetchBlock<uniform>(pass, first + b + blocksAhead);
				for (int at = 0; at < lanes; at += width)
					sweepTangential<mechanisms>(pass, c(b, at), first + b, buffers[b], before[b], at, lost);
			}
			for (int b = 0; b < count; ++b) {
				if (__builtin_expect(buffers[b].slips != 0, 0))
					for (int at = 0; at < lanes; at += width)
						sweepSlips<mechanisms>(pass, c(b, at), first + b, buffers[b], before[b], at, lost);
				if constexpr (bool(mechanisms & SpringDamping))
					for (int at = 0; at < lanes; at += width)
						sweepDamping(pass, c(b, at), first + b, buffers[b], at, lost);
				if (__builtin_expect(buffers[b].events != 0, 0))
					pass.events(pass.owner, first + b, buffers[b].events, before[b], buffers[b].out);
			}
			for (int b = 0; b < count; ++b) {
				const int* to1 = pass.addFirst ? blocks[b].i : dummies;
				const int* to2 = pass.addSecond ? blocks[b].j : dummies;
				for (int at = 0; at < lanes; at += width) {
					const Vec3<Pack> f = scatter(pass.grains, to1, to2, buffers[b].out, at);
					if constexpr (periodic) crossing.add(load(crossing.shift[b], at), f);
				}
			}
			if (pass.batchDone) pass.batchDone(pass.owner, batch);
		}
		for (std::size_t k = 0; k < std::size(lostMembers<double>); ++k)
			pass.dissipated->*lostMembers<double>[k] += sumOf(lost.*lostMembers<Pack>[k]);
		if constexpr (periodic) crossing.addTo(*pass.crossing);
	}

	// ---- the energies that contacts store ----

	template <unsigned mechanisms, bool uniform>
	[[gnu::flatten]] static void energies(const ForcePass& pass, StoredEnergy<double>& sums)
	{
		const PairConstants<Pack> same = Access::spread(*pass.uniform);
		const Images<Pack> images(*pass.cell); // once a step at most: open scenes have their images here too, without a shift
		StoredEnergy<Pack> sum { Pack(0.), Pack(0.), Pack(0.), Pack(0.) };
		for (int b = pass.firstBlock; b < pass.endBlock; ++b) {
			Access::template fetchBlock<uniform>(pass, b + blocksAhead);
			Access::fetchGrains(pass, b + grainsAhead);
			ContactBlock& block = pass.blocks[b];
			for (int at = 0; at < lanes; at += Access::width) {
				const PairConstants<Pack> c = Access::template constants<uniform>(pass, same, b, at);
				auto pair = Access::gatherPair(pass.grains, block, at);
				Access::toImages(images, pair);
				const ContactGeometry<Pack> g = geometryOf(pair.separation, c.radius1 + c.radius2);
				const ContactHistory<Pack> h { { Access::load(block.n1, at), Access::load(block.n2, at) },
					Pack::load(block.twist + at) };
				const StoredEnergy<Pack> e = storedEnergy(
				        mechanisms, c, contactForces<mechanisms & AllSprings>(c, g, h, Vec3<Pack> {}), h.twist);
				Access::addUsed(e, block, at, pass.dummy, sum);
			}
		}
		Access::sumLanes(sum, sums);
	}

	template <unsigned mechanisms, bool uniform> static void add(InstructionSet& set)
	{
		set.forces[mechanisms][uniform][false] = &forces<mechanisms, uniform, false>;
		set.forces[mechanisms][uniform][true] = &forces<mechanisms, uniform, true>;
		set.energies[mechanisms][uniform] = &energies<mechanisms, uniform>;
		set.planeForces[mechanisms] = &PlanePasses<Pack>::template forces<mechanisms>;
	}
	// All combinations of mechanisms from this one on.
	template <unsigned mechanisms> static void add(InstructionSet& set)
	{
		add<mechanisms, false>(set);
		add<mechanisms, true>(set);
		if constexpr (mechanisms < Everything) add<mechanisms + 1>(set);
		if constexpr (mechanisms == Everything) add<Damped>(set); // mechanismSets
	}
};

// All passes, compiled for one instruction set.
template <class Pack> InstructionSet allPasses(const char* name, decltype(InstructionSet::integrate) integrate)
{
	InstructionSet set {};
	set.name = name;
	set.integrate = integrate;
	set.sumOfProduct = [](double a, double b, double c) { return a * b + c; };
	Passes<Pack>::template add<0>(set);
	set.bondForces[false] = &BondPasses<Pack>::template forces<false>;
	set.bondForces[true] = &BondPasses<Pack>::template forces<true>;
	set.bondEnergies = &BondPasses<Pack>::energies;
	set.addInBox[false] = &NeighbourPasses<Pack>::template addInBox<false>;
	set.addInBox[true] = &NeighbourPasses<Pack>::template addInBox<true>;
	set.closeGrains[false] = &NeighbourPasses<Pack>::template closeGrains<false>;
	set.closeGrains[true] = &NeighbourPasses<Pack>::template closeGrains<true>;
	return set;
}

} // namespace contact_law
