// Containers of bodies, interactions, forces and energies: filled in a scene that is made for the purpose; of the running scene only pointers are compared.
#include "layouts.hpp"
#include "safe_memory.hpp"
#include <core/Engine.hpp>
#include <core/Omega.hpp>

#pragma GCC diagnostic ignored "-Winvalid-offsetof"

namespace contact_law {
namespace proof {

	using namespace yade;

	namespace {
		std::string notThere(const char* what, size_t offset)
		{
			return refusal(std::string("Scene.") + what + " isn't where this plugin has it", "byte " + std::to_string(offset));
		}

		// Nothing is followed before its class is known.
		std::string differenceInPointers(Scene& scene)
		{
			const auto holds = [](const void* pointer, const char* mangledClass) {
				return pointer && classOf(pointer) == mangledClass;
			};
			if (!fits(&scene, sizeof scene))
				return refusal("Scene is smaller than declared", "size " + std::to_string(sizeof scene));
			if (!holds(scene.bodies.get(), "N4yade13BodyContainerE")) return notThere("bodies", offsetof(Scene, bodies));
			if (!holds(scene.interactions.get(), "N4yade20InteractionContainerE"))
				return notThere("interactions", offsetof(Scene, interactions));
			if (!holds(scene.energy.get(), "N4yade13EnergyTrackerE")) return notThere("energy", offsetof(Scene, energy));
			if (!holds(scene.cell.get(), "N4yade4CellE")) return notThere("cell", offsetof(Scene, cell));
			return "";
		}

		std::string differenceInRunningScene(Scene& scene)
		{
			const py::object omega = make("Omega");
			if (&py::extract<Scene&>(omega.attr("_sceneObj"))() != &scene)
				return refusal("the running scene isn't what Omega says", "Omega::getScene");
			std::string difference = differenceInPointers(scene);
			if (!difference.empty()) return difference;
			if (&py::extract<EnergyTracker&>(omega.attr("energy"))() != scene.energy.get())
				return notThere("energy", offsetof(Scene, energy));
			if (py::len(omega.attr("_currEngines")) != long(scene.engines.size()))
				return notThere("engines", offsetof(Scene, engines));
			if (py::len(omega.attr("materials")) != long(scene.materials.size()))
				return notThere("materials", offsetof(Scene, materials));
			if (py::len(omega.attr("bodies")) != long(scene.bodies->size())) return notThere("bodies", offsetof(Scene, bodies));
			const py::object engine = make("Engine"); // a new engine belongs to the running scene
			const Engine* inside = &py::extract<const Engine&>(engine)();
			if (fits(inside, sizeof *inside) && inside->scene != &scene)
				return refusal(
				        "Engine.scene isn't where this plugin has it", "byte " + std::to_string(offsetof(Engine, scene)));
			return "";
		}

		shared_ptr<Body> newBody(py::object& keepAlive)
		{
			keepAlive = make("Body");
			return py::extract<shared_ptr<Body>>(keepAlive)();
		}

		std::string differenceInContainers(Scene& scene)
		{
			py::object body1, body2;
			const shared_ptr<Body> first = newBody(body1), second = newBody(body2);
			BodyContainer& bodies = *scene.bodies;
			bodies.insert(first);
			bodies.insert(second);
			int seen = 0;
			for (const auto& body : bodies)
				seen += body == first || body == second;
			if (seen != 2 || bodies.size() != 2 || bodies[0] != first || bodies[1] != second || second->getId() != 1)
				return refusal("BodyContainer doesn't hold the bodies that it was given", "byte 24");

			py::object contact = make("Interaction");
			const shared_ptr<Interaction> pair = py::extract<shared_ptr<Interaction>>(contact)();
			pair->id1 = 0;
			pair->id2 = 1;
			InteractionContainer& interactions = *scene.interactions;
			interactions.insert(pair);
			if (interactions.size() != 1 || interactions[0] != pair || pair->linIx != 0 || interactions.find(0, 1) != pair
			        || first->intrs.size() != 1)
				return refusal("InteractionContainer doesn't hold the interaction that it was given", "byte 24");
			interactions.clear();
			if (interactions.size() != 0 || interactions.begin() != interactions.end() || !first->intrs.empty())
				return refusal("InteractionContainer isn't empty after it was cleared", "InteractionContainer::clear");
			return "";
		}

		std::string differenceInForces(Scene& scene)
		{
			// an untouched ForceContainer begins with one list per thread in each of two vectors
			const char* start = reinterpret_cast<const char*>(&scene.forces);
			const char* ends[4];
			readSafely(start, &ends[0], 16);
			readSafely(start + 24, &ends[2], 16);
			const long threads = py::extract<long>(make("Omega").attr("numThreads"));
			if (ends[1] - ends[0] != 24 * threads || ends[3] - ends[2] != 24 * threads)
				return notThere("forces", offsetof(Scene, forces));
			const Vector3r force(1.5, 2.5, 3.5), torque(4.5, 5.5, 6.5);
			scene.forces.addForce(1, force);
			scene.forces.addTorque(1, torque);
			scene.forces.sync();
			if (scene.forces.getForce(1) != force || scene.forces.getTorque(1) != torque)
				return notThere("forces", offsetof(Scene, forces));
			return "";
		}

		// Names, of which there is one: nothing of the map is followed before it is known to be the map.
		bool holdsOneName(const EnergyTracker& energies, const std::string& name, int id)
		{
			struct Node {
				size_t colour;
				const char *parent, *left, *right;
				char name[sizeof(std::string)];
				int id;
			} node;
			struct {
				size_t compare, colour;
				const char *parent, *left, *right;
				size_t count;
			} map;
			const char* start = reinterpret_cast<const char*>(&energies.names);
			static_assert(sizeof map == sizeof energies.names, "std::map of the library that YADE is built with");
			if (!fits(&energies, sizeof energies) || !readSafely(start, &map, sizeof map)) return false;
			if (map.count != 1 || map.left != map.parent || map.right != map.parent) return false;
			if (!readSafely(map.parent, &node, sizeof node) || node.parent != start + sizeof map.compare) return false;
			return node.id == id && equalsAt(map.parent + offsetof(Node, name), name);
		}

		std::string differenceInEnergies()
		{
			py::object tracker = make("EnergyTracker");
			EnergyTracker& energies = py::extract<EnergyTracker&>(tracker)();
			int id = -1;
			energies.add(3.25, "proof", id, false);
			if (double(py::extract<double>(tracker["proof"])) != 3.25)
				return refusal("EnergyTracker doesn't hold what was added", "EnergyTracker::add");
			if (!holdsOneName(energies, "proof", id))
				return refusal("EnergyTracker.names isn't where this plugin has it",
				        "byte " + std::to_string(offsetof(EnergyTracker, names)));
			energies.setItem_py("proof", 4.5);
			if (double(py::extract<double>(tracker["proof"])) != 4.5)
				return refusal("EnergyTracker doesn't hold what was set", "EnergyTracker::setItem_py");
			return "";
		}
	}

	std::string differenceInScenes()
	{
		Scene& running = *Omega::instance().getScene();
		std::string difference = differenceInRunningScene(running);
		if (!difference.empty()) return difference;

		py::object own = make("Scene");
		Scene& scene = py::extract<Scene&>(own)();
		difference = differenceInPointers(scene);
		const bool sort = running.doSort; // inserting a body anywhere sets it
		if (difference.empty()) difference = differenceInContainers(scene);
		running.doSort = sort;
		if (difference.empty()) difference = differenceInForces(scene);
		if (difference.empty()) difference = differenceInEnergies();
		return difference;
	}

} // namespace proof
} // namespace contact_law
