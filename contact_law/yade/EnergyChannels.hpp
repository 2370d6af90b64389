// The energy channels in O.energy, by the names that all of the project uses (kernel/energy_channels.hpp).
#pragma once
#include "../kernel/energy_channels.hpp"
#include "OncePerStep.hpp"
#include <array>

namespace yade {

class EnergyChannels {
public:
	// EnergyTracker loses its names when it is cleared, and may give them out from one thread only: to be called once a step before
	// adding. planes: work is done on moving planes.
	void prepare(Scene& scene, bool planes)
	{
		prepared(scene, [&] { findIds(scene, planes); });
	}

	// ---- for the functors: what one contact did, from any thread, after prepare() ----

	void add(Scene& scene, const contact_law::StoredEnergy<double>& stored, const contact_law::Dissipation& lost)
	{
		contact_law::eachRow(stored, lost, [&](int channel, double energy) { add(scene, channel, energy); });
	}
	void addKinetic(Scene& scene, double energy) { add(scene, 0, energy); }
	void addBoundaryWork(Scene& scene, double work) { add(scene, boundaryWork, work); }
	void addConstraintWork(Scene& scene, double work) { add(scene, constraintWork, work); }

	// ---- for an engine that has sums of its own ----

	// On what work is done in a scene, apart from a periodic cell's boundaries.
	struct WorkOn {
		bool blocked = false, outside = false; // blocked degrees of freedom or planes; outside forces
	};
	// The channels' values at present, zeros too. known: O.energy holds them already, from a checkpoint.
	void set(Scene& scene, const contact_law::Energies& energies, bool known, WorkOn there)
	{
		if (!areIn(scene)) last.fill(0); // O.energy is new, or was cleared
		findIds(scene, false);
		const auto values = contact_law::byChannel(energies);
		for (int channel = 0; channel < count; ++channel) {
			if (isWork(channel) && !isDone(channel, scene, there)) continue;
			if (perStep(channel))
				scene.energy->setItem_py(nameOf(channel), values[channel]); // a ForceResetter may have emptied it
			else
				scene.energy->add(known ? 0 : values[channel] - last[channel], nameOf(channel), ids[channel]);
			last[channel] = values[channel];
		}
	}
	// When the engine starts in a scene where others booked before: what they lost stays booked.
	void takeOver() { last.fill(0); }
	// Whether O.energy has any.
	static bool areIn(const Scene& scene) { return has(scene, nameOf(0)); }

private:
	static constexpr int count = contact_law::channelCount, boundaryWork = contact_law::channelNumber("boundaryWork"),
	                     externalWork = contact_law::channelNumber("externalWork"),
	                     constraintWork = contact_law::channelNumber("constraintWork");

	static bool has(const Scene& scene, const char* name) { return scene.energy->names.count(name) > 0; }
	static const char* nameOf(int channel) { return contact_law::channels[channel].name; }
	// Whether O.energy has a channel anew each step: energies held now are, losses and works add up. (YADE's ForceResetter is what
	// empties those.)
	static bool perStep(int channel) { return contact_law::channels[channel].kind == contact_law::ChannelKind::Stored; }
	// Channels only of scenes that have blocked degrees of freedom or planes, outside forces, or a periodic cell.
	static bool isWork(int channel) { return contact_law::channels[channel].kind == contact_law::ChannelKind::Work; }
	static bool isDone(int work, const Scene& scene, WorkOn there)
	{
		return work == boundaryWork ? scene.isPeriodic : work == externalWork ? there.outside : there.blocked;
	}

	void findIds(Scene& scene, bool planes)
	{
		for (int channel = 0; channel < count; ++channel) {
			ids[channel] = -1;
			if (isWork(channel) && !(scene.isPeriodic && channel == boundaryWork) && !(planes && channel == constraintWork))
				continue;
			scene.energy->add(0., nameOf(channel), ids[channel], perStep(channel));
		}
	}

	void add(Scene& scene, int channel, double energy)
	{
		static const std::string known; // by its id
		if (energy != 0) scene.energy->add(energy, known, ids[channel], perStep(channel));
	}

	std::array<int, count> ids {};
	std::array<double, count> last {};
	OncePerStep prepared;
};

} // namespace yade
