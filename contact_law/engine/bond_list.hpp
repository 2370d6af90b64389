// A domain's sintered bonds of one sort (both grains its own, or one of them), in blocks of eight lanes as ordinary contacts are.
#pragma once
#include "../kernel/bond_step.hpp"
#include "contact_list.hpp"

namespace contact_law {

struct alignas(64) BondBlock : ContactBlock {
	double rest[lanes];
};

constexpr int bondConstantCount = std::size(bondConstantsOf<double>);
struct alignas(64) BondConstantsBlock {
	double field[bondConstantCount][lanes];
};

struct Bond { // one lane, taken out
	int i, j;
	ContactHistory<double> history;
	double rest;
	BondConstants<double> constants;
};

// What one pass over a domain's bonds needs; as ForcePass.
struct BondPass {
	Grain* grains;
	BondBlock* blocks;
	const BondConstantsBlock* constants;  // null when all pairs are of one kind
	const BondConstants<double>* uniform; // the constants then
	int endBlock;
	int addFirst, addSecond, trash;
	double dt;
	const PeriodicCell* cell;
	Vec3<double>* crossing; // in periodic scenes: shift times force of bonds across the boundaries is added here
	void* owner;
	// bonds of a block (bits of `which`) that break: history before the step, forces to be replaced
	void (*breaking)(void* owner, int block, unsigned which, const BondBlock& before, LaneForces& forces);
};

class BondList {
public:
	BondList(bool uniform_, int dummy_)
	        : uniform(uniform_)
	        , dummy(dummy_)
	{
	}
	int size() const { return used; } // lanes, dead ones among them
	int blockCount() const { return int(blocks.size()); }
	BondBlock* data() { return blocks.data(); }
	const BondConstantsBlock* constantsData() const { return uniform ? nullptr : constants.data(); }
	int first(int lane) const { return blocks[lane / lanes].i[lane % lanes]; } // grains
	int second(int lane) const { return blocks[lane / lanes].j[lane % lanes]; }
	bool alive(int lane) const { return first(lane) != dummy; }
	// of lanes that are none: the two dummies and their distance
	void setDead(const BondConstants<double>& c, double distance)
	{
		dead = { dummy, dummy + 1, { { { -1, 0, 0 }, { 1, 0, 0 } }, 0 }, distance, c };
	}

	void append(const Bond& bond)
	{
		if (used % lanes == 0) addDeadBlock();
		set(used++, bond);
	}
	void appendDead()
	{
		if (used % lanes == 0) addDeadBlock();
		++used;
	}
	void kill(int lane) { set(lane, dead); }
	Bond get(int lane, const BondConstants<double>& common) const
	{
		const BondBlock& b = blocks[lane / lanes];
		const int k = lane % lanes;
		return { b.i[k], b.j[k], ContactList::history(b, k), b.rest[k], uniform ? common : readConstants(lane) };
	}
	void writeHistory(int lane, const ContactHistory<double>& h) { ContactList::writeHistory(blocks[lane / lanes], lane % lanes, h); }
	int aliveCount() const
	{
		int count = 0;
		for (int lane = 0; lane < used; ++lane)
			count += alive(lane);
		return count;
	}
	// Into the order of pairs, without dead lanes.
	void sort()
	{
		std::vector<Bond> order;
		for (int lane = 0; lane < used; ++lane)
			if (alive(lane)) order.push_back(get(lane, dead.constants));
		std::sort(order.begin(), order.end(), [](const Bond& a, const Bond& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
		clear();
		for (const Bond& bond : order)
			append(bond);
	}
	void clear()
	{
		blocks.clear();
		constants.clear();
		used = 0;
	}

private:
	void addDeadBlock()
	{
		blocks.emplace_back();
		if (!uniform) constants.emplace_back();
		for (int k = 0; k < lanes; ++k)
			kill(int(blocks.size() - 1) * lanes + k);
	}
	void set(int lane, const Bond& bond)
	{
		BondBlock& b = blocks[lane / lanes];
		const int k = lane % lanes;
		b.i[k] = bond.i;
		b.j[k] = bond.j;
		b.rest[k] = bond.rest;
		writeHistory(lane, bond.history);
		if (uniform) return;
		for (int n = 0; n < bondConstantCount; ++n)
			constants[lane / lanes].field[n][k] = bond.constants.*bondConstantsOf<double>[n];
	}
	BondConstants<double> readConstants(int lane) const
	{
		BondConstants<double> c;
		for (int n = 0; n < bondConstantCount; ++n)
			c.*bondConstantsOf<double>[n] = constants[lane / lanes].field[n][lane % lanes];
		return c;
	}
	Aligned<BondBlock> blocks;
	Aligned<BondConstantsBlock> constants;
	Bond dead {};
	bool uniform;
	int dummy, used = 0;
};

} // namespace contact_law
