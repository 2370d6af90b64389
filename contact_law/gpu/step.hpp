/* A collision's steps, by a team of threads. Contacts write their kicks, then each grain adds up those of its contacts in a fixed order;
 * velocities are of half a step before the positions, as the engine has them (MODEL.md, "The integrator and the ledger"). */
#pragma once
#include "collision.hpp"

namespace contact_law {
namespace gpu {

	// ---- pairs ----

	GPU inline const PairConstants<double>& constantsOf(const Collision& c, int slot)
	{
		return c.uniform ? c.common : c.constants[slot];
	}
	GPU inline const BondConstants<double>& bondOf(const Collision& c, int slot)
	{
		return c.uniform ? c.commonBond : c.bondConstants[slot];
	}
	GPU inline double reachOf(const Collision& c, int i, int j) { return neck::shrunkRadius(c.neck) * (c.radius[i] + c.radius[j]); }

	GPU inline void deriveConstants(Collision& c, int slot)
	{
		if (c.uniform) return;
		const int i = c.first[slot], j = c.second[slot];
		const Material &one = c.material[c.kind[i]], &other = c.material[c.kind[j]];
		c.constants[slot] = deriveShrunkPair(one, c.radius[i], other, c.radius[j], c.options, c.neck);
		if (slot < c.bonds) c.bondConstants[slot] = deriveBond(one, c.radius[i], other, c.radius[j], c.options, c.neck);
	}

	GPU inline ContactMotion motionOf(const Collision& c, int i, int j, double dt)
	{
		return { c.position[i] - c.position[j], c.velocity[i] - c.velocity[j], c.spin[i], c.spin[j], dt,
			1 / c.mass[i] + 1 / c.mass[j], { 0, 0, 0 }, 1 / c.inertia[i], 1 / c.inertia[j] };
	}

	// ---- slots ----

	// A slot's kicks, and what they and its contact add to the sums. broken: the mode by which a bond did.
	GPU inline void book(Collision& c, int slot, const ContactMotion& m, const ContactStepResult& r, const ContactHistory<double>& h,
	        bool drag, bool sampled, Sums& sums)
	{
		c.force.set(slot, r.force), c.torque1.set(slot, r.torque1), c.torque2.set(slot, r.torque2);
		c.pointer1.set(slot, h.pointers.n1), c.pointer2.set(slot, h.pointers.n2), c.twist[slot] = h.twist;
		if (r.isEvent())
			sums.lost += r.dissipated;
		else if (drag)
			sums.lost.drag += r.dissipated.drag;
		if (drag) c.dragBefore[slot] = r.now.drag;
		if (!sampled) return;
		c.forceBefore.set(slot, r.forceBefore);
		c.torqueBefore1.set(slot, r.torqueBefore1), c.torqueBefore2.set(slot, r.torqueBefore2);
		c.normalForce[slot] = r.now.normalForce + r.now.drag;
		sums.kinetic += r.workBefore - 0.5 * events::work(m, r.force, r.torque1, r.torque2);
		if (!r.touching) return;
		sums.stored += r.stored;
		sums.contacts += 1;
		sums.between += c.aggregate[c.first[slot]] != c.aggregate[c.second[slot]];
	}

	GPU RARE inline void quieten(Collision& c, int slot)
	{
		const Vector none { 0, 0, 0 };
		c.force.set(slot, none), c.torque1.set(slot, none), c.torque2.set(slot, none);
		c.forceBefore.set(slot, none), c.torqueBefore1.set(slot, none), c.torqueBefore2.set(slot, none);
		c.state[slot] = Unused;
	}

	GPU inline ContactHistory<double> historyOf(const Collision& c, int slot)
	{
		return { { c.pointer1[slot], c.pointer2[slot] }, c.twist[slot] };
	}

	// A bond through the step that has led to the grains' positions.
	template <unsigned mechanisms> GPU RARE void bringBondOn(Collision& c, int slot, double dt, bool sampled, Sums& sums)
	{
		const ContactMotion m = motionOf(c, c.first[slot], c.second[slot], dt);
		const BondConstants<double>& bond = bondOf(c, slot);
		ContactHistory<double> h = historyOf(c, slot);
		const ContactBefore before = aStepAgo(bond, c.rest[slot], m.separation - m.dt * m.velocity, h);
		turnPointers(h, m);
		const BondStepResult r = bondStep<mechanisms>(bond, constantsOf(c, slot), m, before, c.rest[slot], h);
		if (!r.bonded) {
			c.state[slot] = r.contact.touching ? Touching : LastKick;
			sums.brokenBonds[r.mode] += 1;
		}
		book(c, slot, m, r.contact, h, bool(mechanisms & Drag), sampled, sums);
	}

	// Likewise a contact, as it was a step ago.
	template <unsigned mechanisms>
	GPU inline ContactBefore beforeOf(const Collision& c, int slot, const ContactMotion& m, const ContactHistory<double>& h)
	{
		const PairConstants<double>& constants = constantsOf(c, slot);
		ContactBefore before = aStepAgo(constants, constants.radius1 + constants.radius2, m.separation - m.dt * m.velocity, h);
		if constexpr (bool(mechanisms & Drag)) {
			before.velocity = c.velocityBefore[c.first[slot]] - c.velocityBefore[c.second[slot]];
			before.drag = c.dragBefore[slot];
		}
		return before;
	}
	template <unsigned mechanisms, LimitRule limit>
	GPU inline void stepContact(Collision& c, int slot, const ContactMotion& m, bool sampled, Sums& sums)
	{
		ContactHistory<double> h = historyOf(c, slot);
		const ContactBefore before = beforeOf<mechanisms>(c, slot, m, h);
		turnPointers(h, m);
		const ContactStepResult r = contactStep<mechanisms>(constantsOf(c, slot), limit, m, before, h);
		if (!r.touching) {
			c.state[slot] = LastKick;
			sums.broken += 1;
		}
		book(c, slot, m, r, h, bool(mechanisms & Drag), sampled, sums);
	}
	template <unsigned mechanisms, LimitRule limit>
	GPU RARE void breakContact(Collision& c, int slot, const ContactMotion& m, bool sampled, Sums& sums)
	{
		stepContact<mechanisms, limit>(c, slot, m, sampled, sums);
	}
	template <unsigned mechanisms, LimitRule limit>
	GPU inline void bringContactOn(Collision& c, int slot, double dt, bool sampled, Sums& sums)
	{
		const ContactMotion m = motionOf(c, c.first[slot], c.second[slot], dt);
		const PairConstants<double>& constants = constantsOf(c, slot);
		if (normal::beyondPullOff(constants, geometryOf(m.separation, constants.radius1 + constants.radius2)))
			breakContact<mechanisms, limit>(c, slot, m, sampled, sums);
		else
			stepContact<mechanisms, limit>(c, slot, m, sampled, sums);
	}

	template <unsigned mechanisms, LimitRule limit> GPU inline void bringOn(Collision& c, int slot, double dt, bool sampled, Sums& sums)
	{
		const unsigned char state = c.state[slot];
		if (state == Touching) bringContactOn<mechanisms, limit>(c, slot, dt, sampled, sums);
		if (state == Bonded) bringBondOn<mechanisms>(c, slot, dt, sampled, sums);
		if (state == LastKick) quieten(c, slot);
	}

	// ---- births ----

	GPU inline bool isForming(const Collision& c, int pair)
	{
		const int i = c.pairFirst[pair], j = c.pairSecond[pair];
		const Vector apart = c.position[i] - c.position[j];
		const double reach = c.uniform ? c.common.radius1 + c.common.radius2 : reachOf(c, i, j);
		return dot(apart, apart) <= reach * reach && (c.pairSlot[pair] < 0 || c.state[c.pairSlot[pair]] < Touching);
	}

	// Which slots each grain has, by rising slot.
	GPU inline void listSlotsOfGrains(Collision& c)
	{
		const int most = c.room.contactsOfAGrain;
		EACH(i, c.grains) c.contactsOfGrain[i] = 0;
		barrier();
		EACH(slot, c.slots)
		{
			if (c.state[slot] == Unused) continue;
			const int i = c.first[slot], j = c.second[slot];
			const int ofFirst = takeNext(c.contactsOfGrain[i]), ofSecond = takeNext(c.contactsOfGrain[j]);
			if (ofFirst >= most || ofSecond >= most) {
				c.failure = Failure::TooManyContactsOfAGrain;
				continue;
			}
			c.slotsOfGrain[i * most + ofFirst] = slot + 1;
			c.slotsOfGrain[j * most + ofSecond] = -(slot + 1);
		}
		barrier();
		if (c.failure != Failure::None) return;
		EACH(i, c.grains)
		{
			int* own = c.slotsOfGrain + i * most;
			for (int k = 1; k < c.contactsOfGrain[i]; ++k) {
				const int one = own[k], key = one < 0 ? -one : one;
				int to = k;
				for (; to > 0 && (own[to - 1] < 0 ? -own[to - 1] : own[to - 1]) > key; --to)
					own[to] = own[to - 1];
				own[to] = one;
			}
		}
		barrier();
	}

	// Contacts that form get the next slots, in the order of the pairs.
	template <unsigned mechanisms, LimitRule limit> GPU RARE void form(Collision& c, double dt, bool sampled, Sums& sums)
	{
		const int before = c.slots;
		const int more = addUp(
		        c.ranks, c.pairs, [&](int pair) { return int(isForming(c, pair)); },
		        [&](int pair, int rank) {
			        const int slot = before + rank;
			        if (slot >= c.room.slots) return;
			        const int i = c.pairFirst[pair], j = c.pairSecond[pair];
			        c.first[slot] = i, c.second[slot] = j, c.pairSlot[pair] = slot, c.state[slot] = Unused;
			        deriveConstants(c, slot);
			        const ContactMotion m = motionOf(c, i, j, dt);
			        ContactHistory<double> h {};
			        const ContactStepResult r = contactStep<mechanisms>(constantsOf(c, slot), limit, m, ContactBefore {}, h);
			        if (!r.touching) return;
			        c.state[slot] = Touching;
			        sums.formed += 1;
			        book(c, slot, m, r, h, bool(mechanisms & Drag), sampled, sums);
		        });
		FIRST
		{
			c.born = false;
			if (before + more > c.room.slots)
				c.failure = Failure::TooManySlots;
			else
				c.slots = before + more;
		}
		barrier();
		if (c.failure == Failure::None) listSlotsOfGrains(c);
	}

	// ---- lists ----

	template <class T> GPU void moveSlots(Collision& c, T* values)
	{
		T* copy = reinterpret_cast<T*>(c.copy);
		EACH(slot, c.slots) if (c.movedTo[slot] >= 0) copy[c.movedTo[slot]] = values[slot];
		barrier();
		EACH(slot, c.slots) values[slot] = copy[slot];
		barrier();
	}

	// Closes the gaps that broken contacts have left. Kicks are not moved: the next are made before they are read.
	GPU inline void closeGaps(Collision& c)
	{
		EACH(slot, c.slots) c.movedTo[slot] = -1;
		barrier();
		const auto isKept = [&](int slot) { return int(slot < c.bonds || c.state[slot] >= Touching); };
		const int kept = addUp(c.ranks, c.slots, isKept, [&](int slot, int rank) { c.movedTo[slot] = rank; });
		if (kept == c.slots) return;
		moveSlots(c, c.first), moveSlots(c, c.second), moveSlots(c, c.state);
		for (Vectors* of : { &c.pointer1, &c.pointer2 })
			moveSlots(c, of->x), moveSlots(c, of->y), moveSlots(c, of->z);
		moveSlots(c, c.twist), moveSlots(c, c.dragBefore);
		FIRST { c.slots = kept; }
		barrier();
		if (!c.uniform) EACH(slot, c.slots) deriveConstants(c, slot);
	}

	GPU inline int slotOf(const Collision& c, int i, int j)
	{
		for (int k = 0; k < c.contactsOfGrain[i]; ++k) {
			const int own = c.slotsOfGrain[i * c.room.contactsOfAGrain + k], slot = (own < 0 ? -own : own) - 1;
			if (c.first[slot] == j || c.second[slot] == j) return slot;
		}
		return -1;
	}

	struct Cell {
		int x, y, z;
		GPU bool operator==(const Cell& other) const { return x == other.x && y == other.y && z == other.z; }
		GPU int bucket(int buckets) const
		{
			return int((unsigned(x) * 73856093u ^ unsigned(y) * 19349663u ^ unsigned(z) * 83492791u) & unsigned(buckets - 1));
		}
	};
	GPU inline Cell cellOf(const Collision& c, int i)
	{
		const Vector x = (1 / c.cellWidth) * c.position[i];
		return { int(std::floor(x.x)), int(std::floor(x.y)), int(std::floor(x.z)) };
	}

	GPU inline void sortIntoBuckets(Collision& c)
	{
		const int buckets = bucketsOf(c.grains);
		EACH(bucket, buckets) c.bucketFilled[bucket] = 0;
		barrier();
		EACH(i, c.grains) takeNext(c.bucketFilled[cellOf(c, i).bucket(buckets)]);
		EACH(bucket, buckets) c.bucketStart[bucket] = 0;
		barrier();
		addUp(
		        c.ranks, buckets, [&](int bucket) { return c.bucketFilled[bucket]; },
		        [&](int bucket, int start) { c.bucketStart[bucket] = start; });
		EACH(bucket, buckets) c.bucketFilled[bucket] = 0;
		barrier();
		EACH(i, c.grains)
		{
			const int bucket = cellOf(c, i).bucket(buckets);
			c.grainsByBucket[c.bucketStart[bucket] + takeNext(c.bucketFilled[bucket])] = i;
		}
		barrier();
	}

	// Calls see(j) for every later grain j that is nearer to grain i than the skin, in no order.
	template <class See> GPU inline void eachNear(const Collision& c, int i, const See& see)
	{
		const int buckets = bucketsOf(c.grains);
		const Cell own = cellOf(c, i);
		for (int k = 0; k < 27; ++k) {
			const Cell cell { own.x + k % 3 - 1, own.y + k / 3 % 3 - 1, own.z + k / 9 - 1 };
			const int bucket = cell.bucket(buckets);
			for (int at = c.bucketStart[bucket], end = at + c.bucketFilled[bucket]; at < end; ++at) {
				const int j = c.grainsByBucket[at];
				const Vector apart = c.position[i] - c.position[j];
				const double reach = c.radius[i] + c.radius[j] + c.skin;
				if (j > i && dot(apart, apart) < reach * reach && cellOf(c, j) == cell) see(j);
			}
		}
	}

	// Every pair of grains nearer than the skin, by rising first, then second grain.
	GPU inline void listPairs(Collision& c)
	{
		sortIntoBuckets(c);
		EACH(i, c.grains)
		{
			int count = 0;
			eachNear(c, i, [&](int) { ++count; });
			c.pairsOfGrain[i] = count;
			c.listed.set(i, c.position[i]);
		}
		barrier();
		const int all = addUp(
		        c.ranks, c.grains, [&](int i) { return c.pairsOfGrain[i]; }, [&](int i, int start) { c.pairsOfGrain[i] = start; });
		if (all > c.room.pairs) {
			c.failure = Failure::TooManyPairs;
			return;
		}
		EACH(i, c.grains)
		{
			const int start = c.pairsOfGrain[i];
			int end = start;
			eachNear(c, i, [&](int j) {
				int to = end++;
				for (; to > start && c.pairSecond[to - 1] > j; --to)
					c.pairSecond[to] = c.pairSecond[to - 1];
				c.pairSecond[to] = j;
			});
			for (int at = start; at < end; ++at)
				c.pairFirst[at] = i, c.pairSlot[at] = slotOf(c, i, c.pairSecond[at]);
		}
		FIRST
		{
			c.pairs = all;
			c.outdated = false;
		}
		barrier();
	}

	GPU RARE inline void makeLists(Collision& c)
	{
		closeGaps(c);
		listSlotsOfGrains(c);
		if (c.failure == Failure::None) listPairs(c);
	}

	// ---- one step ----

	struct Push {
		Vector force, torque;
	};
	// A grain's share of its contacts' kicks.
	GPU inline Push pushOn(const Collision& c, int grain, const Vectors& force, const Vectors& torque1, const Vectors& torque2)
	{
		Push sum { { 0, 0, 0 }, { 0, 0, 0 } };
		for (int k = 0; k < c.contactsOfGrain[grain]; ++k) {
			const int own = c.slotsOfGrain[grain * c.room.contactsOfAGrain + k];
			if (own > 0)
				sum = { sum.force + force[own - 1], sum.torque + torque1[own - 1] };
			else
				sum = { sum.force - force[-own - 1], sum.torque + torque2[-own - 1] };
		}
		return sum;
	}

	GPU inline void kick(Collision& c, int i, double time)
	{
		const Push push = pushOn(c, i, c.force, c.torque1, c.torque2);
		c.velocity.set(i, c.velocity[i] + (time / c.mass[i]) * push.force);
		c.spin.set(i, c.spin[i] + (time / c.inertia[i]) * push.torque);
	}

	template <unsigned mechanisms> GPU void move(Collision& c)
	{
		EACH(i, c.grains)
		{
			if constexpr (bool(mechanisms & Drag)) c.velocityBefore.set(i, c.velocity[i]);
			kick(c, i, c.dt);
			const Vector v = c.velocity[i], x = c.position[i] + c.dt * v, moved = x - c.listed[i];
			c.position.set(i, x);
			if (4 * dot(moved, moved) > c.skin * c.skin) c.outdated = true;
			if (!(dot(v, v) * c.dt * c.dt < 0.25 * c.radius[i] * c.radius[i])) c.tooFast = true;
		}
		barrier();
	}

	template <unsigned mechanisms, LimitRule limit> GPU void addForces(Collision& c, double dt, bool sampled)
	{
		Sums& sums = c.sums[thread()];
		if (sampled) sums.stored = { 0, 0, 0, 0 }, sums.kinetic = sums.contacts = sums.between = 0;
		EACH(slot, c.slots) bringOn<mechanisms, limit>(c, slot, dt, sampled, sums);
		EACH(pair, c.pairs) if (isForming(c, pair)) c.born = true;
		barrier();
		if (c.born) form<mechanisms, limit>(c, dt, sampled, sums);
	}

	// ---- samples ----

	GPU inline Sums sumOf(const Sums* sums, int count)
	{
		Sums all {};
		for (int k = 0; k < count; ++k)
			all += sums[k];
		return all;
	}
	GPU inline Sample sampleOf(const Sums& all, double time)
	{
		Sample sample {};
		sample.time = time;
		sample.energies.dissipated = all.lost, sample.energies.stored = all.stored, sample.energies.kinetic = all.kinetic;
		sample.contacts = all.contacts, sample.between = all.between, sample.formed = all.formed, sample.broken = all.broken;
		for (int mode = 0; mode < bondModeCount; ++mode)
			sample.brokenBonds[mode] = all.brokenBonds[mode];
		sample.right = all.right, sample.left = all.left;
		return sample;
	}

	GPU inline double timeOf(const Collision& c) { return c.timeOfChange + double(c.step - c.changed) * c.dt; }

	// Velocities of the positions' moment, and a row of the history.
	GPU RARE inline void takeSample(Collision& c)
	{
		Sums& sums = c.sums[thread()];
		sums.right = sums.left = { 0, 0, 0 };
		EACH(i, c.grains)
		{
			const Vector v = c.velocity[i], w = c.spin[i];
			const Push half = pushOn(c, i, c.force, c.torque1, c.torque2);
			const Push now = pushOn(c, i, c.forceBefore, c.torqueBefore1, c.torqueBefore2);
			const Vector vNow = v + (c.dt / c.mass[i]) * now.force;
			c.velocityNow.set(i, vNow);
			c.spinNow.set(i, w + (c.dt / c.inertia[i]) * now.torque);
			sums.kinetic += 0.5 * c.mass[i] * dot(v, v) + 0.5 * c.inertia[i] * dot(w, w)
			        + 0.5 * c.dt * (dot(half.force, v) + dot(half.torque, w));
			const double x = c.position.x[i];
			if (x == 0) continue;
			Side& side = x > 0 ? sums.right : sums.left;
			side.grains += 1, side.position += x, side.velocity += vNow.x;
		}
		barrier();
		FIRST_OF_GROUP { c.sumsOfGroup[group()] = sumOf(c.sums + thread(), endOfGroup() - thread()); }
		if (mostGroups > 1) barrier();
		FIRST
		{
			if (c.samples < c.room.samples) c.sample[c.samples++] = sampleOf(sumOf(c.sumsOfGroup, groups()), timeOf(c));
		}
		barrier();
	}

	// A step of another length from a sample on: the kick is what belongs before it by the old one, the rest by the new (MODEL.md).
	GPU RARE inline void changeStep(Collision& c)
	{
		const double less = c.dt - c.dtAfter;
		EACH(i, c.grains)
		{
			const Push before = pushOn(c, i, c.forceBefore, c.torqueBefore1, c.torqueBefore2);
			c.velocity.set(i, c.velocity[i] + (less / c.mass[i]) * before.force);
			c.spin.set(i, c.spin[i] + (less / c.inertia[i]) * before.torque);
		}
		barrier();
		FIRST
		{
			c.timeOfChange = timeOf(c), c.changed = c.step;
			c.dt = c.dtAfter, c.interval = c.intervalAfter;
		}
		barrier();
	}

	// ---- a run ----

	// Contacts (bonds) of the pairs in its slots, without strain; forces, and velocities half a step back.
	template <unsigned mechanisms, LimitRule limit> GPU RARE void begin(Collision& c)
	{
		EACH(slot, c.slots)
		{
			deriveConstants(c, slot);
			const ContactMotion m = motionOf(c, c.first[slot], c.second[slot], 0);
			ContactHistory<double> h = events::formedHistory(m, 0);
			if (slot < c.bonds) c.rest[slot] = newBond(m.separation, h);
			c.state[slot] = slot < c.bonds ? Bonded : Touching;
			c.pointer1.set(slot, h.pointers.n1), c.pointer2.set(slot, h.pointers.n2), c.twist[slot] = 0;
		}
		EACH(i, c.grains) c.velocityBefore.set(i, c.velocity[i]);
		barrier();
		makeLists(c);
		if (c.failure != Failure::None) return;
		addForces<mechanisms, limit>(c, 0, true);
		EACH(i, c.grains)
		{
			kick(c, i, -0.5 * c.dt);
			c.velocityBefore.set(i, c.velocity[i]);
		}
		barrier();
		takeSample(c);
	}

	template <unsigned mechanisms, LimitRule limit> GPU RARE void run(Collision& c, long long steps)
	{
		if (c.step == 0 && c.samples == 0) begin<mechanisms, limit>(c);
		for (long long made = 0; made < steps && c.stepsLeft > 0 && c.failure == Failure::None; ++made) {
			move<mechanisms>(c);
			FIRST
			{
				++c.step;
				--c.stepsLeft;
			}
			if (c.outdated) makeLists(c);
			FIRST if (c.tooFast) c.failure = Failure::TooFast;
			barrier();
			if (c.failure != Failure::None) return;
			const bool sampled = (c.step - c.changed) % c.interval == 0 || c.stepsLeft == 0;
			addForces<mechanisms, limit>(c, c.dt, sampled);
			if (sampled) takeSample(c);
			if (c.step == c.changesAt) changeStep(c);
		}
	}

} // namespace gpu
} // namespace contact_law
