#include "SceneShapes.hpp"
#include "SceneContacts.hpp"
#include <limits>
#include <mutex>
#include <thread>

namespace yade {

namespace {
	std::string faultOf(const Wall& wall, const State& state, const Scene& scene, InPeriodic inPeriodic)
	{
		if (wall.sense != 0) return "sense = " + text(wall.sense) + ", must be 0: planes hold grains on both sides";
		if (state.blockedDOFs != State::DOF_ALL)
			return "blockedDOFs must be 'xyzXYZ': planes rest or move at the velocity that they are given";
		if (!state.angVel.isZero()) return "angVel must be zero: planes do not turn";
		if (scene.isPeriodic && inPeriodic == InPeriodic::Refused)
			return "O.periodic must be False: planes in periodic cells are JKRWadaEngine's only";
		if (scene.isPeriodic && !(scene.cell->velGrad.isZero() && scene.cell->nextVelGrad.isZero()))
			return "O.cell.velGrad must be zero: planes do not move with a cell";
		return "";
	}

	// Of the scene, for the functors.
	std::string faultOf(const Scene& scene)
	{
		Real smallest = std::numeric_limits<Real>::infinity(), fastest = 0;
		const Body* moving = nullptr;
		for (const auto& body : *scene.bodies) {
			if (!body || !dynamic_cast<const JKRMat*>(body->material.get())) continue;
			const std::string fault = yade::faultOf(*body, scene, InPeriodic::Refused);
			if (!fault.empty()) return fault;
			if (const auto* sphere = dynamic_cast<const Sphere*>(body->shape.get()))
				smallest = std::min(smallest, sphere->radius);
			const Real speed = body->state->vel.cwiseAbs().maxCoeff();
			if (!(speed <= fastest)) fastest = speed, moving = body.get();
		}
		if (fastest * scene.dt <= smallest / 2) return "";
		return bodyName(moving->getId()) + " moves at " + rounded(moving->state->vel.norm())
		        + " m/s, more than half the smallest radius in a step";
	}

	std::mutex refusals;
	std::string pending; // the refusal that Python will hear of

	int raisePending(void*)
	{
		std::string what;
		{
			const std::lock_guard<std::mutex> only(refusals);
			what.swap(pending);
		}
		PyErr_SetString(PyExc_RuntimeError, what.c_str());
		return -1;
	}
}

const Wall* wallOf(const Body& body) { return dynamic_cast<const Wall*>(body.shape.get()); }
const Wall* wallOf(const Scene& scene, int id) { return wallOf(*(*scene.bodies)[id]); }

std::string faultOf(const Body& body, const Scene& scene, InPeriodic inPeriodic)
{
	const std::string who = bodyName(body.getId());
	if (body.isClumpMember()) return who + " is a member of clump " + text(body.clumpId) + ": grains of JKRMat must be single spheres";
	if (dynamic_cast<const Sphere*>(body.shape.get())) return "";
	const Wall* wall = wallOf(body);
	if (!wall)
		return who + " is a " + (body.shape ? body.shape->getClassName() : "body without shape")
		        + ": bodies of JKRMat must be Spheres or Walls";
	const std::string fault = faultOf(*wall, *body.state, scene, inPeriodic);
	return fault.empty() ? "" : who + ", a Wall: " + fault;
}

void refuseInStep(Scene& scene, const std::string& what)
{
	const std::lock_guard<std::mutex> only(refusals);
	if (!pending.empty()) return;
	pending = what;
	scene.stopAtIter = scene.iter + 1;
	if (Py_AddPendingCall(raisePending, nullptr) != 0) pending.clear(); // no room now: at the next step
	// The main thread looks for such calls when another wants Python's lock.
	std::thread([] { PyGILState_Release(PyGILState_Ensure()); }).detach();
}

bool SceneShapes::fit(Scene& scene)
{
	look(scene, [&] {
		ContactsHolder holder(scene);
		const std::string fault = holder.onlyInEngine() ? ContactsHolder::refusal : faultOf(scene);
		fine = fault.empty();
		if (!fine)
			refuseInStep(scene, "Law2_ScGeom_JKRWadaPhys_JKRWada: " + fault);
		else
			holder.clear(); // those in O.interactions are the functors' from here on
	});
	return fine;
}

} // namespace yade
