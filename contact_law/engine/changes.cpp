/* What changes a run between two steps. Motions, planes, outside forces, the cell's velocity gradient and the step are taken as they
 * come, in second order of the step; every other change is another run of the scene, which inherits the contacts. */
#include "contacts.hpp"
#include <algorithm>

namespace contact_law {

void copyMotion(const GrainMotion& g, Grain& grain)
{
	grain.x = g.position.x, grain.y = g.position.y, grain.z = g.position.z;
	grain.vx = g.velocity.x, grain.vy = g.velocity.y, grain.vz = g.velocity.z;
	grain.wx = g.angularVelocity.x, grain.wy = g.angularVelocity.y, grain.wz = g.angularVelocity.z;
}

void copyMotion(const Grain& grain, GrainMotion& g)
{
	g.position = positionOf(grain), g.velocity = velocityOf(grain), g.angularVelocity = spinOf(grain);
}

void kick(const SharedState& shared, Grain& p, int k, double time)
{
	const double m = time * shared.inverseMass[k], i = time * shared.inverseInertia[k];
	const Vec3<double>& c = shared.convective; // grows with the velocity before the kick
	if (time > 0) p.vx *= 1 + time * c.x, p.vy *= 1 + time * c.y, p.vz *= 1 + time * c.z;
	p.vx += m * p.fx, p.vy += m * p.fy, p.vz += m * p.fz;
	p.wx += i * p.tx, p.wy += i * p.ty, p.wz += i * p.tz;
	if (time < 0) p.vx /= 1 - time * c.x, p.vy /= 1 - time * c.y, p.vz /= 1 - time * c.z;
}

void Dynamics::kickAll(double time)
{
	for (int k = 0; k < count; ++k)
		kick(shared, shared.grains[k], k, time);
}

void kickEarly(const SharedState& shared, const EarlyKick& early, Grain& g, double time)
{
	const unsigned blocked = shared.blocked[early.grain];
	const double m = time * shared.inverseMass[early.grain], i = time * shared.inverseInertia[early.grain];
	const Vec3<double> push = m * (early.force - blockedForce(early.force, blocked));
	const Vec3<double> turn = i * (early.torque - blockedTorque(early.torque, blocked));
	g.vx += push.x, g.vy += push.y, g.vz += push.z;
	g.wx += turn.x, g.wy += turn.y, g.wz += turn.z;
}

void Dynamics::kickEarly(double time)
{
	for (auto& domain : domains)
		for (const EarlyKick& early : domain->ledger.early)
			contact_law::kickEarly(shared, early, shared.grains[early.grain], time);
}

// ---- taken as they come ----

void Dynamics::set(int index, const GrainMotion& now)
{
	const int k = indexHere[index];
	Grain& p = shared.grains[k];
	if (now.blocked != shared.blocked[k]) {
		domainOf(k).constraints.block(shared.grains.data(), k, now.blocked);
		shared.blocked[k] = now.blocked;
	}
	if (options.orientations) shared.orientation[k] = now.orientation;
	const Vec3<double> from = positionOf(p);
	copyMotion(now, p);
	shared.displace(k, positionOf(p) - from);
	kick(shared, p, k, -0.5 * shared.dt);
	for (const EarlyKick& early : domainOf(k).ledger.early)
		if (early.grain == k) contact_law::kickEarly(shared, early, p, -shared.dt);
	velocitiesSet = true;
	outdateLists();
}

void Dynamics::setPlane(int plane, const Vec3<double>& position, const Vec3<double>& velocity)
{
	shared.planes[plane].velocity = velocity;
	for (auto& domain : domains)
		domain->planes.moved(plane, position);
}

void Dynamics::setOutsideForces(const std::vector<OutsideForce>& given_, Onset onset)
{
	std::vector<OutsideForce> all = given_;
	for (OutsideForce& f : all)
		f.grain = indexHere[f.grain];
	for (auto& domain : domains) {
		const std::vector<OutsideForce> before = std::move(domain->outside.grains);
		domain->outside.grains.clear();
		domain->place(all);
		for (const OutsideForce& f : before)
			changeForce(*domain, f.grain, -f.force, -f.torque, onset);
		for (const OutsideForce& f : domain->outside.grains)
			changeForce(*domain, f.grain, f.force, f.torque, onset);
	}
}

// What the kinetic energy of this moment, which a leapfrog counts with half a kick, changes by is work of the force.
void Dynamics::changeForce(Domain& domain, int k, Vec3<double> force, Vec3<double> torque, Onset onset)
{
	Grain& p = shared.grains[k];
	const double before = domain.kineticEnergyOf(k);
	kick(shared, p, k, 0.5 * shared.dt);
	domain.constraints.push(k, force, torque);
	addToGrain(p, force, torque);
	kick(shared, p, k, -0.5 * shared.dt);
	if (onset == Onset::Now) domain.outside.work += before - domain.kineticEnergyOf(k);
}

void Dynamics::setMeanField(const Vec3<double>& added, const Vec3<double>& convective)
{
	if (added == Vec3<double> { 0, 0, 0 } && convective == shared.convective) return;
	for (auto& domain : domains)
		domain->ledger.meanField += domain->kineticEnergy();
	kickAll(0.5 * shared.dt);
	for (int k = 0; k < count; ++k) {
		Grain& p = shared.grains[k];
		p.vx += added.x * p.x, p.vy += added.y * p.y, p.vz += added.z * p.z;
	}
	shared.convective = convective;
	velocitiesSet = true;
	outdateLists();
	kickAll(-0.5 * shared.dt);
	for (auto& domain : domains) {
		domain->ledger.meanField -= domain->kineticEnergy();
		domain->cell.rate = domain->cell.rate
		        + Images<double>::times(added, domain->cell.size); // the images' velocities change with the grains'
	}
}

/* The part of this moment's kicks that belongs before it was meant for the step that has been, the rest for the one to come (MODEL.md,
 * "Steps of changing length"): velocities, which are those of half a step ago, move on to half a new step ago. Lists count in steps,
 * and are checked anew. */
void Dynamics::setStep(double dt)
{
	const double before = shared.dt;
	if (dt == before) return;
	kickEarly(before - dt);
	kickAll(0.5 * before);
	kickAll(-0.5 * dt);
	shared.dt = dt;
	shared.setLeastKick();
	for (auto& domain : domains)
		domain->ledger.changeStep(shared.grains, dt);
	velocitiesSet = true;
	outdateLists();
}

// ---- another run of the scene ----

// What a script has torn apart since is let go, as where it is moved alone: contacts beyond pull-off, and bonds that would break at once.
void Dynamics::inherit(const Inherited& inherited)
{
	double owed = 0;
	for (const Inherited::Pair& one : inherited.contacts)
		owed += place(one) ? one.energy.held : one.energy.letGo;
	for (const Inherited::OnPlane& one : inherited.onPlanes) {
		PlaneContact c = one.contact;
		c.grain = indexHere[c.grain];
		c.constants = shared.constantsOnPlane(c.grain, c.plane);
		const bool holds = !normal::beyondPullOff(c.constants, domains[0]->planes.geometryOf(c));
		owed += holds ? one.energy.held : one.energy.letGo;
		for (auto& domain : domains)
			if (holds) domain->planes.place(c);
	}
	for (auto& domain : domains)
		domain->touching.sort();
	makeLists();
	for (auto& domain : domains)
		domain->touching.placeOverlapping(domain->lists, cell());
	firstForces();
	const Energies now = energies();
	bookDisconnection(owed - total(now.stored) - total(now.dissipated));
}

// Returns whether it holds.
bool Dynamics::place(const Inherited::Pair& one)
{
	const int a = indexHere[one.first], b = indexHere[one.second], i = std::min(a, b), j = std::max(a, b);
	const Vec3<double> separation = shared.separationOf(cell(), i, j);
	ContactHistory<double> history = a < b ? one.history : swapped(one.history);
	if (one.neck > 0) {
		const BondConstants<double> c = shared.bondOf(i, j, one.neck);
		const double rest = one.rest > 0 ? one.rest : newBond(separation, history);
		const ContactGeometry<double> g = geometryOf(separation, rest);
		if (bondBreaks(c, bondEnergy(c, g, bondForces(c, g, history), history.twist))) return false;
		for (auto& domain : domains)
			domain->touching.place(Bond { i, j, history, rest, c });
	} else {
		const PairConstants<double> c = shared.constantsOf(i, j);
		if (normal::beyondPullOff(c, geometryOf(separation, c.radius1 + c.radius2))) return false;
		for (auto& domain : domains)
			domain->touching.place(Contact { i, j, history, c, one.drag, one.overlap });
	}
	return true;
}

void Dynamics::continueFrom(const Booked& before)
{
	Domain& one = *domains[0];
	one.ledger.lost += before.lost;
	one.ledger.counts += before.counts;
	one.ledger.boundary.done += before.boundaryWork;
	one.constraints.work += before.constraintWork;
	one.outside.work += before.externalWork;
	countedBefore = before.counters;
}

} // namespace contact_law
