// The energy channels in O.energy (kernel/energy_channels.hpp).
#pragma once
#include "../kernel/energy_channels.hpp"
#include "SceneShapes.hpp"
#include <array>
#include <cstring>

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

	void add(Scene& scene, const contact_law::Energies& energies)
	{
		static const std::string known; // by its id
		const auto values = contact_law::byChannel(energies);
		for (int channel = 0; channel < count; ++channel)
			if (values[channel] != 0) scene.energy->add(values[channel], known, ids[channel], perStep(channel));
	}

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
			const bool done = is(channel, "boundaryWork") ? scene.isPeriodic
			        : is(channel, "externalWork")         ? there.outside
			                                              : there.blocked;
			if (isWork(channel) && !done) continue;
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
	static bool areIn(const Scene& scene) { return scene.energy->names.count(nameOf(0)) > 0; }

private:
	static constexpr int count = contact_law::channelCount;

	static const char* nameOf(int channel) { return contact_law::channels[channel].name; }
	static bool is(int channel, const char* name) { return std::strcmp(nameOf(channel), name) == 0; }
	// Whether O.energy has a channel anew each step: energies held now are, losses and works add up. (YADE's ForceResetter is what
	// empties those.)
	static bool perStep(int channel) { return contact_law::channels[channel].kind == contact_law::ChannelKind::Stored; }
	// Channels only of scenes that have blocked degrees of freedom or planes, outside forces, or a periodic cell.
	static bool isWork(int channel) { return contact_law::channels[channel].kind == contact_law::ChannelKind::Work; }

	void findIds(Scene& scene, bool planes)
	{
		for (int channel = 0; channel < count; ++channel) {
			ids[channel] = -1;
			if (isWork(channel) && !(scene.isPeriodic && is(channel, "boundaryWork"))
			        && !(planes && is(channel, "constraintWork")))
				continue;
			scene.energy->add(0., nameOf(channel), ids[channel], perStep(channel));
		}
	}

	std::array<int, count> ids {};
	std::array<double, count> last {};
	OncePerStep prepared;
};

} // namespace yade
