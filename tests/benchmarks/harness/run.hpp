// A scene of a file in the engine, as JKRWadaEngine has it in YADE.
#pragma once
#include "scene_file.hpp"
#include <memory>

namespace harness {

using contact_law::ContactNow;
using contact_law::Dynamics;
using contact_law::GrainInput;
using contact_law::GrainMotion;
using contact_law::Inherited;
using contact_law::Vec3;

inline Vec3<double> vector(const double (&x)[3]) { return { x[0], x[1], x[2] }; }
inline void set(double (&x)[3], const Vec3<double>& v) { x[0] = v.x, x[1] = v.y, x[2] = v.z; }

inline Dynamics::Materials materialsOf(const Scene& scene)
{
	Dynamics::Materials materials;
	for (const MaterialRecord& m : scene.materials)
		materials.push_back({ m.young, m.poisson, m.density, m.surfaceEnergy, m.criticalRolling, m.viscoelasticTime });
	return materials;
}

inline Dynamics::Grains grainsOf(const Scene& scene)
{
	Dynamics::Grains grains;
	for (const GrainRecord& record : scene.grains) {
		GrainInput grain {};
		grain.position = vector(record.position);
		grain.velocity = vector(record.velocity);
		grain.angularVelocity = vector(record.angularVelocity);
		grain.blocked = unsigned(record.blocked);
		grain.radius = record.radius, grain.mass = record.mass, grain.inertia = record.inertia;
		grain.kind = int(record.material);
		grains.push_back(grain);
	}
	return grains;
}

inline Inherited contactsOf(const Scene& scene)
{
	Inherited inherited;
	for (const ContactRecord& c : scene.contacts)
		inherited.contacts.push_back({ int(c.first), int(c.second), { { vector(c.pointer1), vector(c.pointer2) }, c.twist }, c.drag,
		        c.overlap, c.bonded ? scene.head.neck : 0, c.rest });
	return inherited;
}

inline Dynamics::Options optionsOf(const Scene& scene, int domains, int threads, const std::string& instructions)
{
	Dynamics::Options options;
	options.dt = scene.head.step;
	options.pairs.linearDamping = scene.head.linearDamping;
	options.neck = scene.head.neck;
	options.domains = domains;
	options.threads = threads;
	options.instructions = instructions;
	bool drag = options.pairs.linearDamping > 0;
	for (const MaterialRecord& material : scene.materials)
		drag = drag || material.viscoelasticTime > 0;
	options.mechanisms = contact_law::mechanismsOf(true, true, true, drag, false);
	if (scene.periodic()) {
		const Vec3<double> size = vector(scene.head.cellSize), strain = vector(scene.head.strainRate);
		options.cell = contact_law::PeriodicCell::box(size, contact_law::Images<double>::times(strain, size));
	}
	return options;
}

inline ContactRecord recordOf(const ContactNow& c)
{
	ContactRecord record {};
	record.first = c.first, record.second = c.second, record.bonded = c.bonded;
	set(record.pointer1, c.history.pointers.n1);
	set(record.pointer2, c.history.pointers.n2);
	record.twist = c.history.twist;
	record.overlap = c.geometry.overlap, record.drag = c.forces.drag, record.rest = c.rest;
	return record;
}

class Run {
public:
	Run(const Scene& scene_, int domains, int threads, const std::string& instructions)
	        : scene(scene_)
	{
		const auto options = optionsOf(scene, domains, threads, instructions);
		const auto grains = grainsOf(scene);
		const auto materials = materialsOf(scene);
		engine = scene.contacts.empty() ? std::make_unique<Dynamics>(grains, materials, options)
		                                : std::make_unique<Dynamics>(grains, materials, options, contactsOf(scene));
	}

	/* Small steps, `together` at a time as in an O.step with so many subSteps: a periodic cell's size goes evenly through each of these.
	 * Throws std::runtime_error when the run breaks down. */
	void run(long steps, long together)
	{
		for (long left = steps; left > 0; left -= together) {
			const long now = std::min(left, together);
			const double time = double(now) * scene.head.step;
			Vec3<double> size = engine->cell().size;
			size = size + time * contact_law::Images<double>::times(vector(scene.head.strainRate), size);
			if (engine->run(now, scene.periodic() ? &size : nullptr) < now) {
				const contact_law::Fastest what = contact_law::fastestGrain(*engine);
				throw std::runtime_error("the run broke down: grain " + std::to_string(what.id) + " moves at "
				        + std::to_string(what.speed) + " m/s");
			}
			scene.head.time += time;
		}
	}

	Scene sceneNow() const
	{
		Scene now = scene;
		std::vector<GrainMotion> motions;
		engine->read(motions);
		for (std::size_t k = 0; k < motions.size(); ++k) {
			set(now.grains[k].position, motions[k].position);
			set(now.grains[k].velocity, motions[k].velocity);
			set(now.grains[k].angularVelocity, motions[k].angularVelocity);
		}
		if (scene.periodic()) set(now.head.cellSize, engine->cell().size);
		now.contacts.clear();
		const auto keep = [&](const auto& list, int slot, int, int) {
			now.contacts.push_back(recordOf(contact_law::contactNow(*engine, list, slot)));
		};
		contact_law::eachContact(*engine, keep);
		contact_law::eachBond(*engine, keep);
		return now;
	}

	// Of all bits of positions, velocities and angular velocities, in the order of the grains given (FNV-1a).
	std::uint64_t hash() const
	{
		std::vector<GrainMotion> motions;
		engine->read(motions);
		std::uint64_t hash = 14695981039346656037u;
		for (const GrainMotion& g : motions)
			for (const auto* numbers : { &g.position, &g.velocity, &g.angularVelocity })
				for (std::size_t k = 0; k < sizeof *numbers; ++k)
					hash = (hash ^ reinterpret_cast<const unsigned char*>(numbers)[k]) * 1099511628211u;
		return hash;
	}

	Dynamics& dynamics() { return *engine; }

private:
	Scene scene;
	std::unique_ptr<Dynamics> engine;
};

} // namespace harness
