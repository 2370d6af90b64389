#include "exchange.hpp"
#include <set>

namespace contact_law {

std::vector<double> Inherited::necks() const
{
	std::set<double> found;
	for (const InheritedContact& one : contacts)
		if (one.bonded) found.insert(one.neck);
	return { found.begin(), found.end() };
}

/* Whether a script has torn a contact or bond apart since its owner's last step, by more than the grains' motion does in a step: no step will break it. It is let go as
 * it was, and booked. h: of the grains in the order of their indices here. */
bool Dynamics::isLetGo(const Inherited& from, const InheritedContact& one, int i, int j, const ContactHistory<double>& h)
{
	Image image;
	const ContactMotion m = shared.motionOf(cell(), i, j, image);
	const PairConstants<double> c = shared.constantsOf(i, j);
	const auto byMotion = [&](const Vec3<double>& change, double turning) {
		const auto length = [](const Vec3<double>& v) { return std::sqrt(dot(v, v)); };
		const double most = 2 * from.step * (length(m.velocity) + turning * (length(m.spin1) + length(m.spin2)));
		return from.stepBehind && dot(change, change) <= most * most;
	};
	Dissipation lost;
	Counts counts;
	counts.events = 1;
	if (one.bonded) {
		const BondConstants<double> b = shared.bondOf(i, j, one.neck);
		const ContactGeometry<double> g = geometryOf(m.separation, one.rest);
		const ContactForces<double> f = bondForces(b, g, h);
		const int mode = bonds::firstBreaking(b, one.before, g, f, h.twist).mode;
		const Vec3<double> change = f.slidingDisplacement - (i == indexHere[one.first] ? one.before.sliding : -one.before.sliding)
		        + (g.overlap - one.before.overlap) * g.normal;
		if (mode < 0 || byMotion(change, b.radius1 + b.radius2)) return false;
		const ContactGeometry<double> shrunk = geometryOf(m.separation, c.radius1 + c.radius2); // they touch, where it is above 0
		const double ofContact = shrunk.overlap > 0
		        ? normal::energy(c, normal::rootOfContactRadius(shrunk.overlap * c.inverseEquilibriumOverlap))
		        : 0;
		lost.*bondBreakingBy[mode] = bonds::held(b, one.before) - ofContact;
		++counts.brokenBonds[mode];
	} else {
		const ContactGeometry<double> g = geometryOf(m.separation, c.radius1 + c.radius2);
		if (!normal::beyondPullOff(c, g) || byMotion((g.overlap - one.before.overlap) * g.normal, 0)) return false;
		lost.disconnection = contact_law::letGo(shared.mechanisms, c, one.before);
		++counts.broken;
	}
	domains[0]->ledger.add(lost, counts, 0);
	return true;
}

void Dynamics::inherit(const Inherited& inherited)
{
	const auto velocityBefore = [&](int i, int j) -> Vec3<double> {
		if (!inherited.stepBehind || !shared.hasDrag()) return { 0, 0, 0 }; // firstForces() sets it
		Vec3<double> separation = separationOf(shared.grains[i], shared.grains[j]);
		const Image image = nearestImage(cell(), separation);
		return inherited.previous[original[i]] - inherited.previous[original[j]] + image.velocity;
	};
	for (const InheritedContact& one : inherited.contacts) {
		const int a = indexHere[one.first], b = indexHere[one.second], i = std::min(a, b), j = std::max(a, b);
		const ContactHistory<double> history = a < b ? one.history : swapped(one.history);
		if (isLetGo(inherited, one, i, j, history)) continue;
		for (auto& domain : domains)
			one.bonded ? domain->touching.place(Bond { i, j, history, one.rest, shared.bondOf(i, j, one.neck) })
			           : domain->touching.place(Contact { i, j, history, shared.constantsOf(i, j), one.before.drag,
			                   one.before.overlap, velocityBefore(i, j) });
	}
	for (const Inherited::OnPlane& one : inherited.onPlanes) {
		PlaneContact contact = one.contact;
		contact.grain = indexHere[one.grain], contact.plane = one.plane;
		contact.constants = shared.constantsOnPlane(contact.grain, contact.plane);
		for (auto& domain : domains)
			inherited.stepBehind ? domain->planes.inherit(contact, one.force) : domain->planes.place(contact);
	}
	for (auto& domain : domains)
		domain->touching.sort();
	makeLists();
	if (inherited.stepBehind) {
		completeInheritedStep();
		return;
	}
	for (auto& domain : domains)
		domain->touching.placeOverlapping(domain->lists, cell());
	firstForces();
}

/* The end of the step whose beginning another owner of the contacts has made: events since the histories' moment are found as in any other step.
 * Two works over this one step need forces at its beginning, which are not handed over. The boundaries' work is (V_n + V_{n+1})/2 . (L_{n+1} - L_n) (MODEL.md) with
 * V_n taken to be V_{n+1}, so what complete() has booked, the half of V_{n+1}, counts twice: an error of second order in the step, of first order for contacts
 * that formed or broke in it. The work on blocked degrees of freedom is left out: of first order, one step's work. */
void Dynamics::completeInheritedStep()
{
	addForces();
	for (auto& domain : domains) {
		domain->ledger.doubleBoundaryWork();
		domain->constraints.work = 0;
	}
}

void Dynamics::continueFrom(const Booked& before)
{
	Domain& one = *domains[0];
	one.ledger.add(before.lost, before.counts, before.boundaryWork);
	one.constraints.work += before.constraintWork;
	one.outside.work += before.externalWork;
	countedBefore = before.counters;
}

void readAhead(const Dynamics& dynamics, std::vector<GrainMotion>& grains)
{
	dynamics.read(grains);
	const SharedState& shared = dynamics.state();
	const double dt = shared.dt;
	for (int k = 0; k < dynamics.grainCount(); ++k) {
		Grain p = shared.grains[k];
		kick(shared, p, k, dt);
		p.x += dt * p.vx, p.y += dt * p.vy, p.z += dt * p.vz;
		GrainMotion& g = grains[dynamics.given(k)];
		copyMotion(p, g);
		g.orientation = turnedBy(dt * p.wx, dt * p.wy, dt * p.wz, g.orientation);
	}
}

} // namespace contact_law
