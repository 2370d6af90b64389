// Bodies (material, shape, state) and the interactions of pairs of them (geometry, physics).
#pragma once
#include "classes.hpp"
#include <pthread.h>

namespace yade {

class Bound;
class Interaction;
class State;
class IGeomFunctor;
class IPhysFunctor;
class LawFunctor;

class Material : public Serializable, public Indexable {
public:
	virtual shared_ptr<State> newAssocState() const;
	virtual bool stateTypeOk(State*) const;
	Material() {} // not exported: the defaults below are YADE's
	YADE_INTERFACE_OVERRIDES_(Material)
	REGISTER_INDEX_COUNTER(Material);

	int id = -1; // in O.materials
	string label;
	Real density = 1000;
};

class Shape : public Serializable, public Indexable {
public:
	YADE_INTERFACE_OVERRIDES_(Shape)
	REGISTER_INDEX_COUNTER(Shape);

private:
	// caches of functors; this file needs no more of them than their room
	shared_ptr<Factorable> boundFunctor, internalForceFunctor;

public:
	Vector3r color;
	bool wire, highlight;

protected:
	Shape(); // made by YADE only
};

class State : public Serializable, public Indexable {
public:
	enum { DOF_ALL = 63 };

	State();
	YADE_INTERFACE_OVERRIDES_(State)
	REGISTER_INDEX_COUNTER(State);

	Vector3r& pos;    // = se3.position
	Quaternionr& ori; // = se3.orientation
	pthread_mutex_t updateMutex;
	Se3r se3;
	Vector3r vel;
	Real mass;
	Vector3r angVel;
	Vector3r angMom;
	Vector3r inertia;
	Vector3r refPos;
	Quaternionr refOri;
	unsigned int blockedDOFs;
	bool isDamped;
	Real densityScaling;
};

class Body : public Serializable {
public:
	using id_t = int;

	Body();
	YADE_INTERFACE_OVERRIDES_(Body)
	const id_t& getId() const { return id; }

	// exported by libyade; each reads one or two bits of flags
	bool isClumpMember() const;
	bool isBounded() const;

	id_t id;
	int groupMask;
	int flags;
	int subdomain;
	shared_ptr<Material> material;
	shared_ptr<State> state;
	shared_ptr<Shape> shape;
	shared_ptr<Bound> bound;
	std::map<id_t, shared_ptr<Interaction>> intrs; // by the other body's id
	id_t clumpId;
	long iterBorn;
	Real timeBorn;
};

class ElastMat : public Material {
public:
	ElastMat() { createIndex(); } // not exported; an index of its own, as every class below the topmost
	YADE_INTERFACE_OVERRIDES_(ElastMat)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real young = 1e9;
	Real poisson = 0.25;
};

class Sphere : public Shape {
public:
	Sphere();
	YADE_INTERFACE_OVERRIDES_(Sphere)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real radius;
};

// An infinite plane across an axis, through the body's position.
class Wall : public Shape {
public:
	Wall();
	YADE_INTERFACE_OVERRIDES_(Wall)
	YADE_INTERFACE_INDEX_OVERRIDES_

	int sense; // side on which it meets spheres; 0: both
	int axis;
};

// ---- interactions: pairs of bodies that touch or may touch ----

class IGeom : public Serializable, public Indexable {
public:
	IGeom() {}
	YADE_INTERFACE_OVERRIDES_(IGeom)
	REGISTER_INDEX_COUNTER(IGeom);
};

class IPhys : public Serializable, public Indexable {
public:
	IPhys() {}
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

// Geometry of two touching spheres, as Ig2_Sphere_Sphere_ScGeom makes it. Read here, never derived from.
class GenericSpheresContact : public IGeom {
public:
	YADE_INTERFACE_OVERRIDES_(GenericSpheresContact)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Vector3r normal; // from body 1 to body 2
	Vector3r contactPoint;
	Real refR1, refR2;

protected:
	GenericSpheresContact(); // made by YADE only
};

class ScGeom : public GenericSpheresContact {
	Vector3r twist_axis, orthonormal_axis;

public:
	ScGeom();
	YADE_INTERFACE_OVERRIDES_(ScGeom)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real& radius1; // = refR1
	Real& radius2; // = refR2
	Real penetrationDepth;
	Vector3r shearInc;
};

class NormPhys : public IPhys {
public:
	NormPhys();
	YADE_INTERFACE_OVERRIDES_(NormPhys)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real kn;
	Vector3r normalForce;
};

class NormShearPhys : public NormPhys {
public:
	NormShearPhys();
	YADE_INTERFACE_OVERRIDES_(NormShearPhys)
	YADE_INTERFACE_INDEX_OVERRIDES_

	Real ks;
	Vector3r shearForce;
};

} // namespace yade

SAVED_BY_YADE(Material)
SAVED_BY_YADE(State)
SAVED_BY_YADE(ElastMat)
SAVED_BY_YADE(IGeom)
SAVED_BY_YADE(IPhys)
SAVED_BY_YADE(NormPhys)
SAVED_BY_YADE(NormShearPhys)
