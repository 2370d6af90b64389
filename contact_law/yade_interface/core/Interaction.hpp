// A pair of bodies that touch or may touch.
#pragma once
#include <core/Body.hpp>
#include <core/IGeom.hpp>
#include <core/IPhys.hpp>

namespace yade {

class IGeomFunctor;
class IPhysFunctor;
class LawFunctor;

class Interaction : public Serializable {
public:
	bool isActive;
	struct {
		bool geomExists;
		shared_ptr<IGeomFunctor> geom;
		shared_ptr<IPhysFunctor> phys;
		shared_ptr<LawFunctor> constLaw;
	} functorCache;

	Interaction();
	Interaction(Body::id_t id1, Body::id_t id2);
	~Interaction() override;
	YADE_INTERFACE_OVERRIDES_(Interaction)
	boost::python::dict pyDictCustom() const override;

	const Body::id_t& getId1() const { return id1; }
	const Body::id_t& getId2() const { return id2; }
	// always inline: YADE's libraries hold a function of the same name, and this one is called for every contact
	[[gnu::always_inline]] bool isReal() const { return geom && phys; }

	Body::id_t id1, id2;
	long iterMadeReal;
	long iterLastSeen;
	shared_ptr<IGeom> geom;
	shared_ptr<IPhys> phys;
	Vector3i cellDist; // body 2 is shifted by hSize*cellDist
	int linIx;
	long iterBorn;
};
static_assert(sizeof(Interaction) == 168, "Interaction");
YADE_INTERFACE_AT_(Interaction, isActive, 24)
YADE_INTERFACE_AT_(Interaction, functorCache, 32)
YADE_INTERFACE_AT_(Interaction, id1, 88)
YADE_INTERFACE_AT_(Interaction, id2, 92)
YADE_INTERFACE_AT_(Interaction, iterMadeReal, 96)
YADE_INTERFACE_AT_(Interaction, iterLastSeen, 104)
YADE_INTERFACE_AT_(Interaction, geom, 112)
YADE_INTERFACE_AT_(Interaction, phys, 128)
YADE_INTERFACE_AT_(Interaction, cellDist, 144)
YADE_INTERFACE_AT_(Interaction, linIx, 156)
YADE_INTERFACE_AT_(Interaction, iterBorn, 160)

} // namespace yade
