// A domain's contacts and sintered bonds of one ownership (shared_state.hpp), in blocks of eight slots: one slot a contact.
#pragma once
#include "../kernel/bond.hpp"
#include "../kernel/contact.hpp"
#include "arrays.hpp"

namespace contact_law {

// With the grains in the other order: spin and normal both change sign.
inline ContactHistory<double> swapped(const ContactHistory<double>& h) { return { { h.pointers.n2, h.pointers.n1 }, h.twist }; }
inline DampingMoment<double> swapped(DampingMoment<double> m)
{
	for (Vec3<double>* v : vectorsOf(m))
		*v = -*v;
	return m;
}

// The k-th of vectors that stand side by side.
inline Vec3<double> vectorIn(const double (&rows)[3][lanes], int k) { return { rows[0][k], rows[1][k], rows[2][k] }; }
inline void writeVector(const Vec3<double>& v, double (&rows)[3][lanes], int k) { rows[0][k] = v.x, rows[1][k] = v.y, rows[2][k] = v.z; }

inline ContactHistory<double> historyIn(const ContactBlock& b, int k) { return { { vectorIn(b.n1, k), vectorIn(b.n2, k) }, b.twist[k] }; }

// What both lists share. An unused slot points to two dummy grains, `dummy` and the next one, which touch at equilibrium.
template <class Block> class SlotList {
public:
	explicit SlotList(int dummy_)
	        : dummy(dummy_)
	{
	}
	int size() const { return slots; } // unused ones among them
	int blockCount() const { return int(blocks.size()); }
	Block* data() { return blocks.data(); }
	int first(int slot) const { return blocks[slot / lanes].i[slot % lanes]; } // grains
	int second(int slot) const { return blocks[slot / lanes].j[slot % lanes]; }
	bool isUsed(int slot) const { return first(slot) != dummy; }
	int usedCount() const // by blocks: slots behind the last one are unused
	{
		int count = 0;
		for (const Block& block : blocks)
			for (int k = 0; k < lanes; ++k)
				count += block.i[k] != dummy;
		return count;
	}
	std::vector<int> inOrder() const // used slots, by their pairs
	{
		struct Key {
			int i, j, slot;
			bool operator<(const Key& other) const { return i != other.i ? i < other.i : j < other.j; }
		};
		std::vector<Key> keys;
		for (int slot = 0; slot < slots; ++slot)
			if (isUsed(slot)) keys.push_back({ first(slot), second(slot), slot });
		const auto added = std::is_sorted_until(keys.begin(), keys.end()); // those before stand as the last sorting left them
		std::sort(added, keys.end());
		std::inplace_merge(keys.begin(), added, keys.end());
		std::vector<int> order;
		for (const Key& key : keys)
			order.push_back(key.slot);
		return order;
	}
	ContactHistory<double> history(int slot) const { return historyIn(blocks[slot / lanes], slot % lanes); }
	void writeHistory(int slot, const ContactHistory<double>& h)
	{
		Block& b = blocks[slot / lanes];
		writeVector(h.pointers.n1, b.n1, slot % lanes);
		writeVector(h.pointers.n2, b.n2, slot % lanes);
		b.twist[slot % lanes] = h.twist;
	}

protected:
	void writeGrains(int slot, int i, int j) { blocks[slot / lanes].i[slot % lanes] = i, blocks[slot / lanes].j[slot % lanes] = j; }
	static ContactHistory<double> unusedHistory() { return { { { -1, 0, 0 }, { 1, 0, 0 } }, 0 }; }

	Aligned<Block> blocks;
	int dummy, slots = 0;
};

// ---- contacts ----

struct Contact { // one slot, taken out
	int i, j;
	ContactHistory<double> history;
	PairConstants<double> constants;
	double drag = 0, overlap = 0; // a step ago; these three only in scenes with drag
	Vec3<double> velocity { 0, 0, 0 };
	DampingMoment<double> damping {}; // in scenes with damped springs
};

class ContactList : public SlotList<ContactBlock> {
public:
	ContactList(bool uniform_, unsigned mechanisms, int dummy_)
	        : SlotList(dummy_)
	        , uniform(uniform_)
	        , hasDrag(mechanisms & Drag)
	        , isDamped(mechanisms & SpringDamping)
	{
	}
	ConstantsBlock* constantsData() { return uniform ? nullptr : constants.data(); }
	DragBlock* dragData() { return hasDrag ? drags.data() : nullptr; }
	DampingBlock* dampingData() { return isDamped ? dampings.data() : nullptr; }
	void setUnusedConstants(const PairConstants<double>& c) { unusedConstants = c; }

	void append(const Contact& contact)
	{
		appendUnused();
		const int slot = slots - 1;
		writeGrains(slot, contact.i, contact.j);
		writeHistory(slot, contact.history);
		writeConstants(slot, contact.constants);
		writeDrag(slot, contact.drag, contact.overlap, contact.velocity);
		writeDamping(slot, contact.damping);
	}
	void appendUnused()
	{
		if (slots % lanes == 0) addUnusedBlock();
		++slots;
	}
	void markUnused(int slot)
	{
		writeGrains(slot, dummy, dummy + 1);
		writeHistory(slot, unusedHistory());
		writeConstants(slot, unusedConstants);
		writeDrag(slot, 0, unusedConstants.equilibriumOverlap, { 0, 0, 0 });
		writeDamping(slot, {});
	}
	Contact get(int slot, const PairConstants<double>& pairConstants) const
	{
		Contact c { first(slot), second(slot), history(slot), pairConstants };
		if (hasDrag) c.drag = drag(slot), c.overlap = overlap(slot), c.velocity = velocityBefore(slot);
		c.damping = damping(slot);
		return c;
	}
	double drag(int slot) const { return drags[slot / lanes].drag[slot % lanes]; }
	double overlap(int slot) const { return drags[slot / lanes].overlap[slot % lanes]; }
	Vec3<double> velocityBefore(int slot) const { return vectorIn(drags[slot / lanes].velocity, slot % lanes); }
	void writeDrag(int slot, double force, double overlap, const Vec3<double>& velocity)
	{
		if (!hasDrag) return;
		drags[slot / lanes].drag[slot % lanes] = force;
		drags[slot / lanes].overlap[slot % lanes] = overlap;
		writeVelocity(slot, velocity);
	}
	void writeVelocity(int slot, const Vec3<double>& v) { writeVector(v, drags[slot / lanes].velocity, slot % lanes); }
	DampingMoment<double> damping(int slot) const
	{
		DampingMoment<double> m;
		if (!isDamped) return m;
		for (const int k : { 0, 1, 2, 3 })
			*vectorsOf(m)[k] = vectorIn(dampings[slot / lanes].moment[k], slot % lanes);
		return m;
	}
	void writeDamping(int slot, const DampingMoment<double>& m)
	{
		if (!isDamped) return;
		for (const int k : { 0, 1, 2, 3 })
			writeVector(*vectorsOf(m)[k], dampings[slot / lanes].moment[k], slot % lanes);
	}
	// Into the order of pairs, without unused slots; the next contact starts a block of its own.
	void sort()
	{
		const ContactList before = *this;
		clear();
		for (const int slot : before.inOrder()) {
			appendUnused();
			copy(before, slot, slots - 1);
		}
		slots = blockCount() * lanes;
	}
	void clear()
	{
		blocks.clear();
		constants.clear();
		drags.clear();
		dampings.clear();
		slots = 0;
	}

private:
	void addUnusedBlock()
	{
		blocks.emplace_back();
		if (!uniform) constants.emplace_back();
		if (hasDrag) drags.emplace_back();
		if (isDamped) dampings.emplace_back();
		for (int k = 0; k < lanes; ++k)
			markUnused(int(blocks.size() - 1) * lanes + k);
	}
	void copy(const ContactList& from, int slot, int here)
	{
		writeGrains(here, from.first(slot), from.second(slot));
		writeHistory(here, from.history(slot));
		if (hasDrag) writeDrag(here, from.drag(slot), from.overlap(slot), from.velocityBefore(slot));
		writeDamping(here, from.damping(slot));
		for (int k = 0; !uniform && k < keptCount; ++k)
			constants[here / lanes].field[k][here % lanes] = from.constants[slot / lanes].field[k][slot % lanes];
	}
	void writeConstants(int slot, const PairConstants<double>& c)
	{
		for (int k = 0; !uniform && k < keptCount; ++k)
			constants[slot / lanes].field[k][slot % lanes] = c.*keptConstants<double>[k];
	}
	Aligned<ConstantsBlock> constants;
	Aligned<DragBlock> drags;
	Aligned<DampingBlock> dampings;
	PairConstants<double> unusedConstants {};
	bool uniform, hasDrag, isDamped;
};

// ---- bonds ----

struct alignas(64) BondBlock : ContactBlock {
	double rest[lanes];
};

constexpr int bondConstantCount = std::size(bondConstantsOf<double>);
struct alignas(64) BondConstantsBlock {
	double field[bondConstantCount][lanes];
};

struct Bond { // one slot, taken out
	int i, j;
	ContactHistory<double> history;
	double rest;
	BondConstants<double> constants;
};

struct BondPass : PairPass {
	BondBlock* blocks;
	const BondConstantsBlock* constants;  // null when all pairs are of one kind
	const BondConstants<double>* uniform; // the constants then
	// bonds of a block (bits of `which`) that break: history before the step, forces to be replaced
	void (*breaking)(void* owner, int block, unsigned which, const BondBlock& before, LaneForces& out);
};

class BondList : public SlotList<BondBlock> {
public:
	BondList(bool uniform_, int dummy_)
	        : SlotList(dummy_)
	        , uniform(uniform_)
	{
	}
	const BondConstantsBlock* constantsData() const { return uniform ? nullptr : constants.data(); }
	// distance: of the two dummies
	void setUnused(const BondConstants<double>& c, double distance) { unused = { dummy, dummy + 1, unusedHistory(), distance, c }; }

	void append(const Bond& bond)
	{
		appendUnused();
		set(slots - 1, bond);
	}
	void appendUnused()
	{
		if (slots % lanes == 0) {
			blocks.emplace_back();
			if (!uniform) constants.emplace_back();
			for (int k = 0; k < lanes; ++k)
				markUnused(int(blocks.size() - 1) * lanes + k);
		}
		++slots;
	}
	void markUnused(int slot) { set(slot, unused); }
	Bond get(int slot, const BondConstants<double>& common) const
	{
		return { first(slot), second(slot), history(slot), blocks[slot / lanes].rest[slot % lanes],
			uniform ? common : readConstants(slot) };
	}
	// Into the order of pairs, without unused slots.
	void sort()
	{
		const BondList before = *this;
		clear();
		for (const int slot : before.inOrder())
			append(before.get(slot, unused.constants));
	}
	void clear()
	{
		blocks.clear();
		constants.clear();
		slots = 0;
	}

private:
	void set(int slot, const Bond& bond)
	{
		writeGrains(slot, bond.i, bond.j);
		blocks[slot / lanes].rest[slot % lanes] = bond.rest;
		writeHistory(slot, bond.history);
		for (int n = 0; !uniform && n < bondConstantCount; ++n)
			constants[slot / lanes].field[n][slot % lanes] = bond.constants.*bondConstantsOf<double>[n];
	}
	BondConstants<double> readConstants(int slot) const
	{
		BondConstants<double> c;
		for (int n = 0; n < bondConstantCount; ++n)
			c.*bondConstantsOf<double>[n] = constants[slot / lanes].field[n][slot % lanes];
		return c;
	}
	Aligned<BondConstantsBlock> constants;
	Bond unused {};
	bool uniform;
};

} // namespace contact_law
