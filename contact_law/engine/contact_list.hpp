// A domain's contacts of one sort (both grains its own, or one of them), in blocks of eight lanes.
#pragma once
#include "arrays.hpp"
#include "../kernel/contact.hpp"
#include <algorithm>

namespace contact_law {

struct Contact { // one lane, taken out
	int i, j;
	ContactHistory<double> history;
	PairConstants<double> constants;
	double drag = 0, overlap = 0; // a step ago; these three only in scenes with drag
	Vec3<double> velocity { 0, 0, 0 };
};

class ContactList {
public:
	ContactList(bool uniform_, bool drag_, int dummy_)
	        : uniform(uniform_)
	        , hasDrag(drag_)
	        , dummy(dummy_)
	{
	}
	int size() const { return used; } // lanes, dead ones among them
	int blockCount() const { return int(blocks.size()); }
	ContactBlock* data() { return blocks.data(); }
	ConstantsBlock* constantsData() { return uniform ? nullptr : constants.data(); }

	DragBlock* dragData() { return hasDrag ? drags.data() : nullptr; }

	void append(const Contact& contact)
	{
		if (used % lanes == 0) addDeadBlock();
		set(used++, contact);
	}
	void kill(int lane)
	{
		blocks[lane / lanes].i[lane % lanes] = dummy;
		blocks[lane / lanes].j[lane % lanes] = dummy + 1;
		writeHistory(lane, deadHistory());
		if (!uniform) writeConstants(lane, deadConstants);
		writeDrag(lane, 0, deadConstants.equilibriumOverlap, { 0, 0, 0 });
	}
	int first(int lane) const { return blocks[lane / lanes].i[lane % lanes]; } // grains
	int second(int lane) const { return blocks[lane / lanes].j[lane % lanes]; }
	bool alive(int lane) const { return blocks[lane / lanes].i[lane % lanes] != dummy; }

	int aliveCount() const // by blocks: lanes behind the last one are dead
	{
		int count = 0;
		for (const ContactBlock& block : blocks)
			for (int k = 0; k < lanes; ++k)
				count += block.i[k] != dummy;
		return count;
	}

	Contact get(int lane, const PairConstants<double>& pairConstants) const
	{
		const ContactBlock& b = blocks[lane / lanes];
		const int k = lane % lanes;
		Contact c { b.i[k], b.j[k], history(b, k), pairConstants };
		if (hasDrag) c.drag = drag(lane), c.overlap = drags[lane / lanes].overlap[k], c.velocity = velocityBefore(lane);
		return c;
	}
	double drag(int lane) const { return drags[lane / lanes].drag[lane % lanes]; }
	Vec3<double> velocityBefore(int lane) const
	{
		const auto& v = drags[lane / lanes].velocity;
		const int k = lane % lanes;
		return { v[0][k], v[1][k], v[2][k] };
	}
	void writeDrag(int lane, double force, double overlap, const Vec3<double>& velocity)
	{
		if (!hasDrag) return;
		drags[lane / lanes].drag[lane % lanes] = force;
		drags[lane / lanes].overlap[lane % lanes] = overlap;
		writeVelocity(lane, velocity);
	}
	void writeVelocity(int lane, const Vec3<double>& v)
	{
		auto& to = drags[lane / lanes].velocity;
		const int k = lane % lanes;
		to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z;
	}
	void writeHistory(int lane, const ContactHistory<double>& h) { writeHistory(blocks[lane / lanes], lane % lanes, h); }
	static void writeHistory(ContactBlock& b, int k, const ContactHistory<double>& h)
	{
		const Vec3<double>&p = h.pointers.n1, &q = h.pointers.n2;
		b.n1[0][k] = p.x, b.n1[1][k] = p.y, b.n1[2][k] = p.z;
		b.n2[0][k] = q.x, b.n2[1][k] = q.y, b.n2[2][k] = q.z;
		b.twist[k] = h.twist;
	}
	static ContactHistory<double> history(const ContactBlock& b, int k)
	{
		return { { { b.n1[0][k], b.n1[1][k], b.n1[2][k] }, { b.n2[0][k], b.n2[1][k], b.n2[2][k] } }, b.twist[k] };
	}
	void appendDead()
	{
		if (used % lanes == 0) addDeadBlock();
		++used;
	}
	// Into the order of pairs, without dead lanes; the next contact starts a block of its own.
	void sort()
	{
		struct Key {
			int i, j, lane;
			bool operator<(const Key& other) const { return i != other.i ? i < other.i : j < other.j; }
		};
		std::vector<Key> order;
		for (int lane = 0; lane < used; ++lane)
			if (alive(lane)) order.push_back({ first(lane), second(lane), lane });
		const auto added = std::is_sorted_until(order.begin(), order.end()); // those before stand as the last sorting left them
		std::sort(added, order.end());
		std::inplace_merge(order.begin(), added, order.end());
		const ContactList before = *this;
		clear();
		for (const Key& key : order) {
			appendDead();
			copy(before, key.lane, used - 1);
		}
		used = blockCount() * lanes;
	}
	void clear()
	{
		blocks.clear();
		constants.clear();
		drags.clear();
		used = 0;
	}
	void setDeadConstants(const PairConstants<double>& c) { deadConstants = c; } // of the two dummies, which touch at equilibrium

private:
	static ContactHistory<double> deadHistory() { return { { { -1, 0, 0 }, { 1, 0, 0 } }, 0 }; }

	void addDeadBlock()
	{
		blocks.emplace_back();
		if (!uniform) constants.emplace_back();
		if (hasDrag) drags.emplace_back();
		for (int k = 0; k < lanes; ++k)
			kill(int(blocks.size() - 1) * lanes + k);
	}
	void copy(const ContactList& from, int lane, int here)
	{
		blocks[here / lanes].i[here % lanes] = from.first(lane);
		blocks[here / lanes].j[here % lanes] = from.second(lane);
		writeHistory(here, history(from.blocks[lane / lanes], lane % lanes));
		if (hasDrag) writeDrag(here, from.drag(lane), from.drags[lane / lanes].overlap[lane % lanes], from.velocityBefore(lane));
		for (int k = 0; !uniform && k < keptCount; ++k)
			constants[here / lanes].field[k][here % lanes] = from.constants[lane / lanes].field[k][lane % lanes];
	}
	void set(int lane, const Contact& contact)
	{
		blocks[lane / lanes].i[lane % lanes] = contact.i;
		blocks[lane / lanes].j[lane % lanes] = contact.j;
		writeHistory(lane, contact.history);
		if (!uniform) writeConstants(lane, contact.constants);
		writeDrag(lane, contact.drag, contact.overlap, contact.velocity);
	}
	void writeConstants(int lane, const PairConstants<double>& c)
	{
		for (int k = 0; k < keptCount; ++k)
			constants[lane / lanes].field[k][lane % lanes] = c.*keptConstants<double>[k];
	}
	Aligned<ContactBlock> blocks;
	Aligned<ConstantsBlock> constants;
	Aligned<DragBlock> drags;
	PairConstants<double> deadConstants {};
	bool uniform, hasDrag;
	int dummy, used = 0;
};

} // namespace contact_law
