// What dispatchers choose by the classes of their arguments.
#pragma once
#include <declare/at_offset.hpp>
#include <declare/overrides.hpp>
#include <lib/multimethods/FunctorWrapper.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class Scene;
class TimingDeltas;

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
static_assert(sizeof(Functor) == 80, "Functor");
YADE_INTERFACE_AT_(Functor, scene, 40)
YADE_INTERFACE_AT_(Functor, label, 48)

template <class Dispatch1, class Dispatch2, class Result, class Arguments>
class Functor2D : public Functor, public FunctorWrapper<Result, Arguments> {
public:
	std::vector<std::string> getFunctorTypes() const override { return { get2DFunctorType1(), get2DFunctorType2() }; }
	virtual std::string get2DFunctorType1() const { throw std::logic_error(getClassName() + " doesn't say what it takes (FUNCTOR2D)"); }
	virtual std::string get2DFunctorType2() const { throw std::logic_error(getClassName() + " doesn't say what it takes (FUNCTOR2D)"); }
};

} // namespace yade

SAVED_BY_YADE(Functor)

#define FUNCTOR2D(Type1, Type2)                                                                                                            \
public:                                                                                                                                    \
	std::string get2DFunctorType1() const override { return #Type1; }                                                                  \
	std::string get2DFunctorType2() const override { return #Type2; }                                                                  \
	static_assert(true, "")
