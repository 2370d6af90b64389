// The contacts and sintered bonds of a run as they are now, and how many there are. Grains by their indices as given.
#pragma once
#include "dynamics.hpp"

namespace contact_law {

// One contact or bond.
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
};
// The same with its grains in the other order.
ContactNow swapped(const ContactNow&);
ContactHistory<double> swapped(const ContactHistory<double>&);
ContactNow contactNow(const Dynamics&, const ContactList&, int lane);
ContactNow contactNow(const Dynamics&, const BondList&, int lane);
double normalForceNow(const Dynamics&, const ContactList&, int lane); // elastic and viscous, positive when repulsive [N]
double normalForceNow(const Dynamics&, const BondList&, int lane);    // elastic [N]

template <class Lists, class Visit> void eachLaneOf(const Dynamics& dynamics, const Domain& domain, Lists Domain::*lists, Visit&& visit)
{
	for (int sort = 0; sort < 2; ++sort) { // a border contact where its first grain lives
		const auto& list = (domain.*lists)[sort];
		for (int lane = 0; lane < list.size(); ++lane)
			if (list.alive(lane)) visit(list, lane, dynamics.given(list.first(lane)), dynamics.given(list.second(lane)));
	}
}
template <class Lists, class Visit> void eachLane(const Dynamics& dynamics, Lists Domain::*lists, Visit&& visit)
{
	for (const auto& domain : dynamics.parts())
		eachLaneOf(dynamics, *domain, lists, visit);
}
// Of every contact (but bonds) once: visit(list, lane, its first and its second grain).
template <class Visit> void eachContactLane(const Dynamics& dynamics, Visit&& visit) { eachLane(dynamics, &Domain::contacts, visit); }
template <class Visit> void eachBondLane(const Dynamics& dynamics, Visit&& visit) { eachLane(dynamics, &Domain::bonds, visit); }

// Contacts and bonds of one domain: grains (first and second of each), normal forces [N], necks over the grains' radius (0: no bond).
struct NormalForces {
	std::vector<int> grains;
	std::vector<double> forces, necks;
};
// The contacts of each domain, then the bonds of each; by all threads.
std::vector<NormalForces> normalForces(const Dynamics&);

int contactCount(const Dynamics&); // bonds among them
int bondCount(const Dynamics&);
bool constrained(const Dynamics&);                        // whether any grain has a blocked degree of freedom
std::vector<OutsideForce> outsideForces(const Dynamics&); // by rising index of the grain as given

// Since the start:
std::array<long, bondModes> brokenBonds(const Dynamics&); // by mode
Dissipation dissipated(const Dynamics&);                  // [J]
struct Counts {
	long events = 0;             // contacts that formed, broke, and slips
	long formed = 0, broken = 0; // contacts, bonds not among them
};
Counts counts(const Dynamics&);

} // namespace contact_law
