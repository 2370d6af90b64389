// The energy channels in O.energy (kernel/energy_channels.hpp).
#pragma once
#include "../kernel/energy_channels.hpp"
#include "SceneShapes.hpp"
#include <array>

namespace yade {

class EnergyChannels {
public:
	// EnergyTracker loses its names when it is cleared, and may give them out from one thread only: to be called once a step before
	// adding.
	void prepare(Scene& scene)
	{
		prepared(scene, [&] { findIds(scene); });
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

	// The channels' values at present, zeros too. known: O.energy holds them already, from a checkpoint.
	void set(Scene& scene, const contact_law::Energies& energies, bool known)
	{
		if (!areIn(scene)) last.fill(0); // O.energy is new, or was cleared
		findIds(scene);
		const auto values = contact_law::byChannel(energies);
		for (int channel = 0; channel < count; ++channel) {
			if (perStep(channel))
				scene.energy->setItem_py(nameOf(channel), values[channel]); // a ForceResetter may have emptied it
			else
				scene.energy->add(known ? 0 : values[channel] - last[channel], nameOf(channel), ids[channel]);
			last[channel] = values[channel];
		}
	}
	// When the engine starts in a scene where others booked before: what they lost stays booked.
	void takeOver() { last.fill(0); }
	static bool areIn(const Scene& scene) { return scene.energy->names.count(nameOf(0)) > 0; }

private:
	static constexpr int count = contact_law::channelCount;

	static const char* nameOf(int channel) { return contact_law::channels[channel].name; }
	// Whether O.energy has a channel anew each step: energies held now are, losses and works add up. (YADE's ForceResetter is what
	// empties those.)
	static bool perStep(int channel) { return contact_law::channels[channel].kind == contact_law::ChannelKind::Stored; }

	void findIds(Scene& scene)
	{
		for (int channel = 0; channel < count; ++channel) {
			ids[channel] = -1;
			scene.energy->add(0., nameOf(channel), ids[channel], perStep(channel));
		}
	}

	std::array<int, count> ids {};
	std::array<double, count> last {};
	OncePerStep prepared;
};

} // namespace yade
