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
double normalForceNow(const Dynamics&, const Contact&); // elastic and viscous, positive when repulsive [N]
double normalForceNow(const Dynamics&, const Bond&);    // elastic [N]

template <class Lists, class Visit> void eachLane(const Dynamics& dynamics, Lists Domain::*lists, Visit&& visit)
{
	for (const auto& domain : dynamics.parts())
		for (int sort = 0; sort < 2; ++sort) { // a border contact where its first grain lives
			const auto& list = (*domain.*lists)[sort];
			for (int lane = 0; lane < list.size(); ++lane)
				if (list.alive(lane))
					visit(list, lane, dynamics.given(list.first(lane)), dynamics.given(list.second(lane)));
		}
}
// Of every contact (but bonds) once: visit(list, lane, its first and its second grain).
template <class Visit> void eachContactLane(const Dynamics& dynamics, Visit&& visit) { eachLane(dynamics, &Domain::contacts, visit); }
template <class Visit> void eachBondLane(const Dynamics& dynamics, Visit&& visit) { eachLane(dynamics, &Domain::bonds, visit); }

// visit(Contact, its first and second grain, normal force now)
template <class Visit> void eachContact(const Dynamics& dynamics, Visit&& visit)
{
	eachContactLane(dynamics, [&](const ContactList& list, int lane, int first, int second) {
		const Contact c = dynamics.state().contactOf(list, lane);
		visit(c, first, second, normalForceNow(dynamics, c));
	});
}
// visit(Bond, likewise)
template <class Visit> void eachBond(const Dynamics& dynamics, Visit&& visit)
{
	eachBondLane(dynamics, [&](const BondList& list, int lane, int first, int second) {
		const Bond b = list.get(lane, dynamics.state().commonBond);
		visit(b, first, second, normalForceNow(dynamics, b));
	});
}

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
