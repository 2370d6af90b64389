// A scene of a file in the engine, as JKRWadaEngine has it in YADE.
#pragma once
#include "scene_file.hpp"
#include <memory>

namespace harness {

class Run {
public:
	// Throws std::invalid_argument or std::runtime_error for a scene that the engine cannot start from.
	Run(const Scene&, int domains, int threads, const std::string& instructions);

	/* Small steps, `together` at a time as in an O.step with so many subSteps: a periodic cell's size goes evenly through each of these.
	 * Throws std::runtime_error when the run breaks down. */
	void run(long steps, long together);

	Scene sceneNow() const;
	std::uint64_t hash()
	        const;          // of all bits of positions, velocities and angular velocities, in the order of the grains given (FNV-1a)
	double totalEnergy();   // all channels [J]: constant
	double kineticEnergy(); // [J]
	contact_law::Dynamics& dynamics() { return *engine; }

private:
	void advanceCell(double time, contact_law::Vec3<double>& size) const;

	Scene scene;
	std::unique_ptr<contact_law::Dynamics> engine;
};

} // namespace harness
