// The functors of InteractionLoop that a contact law derives from.
#pragma once
#include <core/Functor.hpp>
#include <core/Interaction.hpp>

namespace yade {

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
static_assert(sizeof(IPhysFunctor) == 88, "IPhysFunctor");

// go() returns false to have the interaction deleted
class LawFunctor : public LawFunctorBase_ {
public:
	LawFunctor() {} // not exported
	~LawFunctor() override;
	YADE_INTERFACE_OVERRIDES_(LawFunctor)
};
static_assert(sizeof(LawFunctor) == 88, "LawFunctor");

} // namespace yade

SAVED_BY_YADE(IPhysFunctor)
SAVED_BY_YADE(LawFunctor)
