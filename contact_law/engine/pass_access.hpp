// How passes over many pairs read packs of `width` contacts out of grains and blocks, and write them back; what they have in common.
// gather(), scatterAdd() and scatterAddInOrder() are each instruction set's own.
#pragma once
#include "../kernel/numbers.hpp"
#include "arrays.hpp"
#include <type_traits>

namespace contact_law {

// How many blocks ahead of those that are computed grains and blocks are fetched into the cache.
constexpr int grainsAhead = 2 * batchSize, blocksAhead = 4 * batchSize;

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

template <class Pack> struct PassAccess {
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
		PairConstants<T> to {};
#pragma GCC unroll 32
		for (int k = 0; k < keptCount; ++k)
			to.*keptConstants<T>[k] = field(k);
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

	static constexpr unsigned allLanes = (1u << width) - 1;

	static typename Pack::Mask maskOf(unsigned bits)
	{
		alignas(64) double is[lanes];
		for (int k = 0; k < width; ++k)
			is[k] = bits >> k & 1;
		return Pack(0.5) < Pack::load(is);
	}

	static void keep(const ContactHistory<Pack>& h, ContactBlock& block, int at)
	{
		store(h.pointers.n1, block.n1, at);
		store(h.pointers.n2, block.n2, at);
		h.twist.store(block.twist + at);
	}

	// same: the constants of every pair of a uniform scene.
	template <bool uniform> static decltype(auto) constants(const ForcePass& pass, const PairConstants<Pack>& same, int index, int at)
	{
		if constexpr (uniform)
			return (same);
		else
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

	// The energies of used slots: not those of the dummies.
	static void addUsed(const StoredEnergy<Pack>& e, const ContactBlock& block, int at, int dummy, StoredEnergy<Pack>& sum)
	{
		alignas(64) double counts[lanes];
		for (int lane = 0; lane < width; ++lane)
			counts[lane] = block.i[at + lane] != dummy;
		const Pack mine = Pack::load(counts);
		for (const auto member : storedMembers<Pack>)
			sum.*member = sum.*member + mine * (e.*member);
	}
	static void sumLanes(const StoredEnergy<Pack>& from, StoredEnergy<double>& to)
	{
		for (std::size_t k = 0; k < std::size(storedMembers<double>); ++k)
			to.*storedMembers<double>[k] = sumOf(from.*storedMembers<Pack>[k]);
	}
};

// ---- several packs side by side as one number: while one of them waits for a result, the others go on ----

template <class Pack, int count> struct Several {
	Pack part[count];

	Several() = default;
	Several(double x)
	{
		for (Pack& one : part)
			one = Pack(x);
	}
	template <class Of> static Several each(Of&& of) // of(k): part k
	{
		Several all;
		for (int k = 0; k < count; ++k)
			all.part[k] = of(k);
		return all;
	}
};
template <class Pack, int count> struct SeveralMasks {
	MaskOf<Pack> part[count];
};

template <class P, int n> inline Several<P, n> operator+(const Several<P, n>& a, const Several<P, n>& b)
{
	return Several<P, n>::each([&](int k) { return a.part[k] + b.part[k]; });
}
template <class P, int n> inline Several<P, n> operator-(const Several<P, n>& a, const Several<P, n>& b)
{
	return Several<P, n>::each([&](int k) { return a.part[k] - b.part[k]; });
}
template <class P, int n> inline Several<P, n> operator*(const Several<P, n>& a, const Several<P, n>& b)
{
	return Several<P, n>::each([&](int k) { return a.part[k] * b.part[k]; });
}
template <class P, int n> inline Several<P, n> operator/(const Several<P, n>& a, const Several<P, n>& b)
{
	return Several<P, n>::each([&](int k) { return a.part[k] / b.part[k]; });
}
template <class P, int n> inline Several<P, n> operator-(const Several<P, n>& a)
{
	return Several<P, n>::each([&](int k) { return -a.part[k]; });
}
template <class P, int n> inline Several<P, n> root(const Several<P, n>& a)
{
	return Several<P, n>::each([&](int k) { return root(a.part[k]); });
}

template <class P, int n> inline SeveralMasks<P, n> operator<(const Several<P, n>& a, const Several<P, n>& b)
{
	SeveralMasks<P, n> all;
	for (int k = 0; k < n; ++k)
		all.part[k] = a.part[k] < b.part[k];
	return all;
}
template <class P, int n> inline bool anyOf(const SeveralMasks<P, n>& masks)
{
	bool any = false;
	for (const auto& one : masks.part)
		any |= anyOf(one);
	return any;
}
template <class P, int n> inline Several<P, n> choose(const SeveralMasks<P, n>& m, const Several<P, n>& yes, const Several<P, n>& no)
{
	return Several<P, n>::each([&](int k) { return choose(m.part[k], yes.part[k], no.part[k]); });
}

// ---- kick and drift of grains one by one; a template over the pack only so that each instruction set compiles its own ----

// v += F dt/m, w += T dt/I, x += v dt, forces to zero; the range grows by the velocities.
template <class Pack>
inline void integrateOneByOne(
        Grain* begin, Grain* end, const double* inverseMass, const double* inverseInertia, double dt, VelocityRange& range)
{
	VelocityRange met = range;
	for (Grain* g = begin; g < end; ++g, ++inverseMass, ++inverseInertia) {
		const double m = *inverseMass * dt, i = *inverseInertia * dt;
		const double* f = &g->fx;
		for (int k = 0; k < 3; ++k)
			met.kick[k] = std::max(met.kick[k], std::abs(f[k] * m));
		g->vx += g->fx * m, g->vy += g->fy * m, g->vz += g->fz * m;
		g->wx += g->tx * i, g->wy += g->ty * i, g->wz += g->tz * i;
		g->x += g->vx * dt, g->y += g->vy * dt, g->z += g->vz * dt;
		g->fx = g->fy = g->fz = g->tx = g->ty = g->tz = 0;
		const double* v = &g->vx;
		for (int k = 0; k < 3; ++k)
			met.least[k] = std::min(met.least[k], v[k]), met.most[k] = std::max(met.most[k], v[k]);
	}
	range = met;
}

} // namespace contact_law
