/* What a domain has booked since the start: energies that its contacts took out of the motion, and how often what happened (MODEL.md,
 * "The integrator and the ledger"). Only contacts that are counted here are booked (Ownership). */
#pragma once
#include "shared_state.hpp"

namespace contact_law {

// A grain's kick by events of the latest step: what belongs before this instant beyond the half.
struct EarlyKick {
	int grain;
	Vec3<double> force, torque;
};

struct Counts {
	long events = 0;                                // contacts that formed, broke, and slips
	long formed = 0, broken = 0;                    // contacts, bonds not among them
	std::array<long, bondModeCount> brokenBonds {}; // by mode

	Counts& operator+=(const Counts& c)
	{
		events += c.events, formed += c.formed, broken += c.broken;
		for (int mode = 0; mode < bondModeCount; ++mode)
			brokenBonds[mode] += c.brokenBonds[mode];
		return *this;
	}
};

class Ledger {
public:
	explicit Ledger(const PeriodicCell& cell_)
	        : cell(cell_)
	{
	}

	// ---- a step ----

	void beginStep(double dt)
	{
		eventWork = 0;
		early.clear();
		if (cell.on) boundary.arrive(cell, dt);
	}
	// All contacts' forces of this instant are known.
	void completeStep(double dt)
	{
		if (cell.on) boundary.complete(cell, dt);
	}
	// What a pass over contacts adds to.
	struct PassSums {
		Dissipation* dissipated;
		long* slips;
		Vec3<double>* crossing; // sum of shift times force
	};
	PassSums sumsFor(Ownership o)
	{
		if (!isCounted(o)) return { &ignored.dissipated, &ignored.slips, &ignored.crossing };
		return { &lost, &counts.events, &boundary.kicks };
	}
	// An event.
	void book(const ContactStepResult& r, const ContactMotion& m, const Image& image, Ownership o)
	{
		if (!isCounted(o)) return;
		lost += r.dissipated;
		eventWork += r.workBefore - 0.5 * events::work(m, r.force, r.torque1, r.torque2);
		if (cell.on) boundary.addEarly(image.shift, r.force, r.forceBefore);
		counts.events += r.isEvent(); // not of a contact that is pressed hard
	}
	// A step of an own grain on a plane.
	void bookOnPlane(int index, const Grain& grain, const ContactStepResult& r, double dt)
	{
		lost += r.dissipated;
		const EarlyKick kick { index, r.forceBefore - 0.5 * r.force, r.torqueBefore1 - 0.5 * r.torque1 };
		eventWork += dt * (dot(kick.force, velocityOf(grain)) + dot(kick.torque, spinOf(grain)));
		early.push_back(kick);
	}
	// A contact's kick that no pass adds.
	void addCrossing(const Image& image, const Vec3<double>& kick)
	{
		if (cell.on) boundary.add(image.shift, kick);
	}

	// ---- between steps ----

	void renumber(const std::vector<int>& to) // new indices of grains
	{
		for (EarlyKick& kick : early)
			kick.grain = to[kick.grain];
	}
	// Steps are of another length from now on, and velocities those of half such a step ago.
	void changeStep(const Aligned<Grain>& grains, double dt)
	{
		eventWork = 0;
		for (const EarlyKick& kick : early) {
			const Grain& g = grains[kick.grain];
			eventWork += dt * (dot(kick.force, velocityOf(g)) + dot(kick.torque, spinOf(g)));
		}
	}

	// ---- so far [J] ----

	Dissipation lost;
	double eventWork = 0;  // what events of the latest step add to the kinetic energy now beyond half the kicks' work
	BoundaryWork boundary; // of a periodic cell
	double meanField = 0;  // taken out of the kinetic energy by changes of the velocity gradient and by the convective acceleration
	std::vector<EarlyKick> early; // of own grains
	double boundaryWork() const { return boundary.done + meanField; }

	Counts counts;
	bool tooDeep = false; // whether grains, or a grain and a plane, overlapped by more than the smaller radius in an event

private:
	const PeriodicCell& cell;
	struct {
		Dissipation dissipated;
		long slips = 0;
		Vec3<double> crossing { 0, 0, 0 };
	} ignored; // of border contacts that the other domain books
};

} // namespace contact_law
