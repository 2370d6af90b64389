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

/* Whether a script has torn a contact or bond apart since its owner's last step, by more than the grains' motion does in a step: none of this run's steps breaks it. It is
 * let go as it was, in no time, and booked. before, h: of the grains in the order of their indices here. */
bool Dynamics::isLetGo(
        const Inherited& from, const InheritedContact& one, int i, int j, const ContactBefore& before, ContactHistory<double> h)
{
	Image image;
	ContactMotion m = shared.motionOf(cell(), i, j, image), throughStep = m;
	m.dt = 0, throughStep.dt = from.step;
	const PairConstants<double> c = shared.constantsOf(i, j);
	Dissipation lost;
	Counts counts;
	counts.events = 1;
	if (one.bonded) {
		const BondConstants<double> b = shared.bondOf(i, j, one.neck);
		const ContactGeometry<double> g = geometryOf(m.separation, one.rest);
		if (from.stepBehind && !bonds::isTorn(b, throughStep, before, g, bondForces(b, g, h))) return false;
		const BondStepResult r = bondStepWith[shared.mechanisms](b, c, m, before, one.rest, h);
		if (r.bonded) return false;
		lost = r.contact.dissipated;
		++counts.brokenBonds[r.mode];
	} else {
		const double opening = before.overlap - geometryOf(m.separation, c.radius1 + c.radius2).overlap;
		if (from.stepBehind && !events::isTorn(throughStep, opening)) return false;
		const ContactStepResult r = contactStepWith[shared.mechanisms](c, shared.limit, m, before, h);
		if (r.touching) return false;
		lost = r.dissipated;
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
		ContactBefore before = one.before;
		if (a > b) before.sliding = -before.sliding;
		if (isLetGo(inherited, one, i, j, before, history)) continue;
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
