// Functors, which dispatchers choose by the classes of their arguments, and those of InteractionLoop that a contact law derives from.
#pragma once
#include <core/Interaction.hpp>
#include <boost/mpl/at.hpp>
#include <boost/mpl/vector.hpp>
#include <boost/mpl/void.hpp>
#include <stdexcept>

namespace yade {

class Scene;
class TimingDeltas;

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
	Functor()
	        : scene(nullptr)
	{
	} // not exported
	~Functor() override;
	YADE_INTERFACE_OVERRIDES_(Functor)
	virtual std::vector<std::string> getFunctorTypes() const;

	shared_ptr<TimingDeltas> timingDeltas;
	Scene* scene; // set before every loop
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
	~IPhysFunctor() override;
	YADE_INTERFACE_OVERRIDES_(IPhysFunctor)
};

// go() returns false to have the interaction deleted
class LawFunctor : public LawFunctorBase_ {
public:
	LawFunctor() {} // not exported
	~LawFunctor() override;
	YADE_INTERFACE_OVERRIDES_(LawFunctor)
};

} // namespace yade

SAVED_BY_YADE(Functor)
SAVED_BY_YADE(IPhysFunctor)
SAVED_BY_YADE(LawFunctor)

#define FUNCTOR2D(Type1, Type2)                                                                                                            \
public:                                                                                                                                    \
	std::string get2DFunctorType1() const override { return #Type1; }                                                                  \
	std::string get2DFunctorType2() const override { return #Type2; }                                                                  \
	static_assert(true, "")
