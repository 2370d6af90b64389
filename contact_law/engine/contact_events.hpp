/* Events of a domain's contacts in a step, one by one: contacts that form or break, bonds that break, and what a pass leaves to the kernel's scalar law (cut springs, slips
 * after a script's move, overlaps beyond the fit). A border contact goes through the same event in both domains, from the same numbers to the same end. */
#pragma once
#include "ledger.hpp"
#include "pair_lists.hpp"
#include "touching_pairs.hpp"

namespace contact_law {

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
