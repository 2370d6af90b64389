// A pair of bodies that touch or may touch.
#pragma once
#include <core/Body.hpp>

namespace yade {

class IGeomFunctor;
class IPhysFunctor;
class LawFunctor;

class IGeom : public Serializable, public Indexable {
public:
	IGeom() {}
	~IGeom() override;
	YADE_INTERFACE_OVERRIDES_(IGeom)
	REGISTER_INDEX_COUNTER(IGeom);
};

class IPhys : public Serializable, public Indexable {
public:
	IPhys() {}
	~IPhys() override;
	YADE_INTERFACE_OVERRIDES_(IPhys)
	REGISTER_INDEX_COUNTER(IPhys);
};

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

} // namespace yade

SAVED_BY_YADE(IGeom)
SAVED_BY_YADE(IPhys)
