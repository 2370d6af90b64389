// What is read from a run: its contacts and sintered bonds as they are now, sums, how long its step may be, why it broke down. Grains by
// their indices as given.
#pragma once
#include "dynamics.hpp"

namespace contact_law {

// What a run has booked since its start [J] and counted.
struct Booked {
	Dissipation lost;
	Counts counts;
	Dynamics::Counters counters;
	double boundaryWork = 0, constraintWork = 0, externalWork = 0;
};

// One contact or bond, or (onPlane) the contact of a grain, the first, and a plane, the second.
struct ContactNow {
	int first, second;
	PairConstants<double> constants;
	ContactHistory<double> history; // laboratory frame
	ContactGeometry<double> geometry;
	ContactForces<double> forces;
	Vec3<double> velocity; // of the first past the second through the last small step
	Vec3<double> shift;    // cells by which the first is shifted to be nearest to the second (periodic)
	bool bonded = false;
	BondConstants<double> bond {}; // when it is; the geometry's overlap is then rest - distance
	double rest = 0;
	Material material1 {}, material2 {};
	bool onPlane = false;
	DampingMoment<double> damping {};
	Vec3<double> point { 0, 0, 0 }; // when it is, of the plane that belongs to the grain's pointer, from the plane's position [m]
};
ContactNow contactNow(const Dynamics&, const ContactList&, int slot);
ContactNow contactNow(const Dynamics&, const BondList&, int slot);

template <class Lists, class Visit>
void eachSlotOf(const Dynamics& dynamics, const Domain& domain, Lists TouchingPairs::*lists, Visit&& visit)
{
	for (const Ownership o : counted) {
		const auto& list = (domain.touching.*lists)[o];
		for (int slot = 0; slot < list.size(); ++slot)
			if (list.isUsed(slot)) visit(list, slot, dynamics.given(list.first(slot)), dynamics.given(list.second(slot)));
	}
}
template <class Lists, class Visit> void eachOf(const Dynamics& dynamics, Lists TouchingPairs::*lists, Visit&& visit)
{
	for (const auto& domain : dynamics.parts())
		eachSlotOf(dynamics, *domain, lists, visit);
}
// Of every contact (but bonds) once: visit(list, slot, its first and its second grain).
template <class Visit> void eachContact(const Dynamics& dynamics, Visit&& visit) { eachOf(dynamics, &TouchingPairs::contacts, visit); }
template <class Visit> void eachBond(const Dynamics& dynamics, Visit&& visit) { eachOf(dynamics, &TouchingPairs::bonds, visit); }

// All of them by rising ids of what touches, the lower one of two grains first.
std::vector<ContactNow> contactsNow(const Dynamics&);

// Contacts: grains (first and second of each), normal forces [N], necks over the grains' radius (0: no bond).
struct NormalForces {
	std::vector<int> grains;
	std::vector<double> forces, necks;
};
NormalForces normalForces(const Dynamics&); // the contacts, then the bonds
NormalForces normalForcesOnPlanes(const Dynamics&);

// visit(domain, contact), of every grain's with a plane
template <class Visit> void eachPlaneContact(const Dynamics& dynamics, Visit&& visit)
{
	for (const auto& domain : dynamics.parts())
		for (const PlaneContact& contact : domain->planes.contacts)
			visit(*domain, contact);
}
Vec3<double> planePosition(const Dynamics&, int plane); // [m]
Vec3<double> pushOn(const Dynamics&, int plane);        // by all grains, through the latest step [N]

int contactCount(const Dynamics&); // between grains, bonds among them
int bondCount(const Dynamics&);
// On each grain as given: of contacts, bonds and outside forces, with what blocked degrees of freedom withhold.
std::vector<OutsideForce> wholeForces(const Dynamics&);
std::vector<OutsideForce> outsideForces(const Dynamics&); // by rising index of the grain as given

Booked booked(const Dynamics&);

// ---- how long a run's small step may be, and why a run broke down: which grain, which contact (soundness.cpp) ----

// Steps from here on are unstable for some pair that the scene's kinds of grains could make, with or without bonds, in whatever packing
// [s] (MODEL.md, "Step limits").
double unstableStep(const Dynamics&);
double unstableStepOfBonds(const Dynamics&, double neck);
// The largest gap between grains that touch, or are bonded [m]: the neighbour lists must hold them so far apart, however small other
// grains are.
double mostStretched(const Dynamics&);

// Grains and planes as their owner calls them; -1: none.
struct Fastest {
	int id = -1;
	double speed = 0; // [m/s]
};
Fastest fastestGrain(const Dynamics&);
struct Overlap {
	int first = -1, second = -1;
	double overlap = -1e300; // over the smaller radius; beyond 1 no law holds
};
// The deepest contact of a grain, or of all (id -1), where the grains were a time `ago` [s].
Overlap deepestOverlap(const Dynamics&, double ago = 0, int id = -1);

} // namespace contact_law
