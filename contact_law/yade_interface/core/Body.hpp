// A body: material, shape and state.
#pragma once
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>
#include <map>
#include <pthread.h>

namespace yade {

class Bound;
class Interaction;
class State;

class Material : public Serializable, public Indexable {
public:
	~Material() override;
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
	~Shape() override;
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
	~State() override;
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
	using mask_t = int;
	using MapId2IntrT = std::map<id_t, shared_ptr<Interaction>>;

	Body();
	~Body() override;
	YADE_INTERFACE_OVERRIDES_(Body)
	const id_t& getId() const { return id; }

	// exported by libyade; each reads one or two bits of flags
	bool isClumpMember() const;
	bool isBounded() const;

	id_t id;
	mask_t groupMask;
	int flags;
	int subdomain;
	shared_ptr<Material> material;
	shared_ptr<State> state;
	shared_ptr<Shape> shape;
	shared_ptr<Bound> bound;
	MapId2IntrT intrs; // by the other body's id
	id_t clumpId;
	long iterBorn;
	Real timeBorn;
};

} // namespace yade

SAVED_BY_YADE(Material)
SAVED_BY_YADE(State)
