// Scenes in files: grains and contacts at one moment, and what a run needs besides. tests/benchmarks/scene_file.py lists the same fields.
#pragma once
#include "../../../contact_law/engine/exchange.hpp"
#include <cstdint>
#include <string>
#include <vector>

namespace harness {

// Records as they lie in a file, one after the other: the head, the materials, the grains, the contacts. SI units; every field has eight bytes.
struct Head {
	char magic[8];
	std::int64_t format, materials, grains, contacts;
	double time, step, linearDamping, neck; // of the scene [s]; small step [s]; k_n; necks of bonds over the grains' radius
	double cellSize[3], strainRate[3];      // [m], zero in open space; d(ln size)/dt [1/s]
};
struct MaterialRecord {
	double young, poisson, density, surfaceEnergy, criticalRolling, viscoelasticTime;
};
struct GrainRecord {
	double position[3], velocity[3], angularVelocity[3]; // of one moment
	double radius, mass, inertia;
	std::int64_t material, blocked;
};
struct ContactRecord {
	std::int64_t first, second, bonded;     // grains by their numbers
	double pointer1[3], pointer2[3], twist; // laboratory frame
	double overlap, drag, rest;             // [m]; [N]; distance of the centres at which a bond was made [m]
};

/* All of a scene. Without contacts it is a start: grains that overlap touch, with unstrained springs (with a neck: bonded). The mean flow of a periodic
 * cell is in the grains' velocities. */
struct Scene {
	Head head;
	std::vector<MaterialRecord> materials;
	std::vector<GrainRecord> grains;
	std::vector<ContactRecord> contacts;

	bool periodic() const { return head.cellSize[0] > 0; }
};

// Both throw std::runtime_error, with one line.
Scene readScene(const std::string& path);
void writeScene(const std::string& path, const Scene&);

} // namespace harness
