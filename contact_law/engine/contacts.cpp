#include "contacts.hpp"

namespace contact_law {

namespace {
	void setMaterials(const SharedState& shared, int first, int second, ContactNow& n)
	{
		n.material1 = shared.material[shared.kind[first]], n.material2 = shared.material[shared.kind[second]];
	}
}

ContactNow contactNow(const Dynamics& dynamics, const ContactList& list, int slot)
{
	const SharedState& shared = dynamics.state();
	const Contact c = shared.contactOf(list, slot);
	Image image;
	const ContactMotion m = shared.motionOf(dynamics.cell(), c.i, c.j, image);
	ContactNow n { dynamics.given(c.i), dynamics.given(c.j), c.constants, c.history,
		geometryOf(m.separation, c.constants.radius1 + c.constants.radius2), {}, m.velocity, image.shift };
	setMaterials(shared, c.i, c.j, n);
	n.forces = contactForces<AllSprings>(c.constants, n.geometry, c.history, n.velocity);
	n.forces.drag = c.drag;
	n.damping = c.damping;
	if (shared.mechanisms & SpringDamping)
		spring_damping::addForces(c.constants, n.geometry, c.history.pointers, c.damping.now, shared.pairs.springDamping, n.forces);
	n.forces.keepOnly(shared.mechanisms);
	return n;
}

ContactNow contactNow(const Dynamics& dynamics, const BondList& list, int slot)
{
	const SharedState& shared = dynamics.state();
	const Bond b = list.get(slot, shared.commonBond);
	Image image;
	const ContactMotion m = shared.motionOf(dynamics.cell(), b.i, b.j, image);
	ContactNow n { dynamics.given(b.i), dynamics.given(b.j), shared.constantsOf(b.i, b.j), b.history, geometryOf(m.separation, b.rest),
		{}, m.velocity, image.shift, true, b.constants, b.rest };
	setMaterials(shared, b.i, b.j, n);
	n.forces = bondForces(b.constants, n.geometry, b.history);
	return n;
}

namespace {
	ContactNow contactNow(const Dynamics& dynamics, const Domain& domain, const PlaneContact& contact)
	{
		ContactNow n { dynamics.given(contact.grain), contact.plane, contact.constants,
			{ { contact.n1, {} }, contact.before.twist }, domain.planes.geometryOf(contact), domain.planes.forcesOf(contact),
			contact.before.velocity, { 0, 0, 0 } };
		const SharedState& shared = dynamics.state();
		n.material1 = shared.material[shared.kind[contact.grain]], n.material2 = shared.material[shared.planes[contact.plane].kind];
		n.onPlane = true;
		n.point = contact.point;
		n.damping = contact.before.damping;
		return n;
	}

	// With its grains in the other order.
	ContactNow swapped(const ContactNow& c)
	{
		ContactNow s = c;
		s.first = c.second;
		s.second = c.first;
		s.constants.radius1 = c.constants.radius2;
		s.constants.radius2 = c.constants.radius1;
		std::swap(s.material1, s.material2);
		s.history = swapped(c.history);
		s.damping = swapped(c.damping);
		s.geometry.normal = -c.geometry.normal;
		s.forces.sliding = -c.forces.sliding;
		s.forces.slidingDisplacement = -c.forces.slidingDisplacement;
		s.velocity = -c.velocity;
		s.bond.radius1 = c.bond.radius2;
		s.bond.radius2 = c.bond.radius1;
		s.shift = -c.shift;
		return s;
	}
}

std::vector<ContactNow> contactsNow(const Dynamics& dynamics)
{
	std::vector<ContactNow> all;
	const auto add = [&](const auto& list, int slot, int first, int second) {
		const ContactNow now = contactNow(dynamics, list, slot);
		all.push_back(dynamics.id(first) < dynamics.id(second) ? now : swapped(now));
	};
	eachContact(dynamics, add);
	eachBond(dynamics, add);
	eachPlaneContact(dynamics, [&](const Domain& domain, const PlaneContact& c) { all.push_back(contactNow(dynamics, domain, c)); });
	const auto ids = [&](const ContactNow& c) {
		const int first = dynamics.id(c.first), second = c.onPlane ? dynamics.state().planes[c.second].id : dynamics.id(c.second);
		return std::pair(std::min(first, second), std::max(first, second));
	};
	std::vector<std::pair<std::pair<int, int>, std::size_t>> order;
	for (std::size_t k = 0; k < all.size(); ++k)
		order.push_back({ ids(all[k]), k });
	std::sort(order.begin(), order.end());
	std::vector<ContactNow> sorted;
	sorted.reserve(all.size());
	for (const auto& [its, k] : order)
		sorted.push_back(all[k]);
	return sorted;
}

namespace {
	void add(const ContactNow& c, NormalForces& to)
	{
		to.grains.insert(to.grains.end(), { c.first, c.second });
		to.forces.push_back(c.forces.normalForce + c.forces.drag);
		to.necks.push_back(c.bonded ? c.bond.neck : 0);
	}
}

NormalForces normalForces(const Dynamics& dynamics)
{
	NormalForces found;
	const auto visit = [&](const auto& list, int slot, int, int) { add(contactNow(dynamics, list, slot), found); };
	eachContact(dynamics, visit);
	eachBond(dynamics, visit);
	return found;
}

Vec3<double> planePosition(const Dynamics& dynamics, int plane) { return dynamics.parts()[0]->planes.positions[plane]; }

Vec3<double> pushOn(const Dynamics& dynamics, int plane)
{
	Vec3<double> push { 0, 0, 0 };
	for (const auto& domain : dynamics.parts())
		push = push + domain->planes.pushes[plane];
	return push;
}

NormalForces normalForcesOnPlanes(const Dynamics& dynamics)
{
	NormalForces found;
	eachPlaneContact(dynamics, [&](const Domain& domain, const PlaneContact& c) { add(contactNow(dynamics, domain, c), found); });
	return found;
}

int contactCount(const Dynamics& dynamics)
{
	int total = 0;
#pragma omp parallel for num_threads(dynamics.threadCount()) reduction(+ : total)
	for (std::size_t d = 0; d < dynamics.parts().size(); ++d)
		total += dynamics.parts()[d]->touching.count();
	return total;
}

int bondCount(const Dynamics& dynamics)
{
	int total = 0;
	eachBond(dynamics, [&](const BondList&, int, int, int) { ++total; });
	return total;
}

std::vector<OutsideForce> wholeForces(const Dynamics& dynamics)
{
	std::vector<OutsideForce> all(dynamics.grainCount());
	for (int k = 0; k < dynamics.grainCount(); ++k) {
		const Grain& g = dynamics.state().grains[k];
		all[dynamics.given(k)] = { dynamics.given(k), { g.fx, g.fy, g.fz }, { g.tx, g.ty, g.tz } };
	}
	for (const auto& domain : dynamics.parts())
		for (const Constrained& c : domain->constraints.grains) {
			OutsideForce& of = all[dynamics.given(c.grain)];
			of.force = of.force + c.force, of.torque = of.torque + c.torque;
		}
	return all;
}

std::vector<OutsideForce> outsideForces(const Dynamics& dynamics)
{
	std::vector<OutsideForce> all;
	for (const auto& domain : dynamics.parts())
		for (const OutsideForce& f : domain->outside.grains)
			all.push_back({ dynamics.given(f.grain), f.force, f.torque });
	std::sort(all.begin(), all.end(), [](const OutsideForce& a, const OutsideForce& b) { return a.grain < b.grain; });
	return all;
}

Booked booked(const Dynamics& dynamics)
{
	Booked all;
	all.counters = dynamics.counters();
	for (const auto& domain : dynamics.parts()) {
		all.lost += domain->ledger.lost;
		all.counts += domain->ledger.counts;
		all.boundaryWork += domain->ledger.boundaryWork();
		all.constraintWork += domain->constraints.work + domain->planes.work;
		all.externalWork += domain->outside.work;
	}
	return all;
}

} // namespace contact_law
