// What the fused engine keeps between steps. Grains in the order of a k-d tree (grain_order.cpp); contacts in blocks of eight, each number
// of the eight side by side.
#pragma once
#include "../kernel/contact_step.hpp"
#include "periodic_cell.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

namespace contact_law {

template <class T> struct CacheLineAllocator {
	using value_type = T;
	CacheLineAllocator() = default;
	template <class U> CacheLineAllocator(const CacheLineAllocator<U>&) {}
	T* allocate(std::size_t n)
	{
		void* p = std::aligned_alloc(64, (n * sizeof(T) + 63) / 64 * 64);
		if (!p) throw std::bad_alloc();
		return static_cast<T*>(p);
	}
	void deallocate(T* p, std::size_t) { std::free(p); }
	template <class U> bool operator==(const CacheLineAllocator<U>&) const { return true; }
	template <class U> bool operator!=(const CacheLineAllocator<U>&) const { return false; }
};
template <class T> using Aligned = std::vector<T, CacheLineAllocator<T>>;

// Two cache lines a grain: the first is what contacts read, and wz; to the rest of the second they add.
struct alignas(64) Grain {
	double x, y, z;    // position now [m]
	double vx, vy, vz; // velocity through the step before now [m/s]
	double wx, wy, wz; // angular velocity, likewise [rad/s]
	double spare;
	double fx, fy, fz, tx, ty, tz; // force [N] and torque [N m] on the grain now
};

inline Vec3<double> positionOf(const Grain& g) { return { g.x, g.y, g.z }; }
inline Vec3<double> velocityOf(const Grain& g) { return { g.vx, g.vy, g.vz }; }
inline Vec3<double> spinOf(const Grain& g) { return { g.wx, g.wy, g.wz }; }
// Of the grains themselves, not their images.
inline Vec3<double> separationOf(const Grain& a, const Grain& b) { return positionOf(a) - positionOf(b); }

inline void addToGrain(Grain& g, const Vec3<double>& force, const Vec3<double>& torque)
{
	g.fx += force.x, g.fy += force.y, g.fz += force.z;
	g.tx += torque.x, g.ty += torque.y, g.tz += torque.z;
}

// ---- orientations, only where a scene asks for them ----

struct Orientation { // unit quaternion
	double w, x, y, z;
};

// q turned by the angle |turn| about turn [rad], laboratory frame; kept a unit quaternion.
inline Orientation turnedBy(double turnX, double turnY, double turnZ, const Orientation& q)
{
	const double h = 0.25 * (turnX * turnX + turnY * turnY + turnZ * turnZ); // half the angle, squared
	double c, s;                                                             // cos(half), sin(half)/(2 half)
	if (h < 0.01) {                                                          // series of both, cut where the rest is below 1e-16
		c = 1 - h * (1. / 2 - h * (1. / 24 - h * (1. / 720 - h * (1. / 40320 - h * (1. / 3628800)))));
		s = 0.5 * (1 - h * (1. / 6 - h * (1. / 120 - h * (1. / 5040 - h * (1. / 362880)))));
	} else {
		const double half = std::sqrt(h);
		c = std::cos(half);
		s = 0.5 * std::sin(half) / half;
	}
	const double x = s * turnX, y = s * turnY, z = s * turnZ;
	Orientation r { c * q.w - x * q.x - y * q.y - z * q.z, c * q.x + x * q.w + y * q.z - z * q.y, c * q.y + y * q.w + z * q.x - x * q.z,
		c * q.z + z * q.w + x * q.y - y * q.x };
	const double unit = 1.5 - 0.5 * (r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z); // one Newton step, ample against rounding
	return { unit * r.w, unit * r.x, unit * r.y, unit * r.z };
}

inline void turnOrientations(const Grain* begin, const Grain* end, Orientation* orientation, double dt)
{
	for (const Grain* g = begin; g < end; ++g, ++orientation)
		*orientation = turnedBy(dt * g->wx, dt * g->wy, dt * g->wz, *orientation);
}

// ---- contacts ----

constexpr int lanes = 8; // contacts in a block

// Blocks handled together, so that what stands between gathering, computing and scattering stays in the first-level cache.
constexpr int batchSize = 4;

struct alignas(64) ContactBlock {
	double n1[3][lanes], n2[3][lanes]; // contact pointers, laboratory frame
	double twist[lanes];
	int i[lanes], j[lanes]; // grains; an unused slot points to the domain's two dummies
};

constexpr int countKept()
{
	int count = 0;
	for (const auto& constant : pairConstantsOf<double>)
		count += constant.readByForces;
	return count;
}
constexpr int keptCount = countKept();
template <class T> constexpr std::array<T PairConstants<T>::*, keptCount> makeKeptConstants()
{
	std::array<T PairConstants<T>::*, keptCount> kept {};
	int at = 0;
	for (const auto& constant : pairConstantsOf<T>)
		if (constant.readByForces) kept[at++] = constant.member;
	return kept;
}
/* Constants of eight contacts of a scene with several kinds of pairs: those that a step's forces read (pair_constants.hpp), since
 * reading them is what such scenes are slower for; the rest are derived anew where they are needed. */
template <class T> constexpr auto keptConstants = makeKeptConstants<T>();
struct alignas(64) ConstantsBlock {
	double field[keptCount][lanes];
};

// What drag needs of the step before (kernel/drag.hpp). velocity: of the first grain past the second, from which drag extrapolates to now.
struct alignas(64) DragBlock {
	double drag[lanes], overlap[lanes], velocity[3][lanes];
};

// What damped springs need of it (kernel/spring_damping.hpp): the vectors of a DampingMoment.
struct alignas(64) DampingBlock {
	double moment[4][3][lanes];
};
template <class Moment> ON_GPU inline auto vectorsOf(Moment& m)
{
	return std::array { &m.through.sliding, &m.through.turning, &m.now.sliding, &m.now.turning };
}

struct alignas(64) LaneForces {
	double force[3][lanes], torque1[3][lanes], torque2[3][lanes];
};

// What a pass over some of a domain's pairs needs, contacts or bonds.
struct PairPass {
	Grain* grains;
	const PeriodicCell* cell;
	int endBlock;
	bool addFirst, addSecond; // whether the first / second grain of each pair is this domain's
	int dummy;                // grain that takes what is not added
	double dt;
	Vec3<double>* crossing; // in periodic scenes: shift times force of pairs across the boundaries is added here
	void* owner;
};
struct ForcePass : PairPass {
	int firstBlock;
	ContactBlock* blocks;
	const ConstantsBlock* constants;      // null when all pairs are of one kind
	const PairConstants<double>* uniform; // the constants then
	DragBlock* drags;                     // null in scenes without drag
	DampingBlock* dampings;               // null where springs are not damped
	double springDamping;                 // c [s]
	Dissipation* dissipated;              // what drag and slips took in this step is added here
	long* slips;                          // and their number here
	// contacts of a block (bits of `which`) that break or are pressed beyond the fit: history before the step, forces to be replaced
	void (*events)(void* owner, int block, unsigned which, const ContactBlock& before, LaneForces& out);
	// called behind each batch of blocks with its number, counted from firstBlock; null when nothing waits for it
	void (*batchDone)(void* owner, int batch);
	bool cut; // springs beyond their limits are events: cut, not returned to the limit (kernel/limits.hpp), or after a script's move
};

// ---- planes ----

// A half-space of its own material, bounded by a plane across an axis, which rests or moves at a velocity of its own.
struct PlaneInput {
	int axis, kind, id;              // of the coordinate; of the material; as its owner calls it
	Vec3<double> position, velocity; // at the start [m], now [m/s]
};

struct PlaneContact { // of a grain and a plane
	int grain, plane;
	double side = 0;         // 1: the grain is on the side of rising coordinates, -1
	Vec3<double> n1 {};      // the grain's pointer, in the frame of the laboratory
	Vec3<double> point {};   // of the plane that belongs to it, from the plane's position [m]
	ContactBefore before {}; // for the next step; velocity: of the grain past the plane
	PairConstants<double> constants {};

	friend bool operator<(const PlaneContact& a, const PlaneContact& b)
	{
		return a.grain != b.grain ? a.grain < b.grain : a.plane < b.plane;
	}
};

// What the pass over contacts with planes needs: of eight of them at most.
struct PlanePass {
	const Grain* grains;
	const PlaneInput* planes;
	const Vec3<double>* positions; // of the planes now
	PlaneContact* contacts;
	int count;
	double dt;
	bool cut;                // as ForcePass has it
	Dissipation* dissipated; // likewise
	long* slips;
};

// ---- bounds on velocities ----

// The least and the greatest velocity components of grains: no two of them move apart or together faster than diagonal(); and by how much
// kicks changed each component at most. The fourth lane: room for a register.
struct alignas(32) VelocityRange {
	static constexpr int lanes = 4;
	double least[lanes], most[lanes], kick[lanes];

	VelocityRange() { clear(); }
	void clear()
	{
		for (int k = 0; k < lanes; ++k)
			least[k] = 1e300, most[k] = -1e300, kick[k] = 0;
	}
	void join(const VelocityRange& other)
	{
		for (int k = 0; k < lanes; ++k) {
			least[k] = std::min(least[k], other.least[k]);
			most[k] = std::max(most[k], other.most[k]);
			kick[k] = std::max(kick[k], other.kick[k]);
		}
	}
	bool holds(const VelocityRange& other) const // its velocities, whatever the kicks
	{
		for (int k = 0; k < 3; ++k)
			if (other.least[k] < least[k] || other.most[k] > most[k]) return false;
		return true;
	}
	double diagonal() const
	{
		const Vec3<double> d { most[0] - least[0], most[1] - least[1], most[2] - least[2] };
		return std::sqrt(dot(d, d));
	}
	double largestKick() const { return std::sqrt(kick[0] * kick[0] + kick[1] * kick[1] + kick[2] * kick[2]); }
	double fastestComponent() const
	{
		double fastest = 0;
		for (int k = 0; k < 3; ++k)
			fastest = std::max({ fastest, -least[k], most[k] });
		return fastest;
	}
};

struct BondPass;  // bond_list.hpp
struct BoxSearch; // neighbour_search.hpp, as the next two
struct Candidates;
struct NeighbourSearch;

// One instruction set's compiled passes, by mechanisms (contact_state.hpp), whether all pairs are of one kind, and (forces) whether the
// scene is periodic.
struct InstructionSet {
	const char* name;
	void (*forces[mechanismSets][2][2])(const ForcePass&);
	void (*energies[mechanismSets][2])(const ForcePass&, StoredEnergy<double>&);
	double (*sumOfProduct)(double a, double b, double c); // a b + c as this file's flags compile it: tests ask whether it is contracted
	void (*integrate)(Grain* begin, Grain* end, const double* inverseMass, const double* inverseInertia, double dt, VelocityRange&);
	unsigned (*planeForces[mechanismSets])(const PlanePass&, LaneForces&); // returns those (bits) that it leaves to planeStep()
	void (*bondForces[2])(const BondPass&);                                // by whether the scene is periodic, as in the searches below
	void (*bondEnergies)(const BondPass&, StoredEnergy<double>&);
	void (*addInBox[2])(const BoxSearch&, Candidates&);
	int (*closeGrains[2])(const NeighbourSearch&, int* found);
};

} // namespace contact_law
