// A domain's contacts of one ownership (shared_state.hpp), in blocks of eight slots: one slot a contact, a lane of a block.
#pragma once
#include "arrays.hpp"
#include "../kernel/contact.hpp"
#include <algorithm>

namespace contact_law {

struct Contact { // one slot, taken out
	int i, j;
	ContactHistory<double> history;
	PairConstants<double> constants;
	double drag = 0, overlap = 0; // a step ago; these three only in scenes with drag
	Vec3<double> velocity { 0, 0, 0 };
};

// With the grains in the other order: spin and normal both change sign.
inline ContactHistory<double> swapped(const ContactHistory<double>& h) { return { { h.pointers.n2, h.pointers.n1 }, h.twist }; }

class ContactList {
public:
	ContactList(bool uniform_, bool drag_, int dummy_)
	        : uniform(uniform_)
	        , hasDrag(drag_)
	        , dummy(dummy_)
	{
	}
	int size() const { return slots; } // unused ones among them
	int blockCount() const { return int(blocks.size()); }
	ContactBlock* data() { return blocks.data(); }
	ConstantsBlock* constantsData() { return uniform ? nullptr : constants.data(); }
	DragBlock* dragData() { return hasDrag ? drags.data() : nullptr; }

	void append(const Contact& contact)
	{
		if (slots % lanes == 0) addUnusedBlock();
		set(slots++, contact);
	}
	void markUnused(int slot)
	{
		blocks[slot / lanes].i[slot % lanes] = dummy;
		blocks[slot / lanes].j[slot % lanes] = dummy + 1;
		writeHistory(slot, unusedHistory());
		if (!uniform) writeConstants(slot, unusedConstants);
		writeDrag(slot, 0, unusedConstants.equilibriumOverlap, { 0, 0, 0 });
	}
	int first(int slot) const { return blocks[slot / lanes].i[slot % lanes]; } // grains
	int second(int slot) const { return blocks[slot / lanes].j[slot % lanes]; }
	bool isUsed(int slot) const { return blocks[slot / lanes].i[slot % lanes] != dummy; }

	int usedCount() const // by blocks: slots behind the last one are unused
	{
		int count = 0;
		for (const ContactBlock& block : blocks)
			for (int k = 0; k < lanes; ++k)
				count += block.i[k] != dummy;
		return count;
	}

	Contact get(int slot, const PairConstants<double>& pairConstants) const
	{
		const ContactBlock& b = blocks[slot / lanes];
		const int k = slot % lanes;
		Contact c { b.i[k], b.j[k], history(b, k), pairConstants };
		if (hasDrag) c.drag = drag(slot), c.overlap = drags[slot / lanes].overlap[k], c.velocity = velocityBefore(slot);
		return c;
	}
	double drag(int slot) const { return drags[slot / lanes].drag[slot % lanes]; }
	Vec3<double> velocityBefore(int slot) const
	{
		const auto& v = drags[slot / lanes].velocity;
		const int k = slot % lanes;
		return { v[0][k], v[1][k], v[2][k] };
	}
	void writeDrag(int slot, double force, double overlap, const Vec3<double>& velocity)
	{
		if (!hasDrag) return;
		drags[slot / lanes].drag[slot % lanes] = force;
		drags[slot / lanes].overlap[slot % lanes] = overlap;
		writeVelocity(slot, velocity);
	}
	void writeVelocity(int slot, const Vec3<double>& v)
	{
		auto& to = drags[slot / lanes].velocity;
		const int k = slot % lanes;
		to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z;
	}
	void writeHistory(int slot, const ContactHistory<double>& h) { writeHistory(blocks[slot / lanes], slot % lanes, h); }
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
	void appendUnused()
	{
		if (slots % lanes == 0) addUnusedBlock();
		++slots;
	}
	// Into the order of pairs, without unused slots; the next contact starts a block of its own.
	void sort()
	{
		struct Key {
			int i, j, slot;
			bool operator<(const Key& other) const { return i != other.i ? i < other.i : j < other.j; }
		};
		std::vector<Key> order;
		for (int slot = 0; slot < slots; ++slot)
			if (isUsed(slot)) order.push_back({ first(slot), second(slot), slot });
		const auto added = std::is_sorted_until(order.begin(), order.end()); // those before stand as the last sorting left them
		std::sort(added, order.end());
		std::inplace_merge(order.begin(), added, order.end());
		const ContactList before = *this;
		clear();
		for (const Key& key : order) {
			appendUnused();
			copy(before, key.slot, slots - 1);
		}
		slots = blockCount() * lanes;
	}
	void clear()
	{
		blocks.clear();
		constants.clear();
		drags.clear();
		slots = 0;
	}
	void setUnusedConstants(const PairConstants<double>& c) { unusedConstants = c; } // of the two dummies, which touch at equilibrium

private:
	static ContactHistory<double> unusedHistory() { return { { { -1, 0, 0 }, { 1, 0, 0 } }, 0 }; }

	void addUnusedBlock()
	{
		blocks.emplace_back();
		if (!uniform) constants.emplace_back();
		if (hasDrag) drags.emplace_back();
		for (int k = 0; k < lanes; ++k)
			markUnused(int(blocks.size() - 1) * lanes + k);
	}
	void copy(const ContactList& from, int slot, int here)
	{
		blocks[here / lanes].i[here % lanes] = from.first(slot);
		blocks[here / lanes].j[here % lanes] = from.second(slot);
		writeHistory(here, history(from.blocks[slot / lanes], slot % lanes));
		if (hasDrag) writeDrag(here, from.drag(slot), from.drags[slot / lanes].overlap[slot % lanes], from.velocityBefore(slot));
		for (int k = 0; !uniform && k < keptCount; ++k)
			constants[here / lanes].field[k][here % lanes] = from.constants[slot / lanes].field[k][slot % lanes];
	}
	void set(int slot, const Contact& contact)
	{
		blocks[slot / lanes].i[slot % lanes] = contact.i;
		blocks[slot / lanes].j[slot % lanes] = contact.j;
		writeHistory(slot, contact.history);
		if (!uniform) writeConstants(slot, contact.constants);
		writeDrag(slot, contact.drag, contact.overlap, contact.velocity);
	}
	void writeConstants(int slot, const PairConstants<double>& c)
	{
		for (int k = 0; k < keptCount; ++k)
			constants[slot / lanes].field[k][slot % lanes] = c.*keptConstants<double>[k];
	}
	Aligned<ContactBlock> blocks;
	Aligned<ConstantsBlock> constants;
	Aligned<DragBlock> drags;
	PairConstants<double> unusedConstants {};
	bool uniform, hasDrag;
	int dummy, slots = 0;
};

} // namespace contact_law
