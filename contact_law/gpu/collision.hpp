/* All of one collision, in one piece of memory that a team of threads works on: grains, contacts, pairs of neighbours, ledger.
 * A slot is a sintered bond or a contact; the first slots belong to the bonds, each with the contact that may follow it. */
#pragma once
#include "block.hpp"

namespace contact_law {
namespace gpu {

	using Vector = Vec3<double>;

	// Vectors by component.
	struct Vectors {
		double *x, *y, *z;
		ON_GPU Vector operator[](int k) const { return { x[k], y[k], z[k] }; }
		ON_GPU void set(int k, const Vector& v) { x[k] = v.x, y[k] = v.y, z[k] = v.z; }
	};

	enum SlotState : unsigned char {
		Unused,
		LastKick, // it broke in the latest step
		Touching,
		Bonded
	};

	enum class Failure { None, TooManySlots, TooManyPairs, TooManyContactsOfAGrain, TooFast };

	// How much a collision may hold.
	struct Room {
		int grains, slots, pairs, contactsOfAGrain, kinds, samples;
	};

	// What a sample holds beside the energies: sums over grains with x > 0 and x < 0, for d and v (A24 eqs 10-13).
	struct Side {
		double grains, position, velocity;
		GPU void operator+=(const Side& other) { grains += other.grains, position += other.position, velocity += other.velocity; }
	};
	struct Sample {
		double time;
		Energies energies;
		double contacts, between, formed, broken, brokenBonds[bondModeCount];
		Side right, left;
	};

	// Sums of a thread: since the start, and of the latest sampled step.
	struct Sums {
		Dissipation lost;
		double formed, broken, brokenBonds[bondModeCount];
		StoredEnergy<double> stored;
		double kinetic, contacts, between;
		Side right, left;

		GPU void operator+=(const Sums& other)
		{
			lost += other.lost, stored += other.stored, kinetic += other.kinetic;
			formed += other.formed, broken += other.broken, contacts += other.contacts, between += other.between;
			for (int mode = 0; mode < bondModeCount; ++mode)
				brokenBonds[mode] += other.brokenBonds[mode];
			right += other.right, left += other.left;
		}
	};

	struct Collision {
		// ---- what it is ----
		Room room;
		int grains, bonds, mechanisms, interval; // interval: steps between samples
		long long stepsLeft, step;
		LimitRule limit;
		PairOptions options;
		double dt, neck, skin, cellWidth; // of cells: at least as wide as the largest distance of a pair
		long long changesAt;              // at this step, a sample's, dt and interval become these; 0: never
		int intervalAfter;
		double dtAfter;
		bool uniform; // all pairs have `common`, all bonds `commonBond`
		PairConstants<double> common;
		BondConstants<double> commonBond;

		// ---- where it is ----
		int slots, pairs, samples;
		long long changed; // step and time since which dt is what it is
		double timeOfChange;
		Failure failure;
		bool born, outdated, tooFast; // whether pairs touch that did not; the list of pairs may miss one; a grain moves too far
		Ranks ranks;

		// ---- grains ----
		Vectors position, velocity, spin; // velocities of half a step before the positions
		Vectors listed;                   // where they were when pairs were listed
		Vectors velocityBefore;           // through the step before the latest: for drag
		Vectors velocityNow, spinNow;     // at the latest sample, of the moment of the positions
		double *mass, *inertia, *radius;  // radius: before necks
		int *kind, *aggregate;
		int *contactsOfGrain, *slotsOfGrain; // +(slot + 1) where it is the first grain, -(slot + 1) where the second
		Material* material;

		// ---- slots ----
		int *first, *second;
		unsigned char* state;
		Vectors pointer1, pointer2;
		double *twist, *rest, *dragBefore, *normalForce; // rest: of bonds [m]; normalForce: at the latest sample
		Vectors force, torque1, torque2;                 // kicks
		Vectors forceBefore, torqueBefore1, torqueBefore2;
		PairConstants<double>* constants; // of each slot, of each bond: where pairs are unlike
		BondConstants<double>* bondConstants;
		int* movedTo;
		double* copy; // room to move slots

		// ---- pairs of neighbours ----
		int *pairFirst, *pairSecond, *pairSlot; // pairSlot: -1, or the latest slot that it had
		int* pairsOfGrain;
		// By hash of the cell: where the grains of a bucket begin, how many have their place, and all grains by bucket.
		int *bucketStart, *bucketFilled, *grainsByBucket;

		Sums *sums, *sumsOfGroup;
		Sample* sample;
		std::size_t sizeLookedAt; // of the arrays that are placed first [bytes]
	};

	// A power of two.
	ON_GPU inline int bucketsOf(int grains)
	{
		int buckets = 64;
		while (buckets < 2 * grains)
			buckets *= 2;
		return buckets;
	}

	// Gives each array of a collision its place from `begin` on (0: measures), first those that are looked at while it runs; returns the
	// size of all [bytes].
	inline std::size_t place(Collision& c, char* begin)
	{
		std::size_t size = 0;
		const auto array = [&](auto*& to, std::size_t count) {
			using Element = std::remove_reference_t<decltype(*to)>;
			to = reinterpret_cast<Element*>(begin + size);
			size += (count * sizeof(Element) + 31) / 32 * 32;
		};
		const auto vectors = [&](Vectors& to, std::size_t count) { array(to.x, count), array(to.y, count), array(to.z, count); };
		const std::size_t grains = c.room.grains, slots = c.room.slots, pairs = c.room.pairs;
		for (Vectors* of : { &c.position, &c.velocityNow, &c.spinNow })
			vectors(*of, grains);
		array(c.first, slots), array(c.second, slots), array(c.state, slots), array(c.normalForce, slots);
		array(c.sample, c.room.samples);
		c.sizeLookedAt = size;
		for (Vectors* of : { &c.velocity, &c.spin, &c.listed, &c.velocityBefore })
			vectors(*of, grains);
		for (double** of : { &c.mass, &c.inertia, &c.radius })
			array(*of, grains);
		for (int** of : { &c.kind, &c.aggregate, &c.contactsOfGrain, &c.pairsOfGrain })
			array(*of, grains);
		array(c.slotsOfGrain, grains * c.room.contactsOfAGrain);
		array(c.material, c.room.kinds);
		array(c.movedTo, slots);
		for (Vectors* of :
		        { &c.pointer1, &c.pointer2, &c.force, &c.torque1, &c.torque2, &c.forceBefore, &c.torqueBefore1, &c.torqueBefore2 })
			vectors(*of, slots);
		for (double** of : { &c.twist, &c.rest, &c.dragBefore, &c.copy })
			array(*of, slots);
		array(c.constants, c.uniform ? 0 : slots), array(c.bondConstants, c.uniform ? 0 : c.bonds);
		array(c.pairFirst, pairs), array(c.pairSecond, pairs), array(c.pairSlot, pairs);
		array(c.bucketStart, bucketsOf(c.room.grains)), array(c.bucketFilled, bucketsOf(c.room.grains)),
		        array(c.grainsByBucket, grains);
		array(c.sums, mostThreads), array(c.sumsOfGroup, mostGroups);
		return size;
	}

} // namespace gpu
} // namespace contact_law
