// The contacts and bonds of a domain's grains: where they lie, by ownership, and in which order. (Neighbours that do not touch: pair_lists.hpp.)
#pragma once
#include "pair_lists.hpp"
#include "shared_state.hpp"

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
	using AllBonds = std::array<std::vector<Bond>, 3>;
	AllBonds sintered(const PeriodicCell&, double neck) const; // the bonds, and all contacts as bonds of this neck
	void setBonds(const AllBonds&);                            // in place of all bonds and contacts
	struct Contents {                                          // all of them before grains changed their order
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
	void placeDummies();

	SharedState& s;
	int begin, end, dummy;
	std::vector<int> completed;
};

} // namespace contact_law
