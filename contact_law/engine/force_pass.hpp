// The passes over contacts and grains that make a step, for one pack type: included once by each instruction set's file, which also brings
// gather() and scatterAdd() for its packs. The formulas are the kernel's, evaluated with packs of contacts. What contactStep() of the
// kernel does for one contact at a time is repeated here, in sweeps, for contacts that stay: the turning of pointers, the velocity that
// drag sees, the displacements before a slip, the booking of drag and slips.
// tests/equivalence holds it to the functors and to tests/reference_law.py. Contacts that form or break go through contactStep() itself.
#pragma once
#include "../kernel/held.hpp"
#include "../kernel/turning.hpp"
#include "arrays.hpp"
#include "several.hpp"
#include <type_traits>

namespace contact_law {

// How many blocks ahead of those that are computed grains and blocks are fetched into the cache.
constexpr int grainsAhead = 2 * batchSize, blocksAhead = 4 * batchSize;

struct alignas(64) BatchBuffer {
	double spin1[3][lanes], spin2[3][lanes];
	double normal[3][lanes], velocity[3][lanes], inverseDistance[lanes], overlap[lanes], normalForce[lanes], twistIncrement[lanes];
	double drag[lanes];     // in scenes with drag
	unsigned events, slips; // lanes (bits) that need scalar treatment; that slip
	LaneForces out;
};

template <class Pack> double sumOf(const Pack& p)
{
	alignas(64) double values[lanes];
	p.store(values);
	double sum = 0;
	for (int lane = 0; lane < Pack::width; ++lane)
		sum += values[lane];
	return sum;
}

// What a pass knows of the periodic cell: nothing in open space.
template <class Pack, bool periodic> struct Crossing {
	explicit Crossing(const PeriodicCell*) {}
};
template <class Pack> struct Crossing<Pack, true> {
	const Images<Pack> images;
	alignas(64) double shift[batchSize][3][lanes];     // cells by which the first grain is shifted to be nearest to the second
	Vec3<Pack> kicks { Pack(0.), Pack(0.), Pack(0.) }; // sum of shift times force

	explicit Crossing(const PeriodicCell* cell)
	        : images(*cell)
	{
	}
	void add(const Vec3<Pack>& shifted, const Vec3<Pack>& force) { kicks = kicks + Images<Pack>::times(shifted, force); }
	void addTo(Vec3<double>& sum) const { sum = sum + Vec3<double> { sumOf(kicks.x), sumOf(kicks.y), sumOf(kicks.z) }; }
};

template <class Pack> struct Passes {
	static constexpr int width = Pack::width;

	static Vec3<Pack> load(const double (*from)[lanes], int at)
	{
		return { Pack::load(from[0] + at), Pack::load(from[1] + at), Pack::load(from[2] + at) };
	}
	static void store(const Vec3<Pack>& v, double (*to)[lanes], int at)
	{
		v.x.store(to[0] + at);
		v.y.store(to[1] + at);
		v.z.store(to[2] + at);
	}

	static PairConstants<Pack> spread(const PairConstants<double>& c)
	{
		PairConstants<Pack> to;
		for (std::size_t k = 0; k < std::size(pairConstantsOf<Pack>); ++k)
			to.*pairConstantsOf<Pack>[k].member = Pack(c.*pairConstantsOf<double>[k].member);
		return to;
	}
	// Constants of which field(k) are the kept ones.
	template <class T, class Field> static PairConstants<T> fromKept(const Field& field)
	{
		return fromKept<T>(field, std::make_index_sequence<keptCount>());
	}
	template <class T, class Field, std::size_t... k> static PairConstants<T> fromKept(const Field& field, std::index_sequence<k...>)
	{
		PairConstants<T> to {};
		((to.*keptConstants<T>[k] = field(k)), ...);
		to.pullOffOverlap = T(normal::pullOffRatio) / to.inverseEquilibriumOverlap;
		to.criticalTwisting = T(criticalTwistingAngle);
		return to;
	}

	struct Pair {
		Vec3<Pack> separation, velocity, spin1, spin2;
	};
	template <class Block> static Pair gatherPair(const Grain* grains, const Block& block, int at)
	{
		Pack a[9], b[9];
		gather(grains, block.i + at, a);
		gather(grains, block.j + at, b);
		return { { a[0] - b[0], a[1] - b[1], a[2] - b[2] }, { a[3] - b[3], a[4] - b[4], a[5] - b[5] }, { a[6], a[7], a[8] },
			{ b[6], b[7], b[8] } };
	}
	// Its nearest images; returns the shift.
	static Vec3<Pack> toImages(const Images<Pack>& images, Pair& pair)
	{
		const Vec3<Pack> shift = images.shift(pair.separation);
		pair.separation = pair.separation + images.distance(shift);
		pair.velocity = pair.velocity + images.velocity(shift);
		return shift;
	}

	/* Grains and blocks that later batches need are fetched a few at a time between the blocks of this one: asked for at once they
	 * would wait for each other (a fifth of the speed at 40 grain radii; measured). */
	static void fetchGrains(const ForcePass& pass, int index)
	{
		if (index >= pass.endBlock) return;
		for (const auto& grains : { pass.blocks[index].i, pass.blocks[index].j })
			for (int lane = 0; lane < lanes; ++lane) {
				__builtin_prefetch(&pass.grains[grains[lane]].x);
				__builtin_prefetch(&pass.grains[grains[lane]].wz);
			}
	}
	template <bool uniform> static void fetchBlock(const ForcePass& pass, int index)
	{
		if (index >= pass.endBlock) return;
		fetch(&pass.blocks[index]);
		if constexpr (!uniform) fetch(&pass.constants[index]);
		if (pass.drags) fetch(&pass.drags[index]);
	}
	template <class Block> static void fetch(const Block* block)
	{
		for (std::size_t line = 0; line < sizeof(Block); line += 64)
			__builtin_prefetch(reinterpret_cast<const char*>(block) + line);
	}

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

	/* Second sweep: normal forces of all blocks of a batch side by side. They are one long chain of operations, and a processor that waits
	 * for it doesn't look far enough ahead to begin with the next block. Of blocks behind the last one, what the buffers hold is taken. */
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
		const auto c = fromKept<Batch>([&](int k) { return Batch::each([&](int b) { return constant(k, b); }); });
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
		if constexpr (bool(mechanisms & Drag)) keepDrag(c, pass.drags[index], buffer, events, at, lost);
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
		// the functors save these; here they follow from the pointers before they turned, as in aStepAgo() of contact_events.cpp
		const Displacements<Pack> aStepAgo { sliding::displacement(old, c.radius1, c.radius2, inverseRoot(dot(then, then)) * then),
			rolling::displacement(old, c.reducedRadius), Pack::load(before.twist + at) };
		ContactHistory<Pack> h { { load(block.n1, at), load(block.n2, at) }, Pack::load(block.twist + at) };
		returnToLimits<mechanisms>(c, g.normal, aStepAgo,
		        { normalRate(g.normal, g.inverseDistance, velocity), load(buffer.spin1, at), load(buffer.spin2, at),
		                Pack(pass.dt) },
		        h, maskOf(slipping), lost);
		ContactForces<Pack> f = ContactForces<Pack>::none();
		tangentialForces<mechanisms>(c, g, h, f);
		storeForces(g, f, buffer, at);
		keep(h, block, at);
		*pass.slips += __builtin_popcount(slipping);
	}

	static constexpr unsigned allLanes = (1u << width) - 1;

	static typename Pack::Mask maskOf(unsigned bits)
	{
		alignas(64) double is[lanes];
		for (int k = 0; k < width; ++k)
			is[k] = bits >> k & 1;
		return Pack(0.5) < Pack::load(is);
	}

	// Events keep the step before, which they need.
	static void keepDrag(
	        const PairConstants<Pack>& c, DragBlock& d, const BatchBuffer& buffer, unsigned events, int at, DissipationOf<Pack>& lost)
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
		bookDrag(c, before, now, plain, lost);
		store(velocity, d.velocity, at);
		kept.force.store(d.drag + at);
		kept.overlap.store(d.overlap + at);
	}

	static void keep(const ContactHistory<Pack>& h, ContactBlock& block, int at)
	{
		store(h.pointers.n1, block.n1, at);
		store(h.pointers.n2, block.n2, at);
		h.twist.store(block.twist + at);
	}

	static const PairConstants<Pack>& constants(const ForcePass&, const PairConstants<Pack>& same, int, int, std::true_type)
	{
		return same;
	}
	static PairConstants<Pack> constants(const ForcePass& pass, const PairConstants<Pack>&, int index, int at, std::false_type)
	{
		return fromKept<Pack>([&](int k) { return Pack::load(pass.constants[index].field[k] + at); });
	}

	// The kicks of `width` contacts to their grains, of which the lists are in the order of first grains; returns the forces on these.
	static Vec3<Pack> scatter(Grain* grains, const int* to1, const int* to2, const LaneForces& out, int at)
	{
		const Vec3<Pack> f = load(out.force, at), t1 = load(out.torque1, at), t2 = load(out.torque2, at);
		const Pack onFirst[6] { f.x, f.y, f.z, t1.x, t1.y, t1.z }, onSecond[6] { -f.x, -f.y, -f.z, t2.x, t2.y, t2.z };
		scatterAddInOrder(grains, to1 + at, onFirst);
		scatterAdd(grains, to2 + at, onSecond);
		return f;
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
		int dummies[lanes];
		for (int& dummy : dummies)
			dummy = pass.dummy;

		for (int first = pass.firstBlock, batch = 0; first < pass.endBlock; first += batchSize, ++batch) {
			const int count = pass.endBlock - first < batchSize ? pass.endBlock - first : batchSize;
			ContactBlock* blocks = pass.blocks + first;
			const auto c = [&](int b, int at) -> decltype(auto) {
				return constants(pass, same, first + b, at, std::bool_constant<uniform>());
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
				fetchBlock<uniform>(pass, first + b + blocksAhead);
				for (int at = 0; at < lanes; at += width)
					sweepTangential<mechanisms>(pass, c(b, at), first + b, buffers[b], before[b], at, lost);
			}
			for (int b = 0; b < count; ++b) {
				if (__builtin_expect(buffers[b].slips != 0, 0))
					for (int at = 0; at < lanes; at += width)
						sweepSlips<mechanisms>(pass, c(b, at), first + b, buffers[b], before[b], at, lost);
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
		for (std::size_t k = 0; k < std::size(lostChannels); ++k)
			pass.dissipated->*lostChannels[k].member += sumOf(lost.*lostChannelsOf<Pack>[k].member);
		if constexpr (periodic) crossing.addTo(*pass.crossing);
	}

	template <unsigned mechanisms, bool uniform>
	[[gnu::flatten]] static void energies(const ForcePass& pass, StoredEnergy<double>& sums)
	{
		const PairConstants<Pack> same = spread(*pass.uniform);
		const Images<Pack> images(*pass.cell); // once a step at most: open scenes have their images here too, without a shift
		StoredEnergy<Pack> sum { Pack(0.), Pack(0.), Pack(0.), Pack(0.) };
		for (int b = pass.firstBlock; b < pass.endBlock; ++b) {
			fetchBlock<uniform>(pass, b + blocksAhead);
			fetchGrains(pass, b + grainsAhead);
			ContactBlock& block = pass.blocks[b];
			for (int at = 0; at < lanes; at += width) {
				const PairConstants<Pack> c = constants(pass, same, b, at, std::bool_constant<uniform>());
				Pair pair = gatherPair(pass.grains, block, at);
				toImages(images, pair);
				const ContactGeometry<Pack> g = geometryOf(pair.separation, c.radius1 + c.radius2);
				const ContactHistory<Pack> h { { load(block.n1, at), load(block.n2, at) }, Pack::load(block.twist + at) };
				const StoredEnergy<Pack> e =
				        storedEnergy(c, contactForces<mechanisms & AllSprings>(c, g, h, Vec3<Pack> {}), h.twist);
				addUsed(e, block, at, pass.dummy, sum);
			}
		}
		sumLanes(sum, sums);
	}

	// The energies of used slots: not those of the dummies.
	static void addUsed(const StoredEnergy<Pack>& e, const ContactBlock& block, int at, int dummy, StoredEnergy<Pack>& sum)
	{
		alignas(64) double counts[lanes];
		for (int lane = 0; lane < width; ++lane)
			counts[lane] = block.i[at + lane] != dummy;
		const Pack mine = Pack::load(counts);
		for (const auto& row : storedChannelsOf<Pack>)
			sum.*row.member = sum.*row.member + mine * (e.*row.member);
	}
	static void sumLanes(const StoredEnergy<Pack>& from, StoredEnergy<double>& to)
	{
		for (std::size_t k = 0; k < std::size(storedChannels); ++k)
			to.*storedChannels[k].member = sumOf(from.*storedChannelsOf<Pack>[k].member);
	}

	static InstructionSet all(const char* name, decltype(InstructionSet::integrate) integrate)
	{
		InstructionSet set { name, {}, {}, &sumOfProduct, integrate, {}, nullptr, {}, {} };
		fill<0>(set);
		return set;
	}

private:
	static double sumOfProduct(double a, double b, double c) { return a * b + c; }

	template <unsigned mechanisms, bool uniform> static void fill(InstructionSet& set)
	{
		set.forces[mechanisms][uniform][false] = &forces<mechanisms, uniform, false>;
		set.forces[mechanisms][uniform][true] = &forces<mechanisms, uniform, true>;
		set.energies[mechanisms][uniform] = &energies<mechanisms, uniform>;
	}
	template <unsigned mechanisms> static void fill(InstructionSet& set)
	{
		fill<mechanisms, false>(set);
		fill<mechanisms, true>(set);
		if constexpr (mechanisms < Everything) fill<mechanisms + 1>(set);
	}
};

} // namespace contact_law
