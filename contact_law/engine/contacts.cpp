#include "contacts.hpp"

namespace contact_law {

ContactHistory<double> swapped(const ContactHistory<double>& h)
{
	return { { h.pointers.n2, h.pointers.n1 }, h.twist }; // spin and normal both change sign
}

ContactNow swapped(const ContactNow& c)
{
	ContactNow s = c;
	s.first = c.second;
	s.second = c.first;
	s.constants.radius1 = c.constants.radius2;
	s.constants.radius2 = c.constants.radius1;
	s.history = swapped(c.history);
	s.geometry.normal = -c.geometry.normal;
	s.forces.sliding = -c.forces.sliding;
	s.forces.slidingDisplacement = -c.forces.slidingDisplacement;
	s.forces.torque1 = c.forces.torque2;
	s.forces.torque2 = c.forces.torque1;
	s.velocity = -c.velocity;
	s.bond.radius1 = c.bond.radius2;
	s.bond.radius2 = c.bond.radius1;
	s.shift = -c.shift;
	return s;
}

ContactNow contactNow(const Dynamics& dynamics, const ContactList& list, int lane)
{
	const Setting& setting = dynamics.state();
	const Contact c = setting.contactOf(list, lane);
	const Grain &a = setting.grains[c.i], &b = setting.grains[c.j];
	Vec3<double> separation = separationOf(a, b);
	const Image image = nearestImage(dynamics.cell(), separation);
	ContactNow n { dynamics.given(c.i), dynamics.given(c.j), c.constants, c.history,
		geometryOf(separation, c.constants.radius1 + c.constants.radius2), {}, velocityOf(a) - velocityOf(b) + image.velocity,
		image.shift };
	n.forces = contactForces<AllSprings>(c.constants, n.geometry, c.history, n.velocity);
	n.forces.drag = c.drag;
	if (!(setting.mechanisms & Sliding)) n.forces.sliding = { 0, 0, 0 };
	return n;
}

ContactNow contactNow(const Dynamics& dynamics, const BondList& list, int lane)
{
	const Setting& setting = dynamics.state();
	const Bond b = list.get(lane, setting.commonBond);
	const Grain &one = setting.grains[b.i], &two = setting.grains[b.j];
	Vec3<double> separation = separationOf(one, two);
	const Image image = nearestImage(dynamics.cell(), separation);
	ContactNow n { dynamics.given(b.i), dynamics.given(b.j), setting.constantsOf(b.i, b.j), b.history, geometryOf(separation, b.rest),
		{}, velocityOf(one) - velocityOf(two) + image.velocity, image.shift, true, b.constants, b.rest };
	n.forces = bondForces(b.constants, n.geometry, b.history);
	return n;
}

double normalForceNow(const Dynamics& dynamics, const ContactList& list, int lane)
{
	const Setting& setting = dynamics.state();
	const int i = list.first(lane), j = list.second(lane);
	const PairConstants<double> c = setting.constantsOf(i, j);
	Vec3<double> separation = separationOf(setting.grains[i], setting.grains[j]);
	nearestImage(dynamics.cell(), separation);
	ContactForces<double> f {};
	normal::addForces(c, geometryOf(separation, c.radius1 + c.radius2), f);
	return setting.hasDrag() ? f.normalForce + list.drag(lane) : f.normalForce;
}

double normalForceNow(const Dynamics& dynamics, const BondList& list, int lane)
{
	const Bond b = list.get(lane, dynamics.state().commonBond);
	Vec3<double> separation = separationOf(dynamics.state().grains[b.i], dynamics.state().grains[b.j]);
	nearestImage(dynamics.cell(), separation);
	const auto g = geometryOf(separation, b.rest);
	return bondForces(b.constants, g, b.history).normalForce;
}

namespace {
	double neckOf(const ContactList&, int, const Setting&) { return 0; }
	double neckOf(const BondList& list, int lane, const Setting& setting) { return list.get(lane, setting.commonBond).constants.neck; }

	template <class Lists> NormalForces normalForcesOf(const Dynamics& dynamics, const Domain& domain, Lists Domain::*lists)
	{
		NormalForces found;
		const std::size_t most = (domain.*lists)[0].size() + (domain.*lists)[1].size();
		found.grains.reserve(2 * most), found.forces.reserve(most), found.necks.reserve(most);
		eachLaneOf(dynamics, domain, lists, [&](const auto& list, int lane, int first, int second) {
			found.grains.push_back(first);
			found.grains.push_back(second);
			found.forces.push_back(normalForceNow(dynamics, list, lane));
			found.necks.push_back(neckOf(list, lane, dynamics.state()));
		});
		return found;
	}
}

std::vector<NormalForces> normalForces(const Dynamics& dynamics)
{
	const auto& domains = dynamics.parts();
	std::vector<NormalForces> found(2 * domains.size());
#pragma omp parallel for num_threads(dynamics.threadCount())
	for (std::size_t d = 0; d < domains.size(); ++d) {
		found[d] = normalForcesOf(dynamics, *domains[d], &Domain::contacts);
		found[domains.size() + d] = normalForcesOf(dynamics, *domains[d], &Domain::bonds);
	}
	return found;
}

int contactCount(const Dynamics& dynamics)
{
	int total = 0;
#pragma omp parallel for num_threads(dynamics.threadCount()) reduction(+ : total)
	for (std::size_t d = 0; d < dynamics.parts().size(); ++d)
		total += dynamics.parts()[d]->contactCount();
	return total;
}

int bondCount(const Dynamics& dynamics)
{
	int total = 0;
	eachBondLane(dynamics, [&](const BondList&, int, int, int) { ++total; });
	return total;
}

bool constrained(const Dynamics& dynamics)
{
	return std::any_of(
	        dynamics.parts().begin(), dynamics.parts().end(), [](const auto& domain) { return !domain->constraints.grains.empty(); });
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

std::array<long, bondModes> brokenBonds(const Dynamics& dynamics)
{
	std::array<long, bondModes> total {};
	for (const auto& domain : dynamics.parts())
		for (int mode = 0; mode < bondModes; ++mode)
			total[mode] += domain->broken[mode];
	return total;
}

Dissipation dissipated(const Dynamics& dynamics)
{
	Dissipation total;
	for (const auto& domain : dynamics.parts())
		total += domain->sums.dissipated;
	return total;
}

Counts counts(const Dynamics& dynamics)
{
	Counts total;
	for (const auto& domain : dynamics.parts())
		total.events += domain->events, total.formed += domain->formed, total.broken += domain->broke;
	return total;
}

} // namespace contact_law
