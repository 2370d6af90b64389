// The energy channels in O.energy, by the names that all of the project uses.
#pragma once
#include <core/EnergyTracker.hpp>
#include <core/Scene.hpp>
#include <array>
#include <atomic>

namespace yade {

class EnergyChannels {
public:
	enum Extra {
		ConstraintWork,
		BoundaryWork,
		extraCount
	}; // channels only of scenes that have blocked degrees of freedom, or a periodic cell
	enum Channel {
		Kinetic,
		Normal,
		Sliding,
		Rolling,
		Twisting,
		SlidingDissipation,
		RollingDissipation,
		TwistingDissipation,
		Connection,
		Disconnection,
		Drag,
		BondBreaking,
		count
	};

	// Whether add() books a channel anew each step: energies held now are, losses add up. (YADE's ForceResetter is what empties those.)
	static bool perStep(int channel) { return channel <= Twisting; }

	// EnergyTracker forgets its names when it is cleared, and may give them out from one thread only: to be called once a step before adding.
	void prepare(Scene& scene)
	{
		if (preparedAt == scene.iter) return;
#pragma omp critical(EnergyChannelsPrepare)
		if (preparedAt != scene.iter) {
			for (int channel = 0; channel < count; ++channel) {
				ids[channel] = -1;
				scene.energy->add(0., names()[channel], ids[channel], perStep(channel));
			}
			boundaryId = -1;
			if (scene.isPeriodic) scene.energy->add(0., extraNames()[BoundaryWork], boundaryId, false);
			preparedAt = scene.iter;
		}
	}
	/* For an engine that replaces ForceResetter, so that nobody empties channels between steps: the channels' values at present. `known`: O.energy
	 * holds them already, from a checkpoint. */
	void set(Scene& scene, const std::array<double, count>& values, bool known = false)
	{
		int kinetic = -1;
		scene.energy->findId("kinetic", kinetic, false, false);
		if (kinetic < 0) last.fill(0), lastExtra.fill(0); // O.energy is new, or was cleared
		preparedAt = -2;
		prepare(scene);
		for (int channel = 0; channel < count; ++channel)
			if (!known && values[channel] != last[channel])
				scene.energy->add(values[channel] - last[channel], "", ids[channel], perStep(channel));
		last = values;
	}
	// For an engine that starts in a scene where others booked before: what they lost stays booked, what they had stored is stored here from now on.
	void takeOver(Scene& scene)
	{
		for (int channel = 0; channel < count; ++channel) {
			int id = -1;
			if (perStep(channel)) scene.energy->findId(names()[channel], id, true, false);
			if (id >= 0) scene.energy->setItem_py(names()[channel], 0);
		}
		last.fill(0);
	}
	// Work since the start, against whatever holds grains with blocked degrees of freedom, or against a periodic cell's boundaries.
	void setExtra(Scene& scene, Extra which, double work, bool known)
	{
		int id = -1;
		if (!known && work != lastExtra[which]) scene.energy->add(work - lastExtra[which], extraNames()[which], id, false);
		lastExtra[which] = work;
	}
	void addBoundaryWork(Scene& scene, double work)
	{
		if (work != 0) scene.energy->add(work, "", boundaryId, false);
	}
	void add(Scene& scene, Channel channel, double energy)
	{
		if (energy != 0) scene.energy->add(energy, "", ids[channel], perStep(channel));
	}

private:
	static const char* const* extraNames()
	{
		static const char* const all[extraCount] = { "constraintWork", "boundaryWork" };
		return all;
	}
	static const char* const* names()
	{
		static const char* const all[count] = { "kinetic", "normal", "sliding", "rolling", "twisting", "slidingDissipation",
			"rollingDissipation", "twistingDissipation", "connection", "disconnection", "drag", "bondBreaking" };
		return all;
	}

	std::array<int, count> ids {};
	std::array<double, count> last {};
	std::array<double, extraCount> lastExtra {};
	int boundaryId = -1;
	std::atomic<long> preparedAt { -2 };
};

} // namespace yade
