// The passes over contacts and grains that make a step, for one pack type: included once by each instruction set's file, which also brings
// gather() and scatterAdd() for its packs. No physics of its own: contactForces() of the kernel is evaluated with packs of contacts.
#pragma once
#include "../kernel/contact.hpp"
#include "../kernel/turning.hpp"
#include "arrays.hpp"

namespace contact_law {

// Blocks handled together, so that what stands between gathering, computing and scattering stays in the first-level cache.
constexpr int batchSize = 8;

struct alignas(64) BatchBuffer {
	double     separation[3][lanes], velocity[3][lanes], spin1[3][lanes], spin2[3][lanes];
	LaneForces out;
};

template <class Pack> struct Passes {
	static constexpr int width = Pack::width;

	static Vec3<Pack> load(const double (*from)[lanes], int at) { return { Pack::load(from[0] + at), Pack::load(from[1] + at), Pack::load(from[2] + at) }; }
	static void       store(const Vec3<Pack>& v, double (*to)[lanes], int at)
	{
		v.x.store(to[0] + at);
		v.y.store(to[1] + at);
		v.z.store(to[2] + at);
	}

	static PairConstants<Pack> spread(const PairConstants<double>& c)
	{
		const double*       from = reinterpret_cast<const double*>(&c);
		PairConstants<Pack> to;
		Pack*               field = reinterpret_cast<Pack*>(&to);
		for (int k = 0; k < constantCount; ++k)
			field[k] = Pack(from[k]);
		return to;
	}
	static PairConstants<Pack> load(const ConstantsBlock& c, int at)
	{
		PairConstants<Pack> to;
		Pack*               field = reinterpret_cast<Pack*>(&to);
		for (int k = 0; k < constantCount; ++k)
			field[k] = Pack::load(c.field[k] + at);
		return to;
	}

	// Relative position, relative velocity and spins of `width` contacts.
	static void gatherPair(const Grain* grains, const ContactBlock& block, int at, BatchBuffer& buffer)
	{
		Pack a[9], b[9];
		gather(grains, block.i + at, a);
		gather(grains, block.j + at, b);
		for (int k = 0; k < 3; ++k) {
			(a[k] - b[k]).store(buffer.separation[k] + at);
			(a[3 + k] - b[3 + k]).store(buffer.velocity[k] + at);
			a[6 + k].store(buffer.spin1[k] + at);
			b[6 + k].store(buffer.spin2[k] + at);
		}
	}

	// The next batch's grains on their way to the cache while this batch is computed; its blocks follow each other and come by themselves.
	static void fetchAhead(const ForcePass& pass, int first)
	{
		const int last = first + batchSize < pass.blockCount ? first + batchSize : pass.blockCount;
		for (int b = first; b < last; ++b)
			for (int k = 0; k < lanes; ++k) {
				const Grain& grain = pass.grains[pass.blocks[b].j[k]];
				__builtin_prefetch(&grain.x);
				__builtin_prefetch(&grain.wz);
			}
	}

	// v1 - v2 now, extrapolated from the two steps before (MODEL.md, drag).
	static Vec3<Pack> velocityNow(const PreviousVelocity* previous, const ContactBlock& block, const Vec3<Pack>& velocity, int at)
	{
		alignas(64) double before[3][lanes];
		for (int k = at; k < at + width; ++k) {
			const PreviousVelocity &a = previous[block.i[k]], &b = previous[block.j[k]];
			before[0][k] = a.x - b.x, before[1][k] = a.y - b.y, before[2][k] = a.z - b.z;
		}
		return velocity + Pack(0.5) * (velocity - load(before, at));
	}

	/* Carries the history of `width` contacts to now, and evaluates them. Returns the lanes (bits) where an event needs care; for those the
	 * history before the step is kept in `before`. */
	template <unsigned mechanisms>
	static unsigned evaluate(const ForcePass& pass, const PairConstants<Pack>& c, const BatchBuffer& in, int index, ContactBlock& before, LaneForces& out, int at, Pack& dragWork)
	{
		ContactBlock&               block = pass.blocks[index];
		const Pack                  dt(pass.dt);
		const Vec3<Pack>            spin1 = load(in.spin1, at), spin2 = load(in.spin2, at);
		const ContactGeometry<Pack> g = geometryOf(load(in.separation, at), c.radius1 + c.radius2);
		ContactHistory<Pack>        h { { load(block.n1, at), load(block.n2, at) }, Pack::load(block.twist + at) };
		const ContactHistory<Pack>  old  = h;
		typename Pack::Mask         care = (g.overlap < -c.pullOffOverlap) | (Pack(largestFittedOverlap) < g.overlap * c.inverseEquilibriumOverlap);
		if constexpr (bool(mechanisms & (Sliding | Rolling))) h.pointers = { turnedALittle(h.pointers.n1, dt * spin1), turnedALittle(h.pointers.n2, dt * spin2) };
		if constexpr (bool(mechanisms & Twisting)) {
			h.twist = h.twist + twisting::increment(g.normal, g.inverseDistance, load(in.velocity, at), spin1 - spin2, dt);
			care    = care | (c.criticalTwisting < absolute(h.twist));
		}
		Vec3<Pack> velocity {};
		if constexpr (bool(mechanisms & Drag)) velocity = velocityNow(pass.previous, block, load(in.velocity, at), at);
		const ContactForces<Pack> f = contactForces<mechanisms>(c, g, h, velocity);
		if constexpr (bool(mechanisms & Sliding)) care = care | (c.criticalSliding * c.criticalSliding < dot(f.slidingDisplacement, f.slidingDisplacement));
		if constexpr (bool(mechanisms & Rolling)) care = care | (c.criticalRolling * c.criticalRolling < dot(f.rollingDisplacement, f.rollingDisplacement));
		if constexpr (bool(mechanisms & Drag)) { // events keep the step before, which they need
			DragBlock& d          = pass.drags[index];
			const Pack dragBefore = Pack::load(d.drag + at), overlapBefore = Pack::load(d.overlap + at);
			dragWork              = dragWork + choose(care, Pack(0.), Pack(0.5) * (dragBefore + f.drag) * (g.overlap - overlapBefore));
			choose(care, dragBefore, f.drag).store(d.drag + at);
			choose(care, overlapBefore, g.overlap).store(d.overlap + at);
		}
		store((f.normalForce + f.drag) * g.normal + f.sliding, out.force, at);
		store(f.torque1, out.torque1, at);
		store(f.torque2, out.torque2, at);
		if (__builtin_expect(anyOf(care), 0)) keep(old, before, at);
		keep(h, block, at);
		return bitsOf(care);
	}
	static void keep(const ContactHistory<Pack>& h, ContactBlock& block, int at)
	{
		store(h.pointers.n1, block.n1, at);
		store(h.pointers.n2, block.n2, at);
		h.twist.store(block.twist + at);
	}

	template <unsigned mechanisms, bool alike> [[gnu::flatten]] static void forces(const ForcePass& pass)
	{
		BatchBuffer               buffers[batchSize];
		const PairConstants<Pack> same = spread(*pass.alike);
		Pack                      dragWork(0.);
		int                       trash[lanes];
		for (int& t : trash)
			t = pass.trash;

		for (int first = 0; first < pass.blockCount; first += batchSize) {
			const int count = pass.blockCount - first < batchSize ? pass.blockCount - first : batchSize;
			ContactBlock* blocks = pass.blocks + first;
			fetchAhead(pass, first + batchSize);
			for (int b = 0; b < count; ++b)
				for (int at = 0; at < lanes; at += width)
					gatherPair(pass.grains, blocks[b], at, buffers[b]);
			for (int b = 0; b < count; ++b) {
				ContactBlock before;
				unsigned     care = 0;
				for (int at = 0; at < lanes; at += width) {
					if constexpr (alike) care |= evaluate<mechanisms>(pass, same, buffers[b], first + b, before, buffers[b].out, at, dragWork) << at;
					else care |= evaluate<mechanisms>(pass, load(pass.constants[first + b], at), buffers[b], first + b, before, buffers[b].out, at, dragWork) << at;
				}
				if (__builtin_expect(care != 0, 0)) pass.events(pass.owner, first + b, care, before, buffers[b].out);
			}
			for (int b = 0; b < count; ++b) {
				const int* to1 = pass.addFirst ? blocks[b].i : trash;
				const int* to2 = pass.addSecond ? blocks[b].j : trash;
				for (int at = 0; at < lanes; at += width) {
					const Vec3<Pack> f = load(buffers[b].out.force, at), t1 = load(buffers[b].out.torque1, at), t2 = load(buffers[b].out.torque2, at);
					const Pack       onFirst[6] { f.x, f.y, f.z, t1.x, t1.y, t1.z }, onSecond[6] { -f.x, -f.y, -f.z, t2.x, t2.y, t2.z };
					scatterAdd(pass.grains, to1 + at, onFirst);
					scatterAdd(pass.grains, to2 + at, onSecond);
				}
			}
		}
		if constexpr (bool(mechanisms & Drag)) *pass.dragWork += sumOf(dragWork);
	}

	template <unsigned mechanisms, bool alike> [[gnu::flatten]] static void energies(const ForcePass& pass, StoredSums& sums)
	{
		const PairConstants<Pack> same = spread(*pass.alike);
		StoredEnergy<Pack>        total { Pack(0.), Pack(0.), Pack(0.), Pack(0.) };
		for (int b = 0; b < pass.blockCount; ++b) {
			ContactBlock& block = pass.blocks[b];
			for (int at = 0; at < lanes; at += width) {
				BatchBuffer buffer;
				gatherPair(pass.grains, block, at, buffer);
				PairConstants<Pack> c = same;
				if constexpr (!alike) c = load(pass.constants[b], at);
				const ContactGeometry<Pack> g = geometryOf(load(buffer.separation, at), c.radius1 + c.radius2);
				const ContactHistory<Pack>  h { { load(block.n1, at), load(block.n2, at) }, Pack::load(block.twist + at) };
				const StoredEnergy<Pack>    e = storedEnergy(c, contactForces<mechanisms & AllSprings>(c, g, h, Vec3<Pack> {}), h.twist);
				alignas(64) double          counts[lanes];
				for (int lane = 0; lane < width; ++lane)
					counts[lane] = block.i[at + lane] != pass.trash; // a dead lane's dummies
				const Pack mine = Pack::load(counts);
				total = { total.normal + mine * e.normal, total.sliding + mine * e.sliding, total.rolling + mine * e.rolling, total.twisting + mine * e.twisting };
			}
		}
		sums = { sumOf(total.normal), sumOf(total.sliding), sumOf(total.rolling), sumOf(total.twisting) };
	}

	static double sumOf(const Pack& p)
	{
		alignas(64) double values[lanes];
		p.store(values);
		double sum = 0;
		for (int lane = 0; lane < width; ++lane)
			sum += values[lane];
		return sum;
	}

	static InstructionSet all(const char* name, decltype(InstructionSet::integrate) integrate)
	{
		InstructionSet set { name, {}, {}, integrate };
		fill<0>(set);
		return set;
	}

private:
	template <unsigned mechanisms> static void fill(InstructionSet& set)
	{
		set.forces[mechanisms][0]   = &forces<mechanisms, false>;
		set.forces[mechanisms][1]   = &forces<mechanisms, true>;
		set.energies[mechanisms][0] = &energies<mechanisms, false>;
		set.energies[mechanisms][1] = &energies<mechanisms, true>;
		if constexpr (mechanisms < Everything) fill<mechanisms + 1>(set);
	}
};

} // namespace contact_law
