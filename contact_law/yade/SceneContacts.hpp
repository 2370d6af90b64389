// O.interactions and the fused engine's contacts: written out for YADE's recorders and functors, and taken over from functors.
#pragma once
#include "../engine/exchange.hpp"
#include "JKRWada.hpp"
#include "SceneGrains.hpp"
#include <functional>

namespace yade {

class SceneContacts {
public:
	/* The scene's contacts, for a run that starts: as the functors leave them after a step of length dt [s], or as write() does. Empty when there are none.
	 * O.interactions are this object's afterwards. */
	contact_law::Inherited take(Scene&, const SceneGrains&, Real dt, unsigned mechanisms);

	/* OfPositions: everything is of the moment of the bodies' positions. AStepBehind: as the functors leave it, pointers with the orientations as they are
	 * at this call. */
	enum class Stage { OfPositions, AStepBehind };
	/* All contacts, in the order of their bodies' ids, as real interactions with ScGeom and JKRWadaPhys; those that have ended go. Interactions of contacts
	 * that continue stay the same objects. isThere: whether there is still a body of an id; contacts of those that are gone go too. */
	using IsThere = std::function<bool(int id)>;
	void write(Scene&, const contact_law::Dynamics&, Stage, const IsThere& isThere = {});

	// Empty, or that a script has erased some of what was written.
	std::string erased(const Scene&) const;

	// Empties O.interactions of what was written before and is no longer so; whether there was anything.
	bool withdraw(Scene&);

private:
	struct Place { // of a contact in the engine, bodies in rising order
		int id1, id2;
		const contact_law::ContactList* list; // null for a bond
		const contact_law::BondList* bonds;
		int slot;
		const contact_law::PlaneContacts* planes = nullptr; // of a contact with a plane, which lies among these; otherwise null
		const contact_law::PlaneContact* onPlane = nullptr;
		contact_law::ContactNow now(const contact_law::Dynamics&) const;
	};
	static std::vector<Place> placesOf(const contact_law::Dynamics&, const IsThere&);
	bool inOrder(Scene&, const std::vector<Place>&) const;
	void arrange(Scene&, const std::vector<Place>&);
	shared_ptr<Interaction> made(const Scene&, const contact_law::Dynamics&, const Place&);
	static void write(const Scene&, const contact_law::Dynamics&, const Place&, Stage, Interaction&);

	std::vector<shared_ptr<Interaction>> held; // in O.interactions, by this engine, sorted
	SharedConstants constants;
	SharedBonds bonds;
};

} // namespace yade
