// The table: every member of a YADE class that the plugin reads, writes or derives past.
#include "layouts.hpp"
#include <core/Engine.hpp>
#include <core/Functor.hpp>
#include <core/Interaction.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/NormShearPhys.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/common/Wall.hpp>
#include <pkg/dem/ScGeom.hpp>
#include <cstddef>

#pragma GCC diagnostic ignored "-Winvalid-offsetof" // well defined by the compilers that build YADE

namespace contact_law {
namespace proof {

	using namespace yade;

	namespace {
		// In Python a string of letters.
		std::string compareBlockedDOFs(const Member& row, int)
		{
			py::object object = make(row.className);
			char* start = reinterpret_cast<char*>(&py::extract<State&>(object)());
			if (!fits(start, row.offset + sizeof(unsigned))) return "the object ends before it";
			object.attr(row.name) = "yZ";
			if (!equalsAt(start + row.offset, unsigned(State::DOF_Y | State::DOF_RZ))) return "what Python wrote isn't there";
			*reinterpret_cast<unsigned*>(start + row.offset) = State::DOF_X | State::DOF_RY;
			if (std::string(py::extract<std::string>(object.attr(row.name))) != "xY")
				return "Python doesn't see what is written there";
			return "";
		}

		// pos and ori are references into se3
		template <class T> std::string compareInSe3(const Member& row, int number)
		{
			py::object object = make(row.className);
			State& state = py::extract<State&>(object)();
			char* start = reinterpret_cast<char*>(&state);
			if (!fits(start, sizeof(State))) return "the object ends before it";
			if (reinterpret_cast<char*>(&state.pos) != start + offsetof(State, se3.position)
			        || reinterpret_cast<char*>(&state.ori) != start + offsetof(State, se3.orientation))
				return "pos and ori don't refer to it";
			T fromPython, fromHere;
			sample(number, fromPython);
			sample(number + 1, fromHere);
			object.attr(row.name) = fromPython;
			if (!equalsAt(start + row.offset, fromPython)) return "what Python wrote isn't there";
			*reinterpret_cast<T*>(start + row.offset) = fromHere;
			if (!(py::extract<T>(object.attr(row.name))().isApprox(fromHere)))
				return "Python doesn't see what is written there";
			return "";
		}

		// Follows hSize whenever Python writes anything.
		std::string comparePrevHSize(const Member& row, int number)
		{
			py::object object = make(row.className);
			char* start = reinterpret_cast<char*>(&py::extract<Cell&>(object)());
			if (!fits(start, row.offset + sizeof(Matrix3r))) return "the object ends before it";
			Matrix3r fromPython, fromHere;
			sample(number, fromPython);
			sample(number + 1, fromHere);
			write(object, "hSize", py::object(fromPython));
			if (!equalsAt(start + row.offset, fromPython)) return "what Python wrote isn't there";
			*reinterpret_cast<Matrix3r*>(start + row.offset) = fromHere;
			if (!(py::extract<Matrix3r>(object.attr(row.name))() == fromHere))
				return "Python doesn't see what is written there";
			return "";
		}

		template <class Class, class Target> std::string compareGeom(const Member& row, int)
		{
			return comparePointer<Class, Target>(row, "ScGeom");
		}
		template <class Class, class Target> std::string comparePhys(const Member& row, int)
		{
			return comparePointer<Class, Target>(row, "NormShearPhys");
		}
		template <class Class, class Target> std::string compareMaterial(const Member& row, int)
		{
			return comparePointer<Class, Target>(row, "ElastMat");
		}
		template <class Class, class Target> std::string compareState(const Member& row, int)
		{
			return comparePointer<Class, Target>(row, "State");
		}
		template <class Class, class Target> std::string compareShape(const Member& row, int)
		{
			return comparePointer<Class, Target>(row, "Sphere");
		}
	}

#define MEMBER(Class, member, T)                                                                                                           \
	{                                                                                                                                  \
#Class, #member, offsetof(Class, member), sizeof(Class), &compareBothWays < Class, T>                                      \
	}
#define MEMBER_BY(Class, name, member, compare)                                                                                            \
	{                                                                                                                                  \
#Class, #name, offsetof(Class, member), sizeof(Class), &compare                                                            \
	}

	std::vector<Member> members()
	{
		return {
			MEMBER(ElastMat, id, int),
			MEMBER(ElastMat, label, std::string),
			MEMBER(ElastMat, density, Real),
			MEMBER(ElastMat, young, Real),
			MEMBER(ElastMat, poisson, Real),
			MEMBER_BY(State, pos, se3.position, compareInSe3<Vector3r>),
			MEMBER_BY(State, ori, se3.orientation, compareInSe3<Quaternionr>),
			MEMBER(State, vel, Vector3r),
			MEMBER(State, mass, Real),
			MEMBER(State, angVel, Vector3r),
			MEMBER(State, angMom, Vector3r),
			MEMBER(State, inertia, Vector3r),
			MEMBER(State, refPos, Vector3r),
			MEMBER(State, isDamped, bool),
			MEMBER(State, densityScaling, Real),
			MEMBER_BY(State, blockedDOFs, blockedDOFs, compareBlockedDOFs),
			MEMBER(Sphere, radius, Real),
			MEMBER(Wall, sense, int),
			MEMBER(Wall, axis, int),
			MEMBER(Body, id, int),
			MEMBER(Body, groupMask, int),
			MEMBER(Body, flags, int),
			MEMBER(Body, clumpId, int),
			MEMBER(Body, iterBorn, long),
			MEMBER(Body, timeBorn, Real),
			MEMBER_BY(Body, material, material, (compareMaterial<Body, Material>)),
			MEMBER_BY(Body, state, state, (compareState<Body, State>)),
			MEMBER_BY(Body, shape, shape, (compareShape<Body, Shape>)),
			MEMBER(NormShearPhys, kn, Real),
			MEMBER(NormShearPhys, normalForce, Vector3r),
			MEMBER(NormShearPhys, ks, Real),
			MEMBER(NormShearPhys, shearForce, Vector3r),
			MEMBER(ScGeom, normal, Vector3r),
			MEMBER(ScGeom, contactPoint, Vector3r),
			MEMBER(ScGeom, refR1, Real),
			MEMBER(ScGeom, refR2, Real),
			MEMBER(ScGeom, penetrationDepth, Real),
			MEMBER(ScGeom, shearInc, Vector3r),
			MEMBER(Interaction, id1, int),
			MEMBER(Interaction, id2, int),
			MEMBER(Interaction, iterMadeReal, long),
			MEMBER(Interaction, cellDist, Vector3i),
			MEMBER(Interaction, iterBorn, long),
			MEMBER_BY(Interaction, geom, geom, (compareGeom<Interaction, IGeom>)),
			MEMBER_BY(Interaction, phys, phys, (comparePhys<Interaction, IPhys>)),
			MEMBER(Cell, trsf, Matrix3r),
			MEMBER(Cell, refHSize, Matrix3r),
			MEMBER(Cell, hSize, Matrix3r),
			MEMBER_BY(Cell, prevHSize, prevHSize, comparePrevHSize),
			MEMBER(Cell, velGrad, Matrix3r),
			MEMBER(Cell, nextVelGrad, Matrix3r),
			MEMBER(Cell, prevVelGrad, Matrix3r),
			MEMBER(Cell, homoDeform, int),
			MEMBER(Cell, velGradChanged, bool),
			MEMBER(Scene, dt, Real),
			MEMBER(Scene, iter, long),
			MEMBER(Scene, subStep, int),
			MEMBER(Scene, time, Real),
			MEMBER(Scene, stopAtIter, long),
			MEMBER(Scene, stopAtTime, Real),
			MEMBER(Scene, isPeriodic, bool),
			MEMBER(Scene, trackEnergy, bool),
			MEMBER(Scene, doSort, bool),
			MEMBER(Engine, dead, bool),
			MEMBER(Engine, ompThreads, int),
			MEMBER(Engine, label, std::string),
			MEMBER(Functor, label, std::string),
		};
	}

} // namespace proof
} // namespace contact_law
