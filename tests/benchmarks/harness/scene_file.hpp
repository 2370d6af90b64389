// Scenes in files: grains and contacts at one moment, and what a run needs besides. tests/benchmarks/scene_file.py lists the same fields.
#pragma once
#include "../../../contact_law/engine/contacts.hpp"
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
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

constexpr char magic[9] = "JKRscene";
constexpr std::int64_t format = 1;

template <class Record> void read(std::ifstream& file, std::vector<Record>& records, std::int64_t count)
{
	records.resize(std::size_t(count));
	file.read(reinterpret_cast<char*>(records.data()), std::streamsize(sizeof(Record) * records.size()));
}
template <class Record> void write(std::ofstream& file, const std::vector<Record>& records)
{
	file.write(reinterpret_cast<const char*>(records.data()), std::streamsize(sizeof(Record) * records.size()));
}

// Throws std::runtime_error, with one line.
inline Scene readScene(const std::string& path)
{
	std::ifstream file(path, std::ios::binary);
	Scene scene {};
	Head& head = scene.head;
	file.read(reinterpret_cast<char*>(&head), sizeof head);
	if (!file || std::memcmp(head.magic, magic, sizeof head.magic) != 0)
		throw std::runtime_error(path + ": must be a scene that tests/benchmarks/scene_file.py or the harness wrote");
	if (head.format != format) throw std::runtime_error(path + ": must be a scene of format " + std::to_string(format));
	read(file, scene.materials, head.materials);
	read(file, scene.grains, head.grains);
	read(file, scene.contacts, head.contacts);
	if (!file || file.peek() != std::ifstream::traits_type::eof())
		throw std::runtime_error(path + ": must be as long as its head says");
	return scene;
}

inline void writeScene(const std::string& path, const Scene& scene)
{
	Head head = scene.head;
	std::memcpy(head.magic, magic, sizeof head.magic);
	head.format = format;
	head.materials = std::int64_t(scene.materials.size());
	head.grains = std::int64_t(scene.grains.size());
	head.contacts = std::int64_t(scene.contacts.size());
	std::ofstream file(path, std::ios::binary);
	file.write(reinterpret_cast<const char*>(&head), sizeof head);
	write(file, scene.materials);
	write(file, scene.grains);
	write(file, scene.contacts);
	file.flush();
	if (!file) throw std::runtime_error(path + ": could not be written");
}

} // namespace harness
