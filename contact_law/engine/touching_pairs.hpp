// The contacts and bonds of a domain's grains: where they lie, by ownership, and in which order. (Neighbours that do not touch:
// pair_lists.hpp.)
#pragma once
#include "ledger.hpp"

namespace contact_law {

class TouchingPairs {
public:
	TouchingPairs(SharedState&, int begin, int end, int dummy); // of grains from `begin` up to, but not including, `end`

	ContactList contacts[3]; // by ownership
	BondList bonds[3];       // likewise

	bool owns(int grain) const { return grain >= begin && grain < end; }
	Ownership ownershipOf(int i, int j) const { return owns(i) && owns(j) ? Interior : owns(i) ? FirstOwned : SecondOwned; }
	int count() const; // contacts and bonds that are counted here

	// ---- placing them; to be followed by sort() and markIn(), but placeOverlapping() and placeBonds() by sort() only ----

	void place(const Contact&); // if a grain of it is owned; i < j
	void place(const Bond&);
	void placeOverlapping(PairLists&, const PeriodicCell&); // contacts of all pairs that overlap already, with unstrained springs
	void placeBonds(PairLists&, const PeriodicCell&);       // between all grains that touched before they shrank
	struct Contents {                                       // all of them before grains changed their order
		std::vector<ContactList> contacts;
		std::vector<BondList> bonds;
	};
	Contents takeOut();
	void place(const Contents&, const std::vector<int>& to); // those of which a grain is owned now; to: new indices of grains
	void markIn(PairLists&) const;                           // that they touch
	void takeVelocities(const PeriodicCell&);                // as they are now, for drag in the next step

	// ---- their order ----

	void sort();                           // into the order of pairs, without unused slots
	void sortIfWorthwhile();               // once a step
	void noteChange() { ++order.changed; } // a contact formed or broke
	void findCompleted();                  // after sort(), or when restored sorted
	// Grains below it have had all sorted interior contacts when a batch of blocks has been computed.
	int completedBy(int batch) const { return completed[batch]; }
	struct Order {
		int sortedBlocks = 0;                 // of the interior contacts
		long changed = 0, stepsSinceSort = 0; // contacts that formed or broke since the latest sorting
	} order;

private:
	template <class List, class Get> void place(const List&, const std::vector<int>& to, List (&own)[3], const Get&);

	SharedState& s;
	int begin, end, dummy;
	std::vector<int> completed;
};

/* Events of a domain's contacts in a step, one by one: contacts that form or break, bonds that break, and what a pass leaves to the
 * kernel's scalar law (cut springs, slips after a script's move, overlaps beyond the fit). A border contact goes through the same event
 * in both domains, from the same numbers to the same end. */
class ContactEvents {
public:
	ContactEvents(SharedState&, const PeriodicCell&, PairLists&, TouchingPairs&, Ledger&);

	// Of the contacts (bonds) `which` (bits) of a block; `before`: their history a step ago. Their forces in `out` are replaced.
	template <class Block> void of(Ownership o, int block, unsigned which, const Block& before, LaneForces& out)
	{
		for (int k = 0; k < lanes; ++k)
			if (which & (1u << k)) ofSlot(o, block * lanes + k, before, out);
	}
	void formContacts(); // of pairs that overlap now

private:
	void ofSlot(Ownership, int slot, const ContactBlock& before, LaneForces& out);
	void ofSlot(Ownership, int slot, const BondBlock& before, LaneForces& out);
	bool formContact(const NeighbourPair&);
	Vec3<double> separationAStepAgo(int i, int j, const ContactMotion&) const;
	void book(int i, int j, const ContactStepResult&, const ContactMotion&, const Image&, Ownership);
	void addAlone(int i, int j, const ContactStepResult&, const Image&, Ownership);

	SharedState& s;
	const PeriodicCell& cell;
	PairLists& lists;
	TouchingPairs& touching;
	Ledger& ledger;
};

} // namespace contact_law
