// A domain's sintered bonds of one ownership, in blocks of eight slots as ordinary contacts are.
#pragma once
#include "../kernel/bond.hpp"
#include "contact_list.hpp"

namespace contact_law {

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

class BondList {
public:
	BondList(bool uniform_, int dummy_)
	        : uniform(uniform_)
	        , dummy(dummy_)
	{
	}
	int size() const { return slots; } // unused ones among them
	int blockCount() const { return int(blocks.size()); }
	BondBlock* data() { return blocks.data(); }
	const BondConstantsBlock* constantsData() const { return uniform ? nullptr : constants.data(); }
	int first(int slot) const { return blocks[slot / lanes].i[slot % lanes]; } // grains
	int second(int slot) const { return blocks[slot / lanes].j[slot % lanes]; }
	bool isUsed(int slot) const { return first(slot) != dummy; }
	// what unused slots hold: the two dummies and their distance
	void setUnused(const BondConstants<double>& c, double distance)
	{
		unused = { dummy, dummy + 1, { { { -1, 0, 0 }, { 1, 0, 0 } }, 0 }, distance, c };
	}

	void append(const Bond& bond)
	{
		if (slots % lanes == 0) addUnusedBlock();
		set(slots++, bond);
	}
	void appendUnused()
	{
		if (slots % lanes == 0) addUnusedBlock();
		++slots;
	}
	void markUnused(int slot) { set(slot, unused); }
	Bond get(int slot, const BondConstants<double>& common) const
	{
		const BondBlock& b = blocks[slot / lanes];
		const int k = slot % lanes;
		return { b.i[k], b.j[k], ContactList::history(b, k), b.rest[k], uniform ? common : readConstants(slot) };
	}
	void writeHistory(int slot, const ContactHistory<double>& h) { ContactList::writeHistory(blocks[slot / lanes], slot % lanes, h); }
	int usedCount() const
	{
		int count = 0;
		for (int slot = 0; slot < slots; ++slot)
			count += isUsed(slot);
		return count;
	}
	// Into the order of pairs, without unused slots.
	void sort()
	{
		std::vector<Bond> order;
		for (int slot = 0; slot < slots; ++slot)
			if (isUsed(slot)) order.push_back(get(slot, unused.constants));
		std::sort(order.begin(), order.end(), [](const Bond& a, const Bond& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
		clear();
		for (const Bond& bond : order)
			append(bond);
	}
	void clear()
	{
		blocks.clear();
		constants.clear();
		slots = 0;
	}

private:
	void addUnusedBlock()
	{
		blocks.emplace_back();
		if (!uniform) constants.emplace_back();
		for (int k = 0; k < lanes; ++k)
			markUnused(int(blocks.size() - 1) * lanes + k);
	}
	void set(int slot, const Bond& bond)
	{
		BondBlock& b = blocks[slot / lanes];
		const int k = slot % lanes;
		b.i[k] = bond.i;
		b.j[k] = bond.j;
		b.rest[k] = bond.rest;
		writeHistory(slot, bond.history);
		if (uniform) return;
		for (int n = 0; n < bondConstantCount; ++n)
			constants[slot / lanes].field[n][k] = bond.constants.*bondConstantsOf<double>[n];
	}
	BondConstants<double> readConstants(int slot) const
	{
		BondConstants<double> c;
		for (int n = 0; n < bondConstantCount; ++n)
			c.*bondConstantsOf<double>[n] = constants[slot / lanes].field[n][slot % lanes];
		return c;
	}
	Aligned<BondBlock> blocks;
	Aligned<BondConstantsBlock> constants;
	Bond unused {};
	bool uniform;
	int dummy, slots = 0;
};

} // namespace contact_law
