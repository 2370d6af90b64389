// YADE's bodies as the fused engine's grains, and back.
#pragma once
#include "../engine/dynamics.hpp"
#include <core/Scene.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace yade {

[[noreturn]] inline void refuseInEngine(const std::string& what) { throw std::runtime_error("JKRWadaEngine: " + what); }

struct SceneGrains { // in the order of the ids
	std::vector<contact_law::GrainInput> grains;
	std::vector<contact_law::Material> materials;
	std::vector<shared_ptr<State>> states;
};

// Throws std::runtime_error for a body that the engine cannot move.
SceneGrains readGrains(const Scene&);

// Position, velocities, mass, blocked degrees of freedom and orientation of a body.
contact_law::GrainInput grainOf(const State&);
bool finite(const contact_law::GrainInput&);

// Whether nobody has touched the body since it was written.
bool sameMotion(const State&, const contact_law::GrainInput&, bool orientations);
void write(const contact_law::GrainInput&, State&, bool orientations);

} // namespace yade
