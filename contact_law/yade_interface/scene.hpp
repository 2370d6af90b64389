// The scene, which YADE alone makes, the engines and functors that work on it, and the running YADE.
#pragma once
#include "bodies.hpp"
#include <boost/iterator/filter_iterator.hpp>
#include <boost/mpl/at.hpp>
#include <boost/mpl/vector.hpp>
#include <boost/mpl/void.hpp>

namespace yade {

class Scene;
class TimingDeltas;

// ---- functors, which dispatchers choose by the classes of their arguments, and those of InteractionLoop that a contact law derives from ----

/* The call operator of functors of three arguments. The final class overrides go with three; order and number of the virtual functions are
 * those of YADE's tables, which have one for one to seven arguments each. */
template <class Result, class Arguments> class FunctorWrapper {
	using A1 = typename boost::mpl::at_c<Arguments, 0>::type;
	using A2 = typename boost::mpl::at_c<Arguments, 1>::type;
	using A3 = typename boost::mpl::at_c<Arguments, 2>::type;
	using None = boost::mpl::void_;

	[[noreturn]] static Result notOverridden()
	{
		throw std::logic_error("a functor was called with a number of arguments that it does not take");
	}

public:
	virtual ~FunctorWrapper() {}
	virtual std::string checkOrder() const { return ""; }
	virtual Result go(A1) { return notOverridden(); }
	virtual Result go(A1, A2) { return notOverridden(); }
	virtual Result go(A1, A2, A3) { return notOverridden(); }
	virtual Result go(A1, A2, A3, None) { return notOverridden(); }
	virtual Result go(A1, A2, A3, None, None) { return notOverridden(); }
	virtual Result go(A1, A2, A3, None, None, None) { return notOverridden(); }
	virtual Result go(A1, A2, A3, None, None, None, None) { return notOverridden(); }
	virtual Result goReverse(A1) { return notOverridden(); }
	virtual Result goReverse(A1, A2) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3, None) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3, None, None) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3, None, None, None) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3, None, None, None, None) { return notOverridden(); }
};

class Functor : public Serializable {
public:
	Functor() {} // not exported
	YADE_INTERFACE_OVERRIDES_(Functor)
	virtual std::vector<std::string> getFunctorTypes() const;

	shared_ptr<TimingDeltas> timingDeltas;
	Scene* scene = nullptr; // set before every loop
	string label;
};

template <class Dispatch1, class Dispatch2, class Result, class Arguments>
class Functor2D : public Functor, public FunctorWrapper<Result, Arguments> {
public:
	std::vector<std::string> getFunctorTypes() const override { return { get2DFunctorType1(), get2DFunctorType2() }; }
	virtual std::string get2DFunctorType1() const { throw std::logic_error(getClassName() + " doesn't say what it takes (FUNCTOR2D)"); }
	virtual std::string get2DFunctorType2() const { throw std::logic_error(getClassName() + " doesn't say what it takes (FUNCTOR2D)"); }
};

// The types of the arguments are part of the base classes' names and must be exactly these.
using IPhysFunctorBase_ = Functor2D<Material, Material, void,
        boost::mpl::vector<const shared_ptr<Material>&, const shared_ptr<Material>&, const shared_ptr<Interaction>&>>;
using LawFunctorBase_ = Functor2D<IGeom, IPhys, bool, boost::mpl::vector<shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*>>;

class IPhysFunctor : public IPhysFunctorBase_ {
public:
	IPhysFunctor() {} // not exported
	YADE_INTERFACE_OVERRIDES_(IPhysFunctor)
};

// go() returns false to have the interaction deleted
class LawFunctor : public LawFunctorBase_ {
public:
	LawFunctor() {} // not exported
	YADE_INTERFACE_OVERRIDES_(LawFunctor)
};

#define FUNCTOR2D(Type1, Type2)                                                                                                            \
public:                                                                                                                                    \
	std::string get2DFunctorType1() const override { return #Type1; }                                                                  \
	std::string get2DFunctorType2() const override { return #Type2; }                                                                  \
	static_assert(true, "")

// ---- what stands in O.engines ----

class Engine : public Serializable {
public:
	Engine();
	YADE_INTERFACE_OVERRIDES_(Engine)
	virtual bool isActivated();
	virtual void action();

	Scene* scene; // set before action() is called

private:
	long timingInfo[2]; // calls, nanoseconds
	shared_ptr<TimingDeltas> timingDeltas;

public:
	bool dead;
	int ompThreads;
	string label;
};

class GlobalEngine : public Engine {
public:
	GlobalEngine() {} // not exported
	YADE_INTERFACE_OVERRIDES_(GlobalEngine)
};

// ---- the scene: bodies, interactions, forces, energies, cell and time ----

// All bodies by id. Erased ones leave an empty pointer, which operator[] shows and the iterator skips.
class BodyContainer : public Serializable {
public:
	using ContainerT = std::vector<shared_ptr<Body>>;
	struct IsThere {
		bool operator()(const shared_ptr<Body>& body) const { return bool(body); }
	};
	using iterator = boost::filter_iterator<IsThere, ContainerT::iterator>;

	YADE_INTERFACE_OVERRIDES_(BodyContainer)

	// Always inline: libyade exports functions of these names, whose iterator is another type.
	[[gnu::always_inline]] iterator begin() { return iterator(IsThere(), body.begin(), body.end()); }
	[[gnu::always_inline]] iterator end() { return iterator(IsThere(), body.end(), body.end()); }
	[[gnu::always_inline]] size_t size() const { return body.size(); }
	[[gnu::always_inline]] shared_ptr<Body>& operator[](unsigned int id) { return body[id]; }
	[[gnu::always_inline]] const shared_ptr<Body>& operator[](unsigned int id) const { return body[id]; }

private:
	BodyContainer(); // made by YADE only
	ContainerT body;

public:
	bool dirty, checkedByCollider;
	std::vector<int> insertedBodies, erasedBodies, realBodies;
	bool useRedirection, enableRedirection;

private:
#ifdef YADE_MPI
	std::vector<int> subdomainBodies;
#endif
	pthread_mutex_t drawloopmutex;
};

class InteractionContainer : public Serializable {
public:
	using ContainerT = std::vector<shared_ptr<Interaction>>;
	using iterator = ContainerT::iterator;

	YADE_INTERFACE_OVERRIDES_(InteractionContainer)

	[[gnu::always_inline]] iterator begin() { return linIntrs.begin(); }
	[[gnu::always_inline]] iterator end() { return linIntrs.end(); }
	[[gnu::always_inline]] size_t size() { return currSize; } // not const in YADE either
	[[gnu::always_inline]] const shared_ptr<Interaction>& operator[](size_t i) const { return linIntrs[i]; }

	bool insert(const shared_ptr<Interaction>&);
	void clear();

private:
	InteractionContainer(); // made by YADE only
	ContainerT linIntrs, sortedIntrs;
	const std::vector<shared_ptr<Body>>* bodies;
	size_t currSize;
	shared_ptr<Interaction> empty;

public:
	std::vector<shared_ptr<Interaction>> interaction; // filled while saving and loading
	bool dirty;

private:
	pthread_mutex_t drawloopmutex;

public:
	bool serializeSorted;
	long iterColliderLastRun;
};

// Forces and torques on bodies. libyade exports all functions; the members are room only.
class ForceContainer {
	char room[264 + sizeof(pthread_mutex_t)] __attribute__((aligned(8)));
	ForceContainer(); // made by YADE only, inside of Scene
	ForceContainer(const ForceContainer&);

public:
	// safe from InteractionLoop's threads
	void addForce(Body::id_t, const Vector3r&);
	void addTorque(Body::id_t, const Vector3r&);
	// valid after sync()
	const Vector3r& getForce(Body::id_t);
	const Vector3r& getTorque(Body::id_t);
	// permanent ones (O.forces.setPermF, setPermT); valid after sync()
	const Vector3r& getPermForce(Body::id_t);
	const Vector3r& getPermTorque(Body::id_t);
	void setPermForce(Body::id_t, const Vector3r&);
	void setPermTorque(Body::id_t, const Vector3r&);
	bool getPermForceUsed() const; // whether any was ever set
	void sync();
	void reset(long iter, bool resetAll = false); // resetAll: permanent forces (O.forces.setPermF) too
};

// O.energy: sums by name.
class EnergyTracker : public Serializable {
	char energies[64] __attribute__((aligned(8)));
	EnergyTracker(); // made by YADE only

public:
	YADE_INTERFACE_OVERRIDES_(EnergyTracker)

	// id is kept by the caller for the name, and starts at -1; reset: the sum starts anew each step. Exported by libpkg_dem. Not safe against
	// concurrent first calls of a name, and ids are stale after O.energy.clear().
	void add(const Real& value, const std::string& name, int& id, bool reset = false);
	std::map<std::string, int> names; // ids
	// What O.energy[name] = value calls, with no Python in it; makes the name if it is not there.
	void setItem_py(const std::string& name, Real value);

private:
	char more[40] __attribute__((aligned(8)));
};

// The periodic cell. No function of it that shifts positions is exported.
class Cell : public Serializable {
public:
	Cell();
	void integrateAndUpdate(Real dt); // deforms it by velGrad through dt [s]
	YADE_INTERFACE_OVERRIDES_(Cell)

private:
	char room[568] __attribute__((aligned(8))); // shear and size derived from hSize

public:
	Matrix3r trsf;
	Matrix3r refHSize;
	Matrix3r hSize; // columns are the cell's edges
	Matrix3r prevHSize;
	Matrix3r velGrad;
	Matrix3r nextVelGrad;
	Matrix3r prevVelGrad;
	int homoDeform;
	bool velGradChanged, flipFlippable;
};

class Scene : public Serializable {
public:
	Scene();
	YADE_INTERFACE_OVERRIDES_(Scene)

private:
	unsigned int hostNameMax;

public:
	ForceContainer forces;

private:
	char room1[104] __attribute__((aligned(8))); // speed of the last steps, renderer, clock

public:
	Real dt;
	long iter;
	bool subStepping;
	int subStep;
	Real time;
	Real speed;
	long stopAtIter;
	Real stopAtTime;
	bool isPeriodic;
	bool trackEnergy;
	bool doSort;
	bool runInternalConsistencyChecks;

private:
	int selectedBody;
#ifdef YADE_MPI
	int subdomain[6]; // and communicator
#endif

public:
	std::vector<std::string> tags;
	std::vector<shared_ptr<Engine>> engines;
	std::vector<shared_ptr<Engine>> _nextEngines;
	shared_ptr<BodyContainer> bodies;
	shared_ptr<InteractionContainer> interactions;
	shared_ptr<EnergyTracker> energy;
	std::vector<shared_ptr<Material>> materials;
	shared_ptr<Bound> bound;
	shared_ptr<Cell> cell;

private:
	char room3[48] __attribute__((aligned(8))); // parameters for display and others
};

// The running YADE. Its object lives in libyade and only exported functions are called: its layout doesn't matter here.
class Omega : public Singleton<Omega> {
public:
	const shared_ptr<Scene>& getScene() const;
	bool isRunning(); // whether O.step() or O.run() is stepping in its thread
	// makes the named classes known to YADE and to yade.wrapper
	void buildDynlibDatabase(const std::vector<std::string>& classNames);
};

} // namespace yade

SAVED_BY_YADE(Functor)
SAVED_BY_YADE(IPhysFunctor)
SAVED_BY_YADE(LawFunctor)
SAVED_BY_YADE(Engine)
SAVED_BY_YADE(GlobalEngine)
