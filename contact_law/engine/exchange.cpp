// Contacts and grains as others hand them in and want them handed out in the middle of a run.
#include "dynamics.hpp"

namespace contact_law {

namespace {

	ContactHistory<double> swapped(const ContactHistory<double>& h)
	{
		return { { h.pointers.n2, h.pointers.n1 }, h.twist };
	} // spin and normal both change sign
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

void Dynamics::inherit(const Inherited& inherited)
{
	for (const Inherited::One& one : inherited.contacts) {
		const int a = indexHere[one.first], b = indexHere[one.second], i = std::min(a, b), j = std::max(a, b);
		const ContactHistory<double> history = a < b ? one.history : swapped(one.history);
		for (auto& domain : domains)
			one.bonded ? domain->place(Bond { i, j, history, one.rest, setting.bondOf(i, j) })
			           : domain->place(Contact { i, j, history, setting.constantsOf(i, j), one.drag, one.overlap });
	}
	for (auto& domain : domains)
		domain->sortContacts();
	if (!setting.hasDrag() || !inherited.stepBehind) return;
	for (int k = 0; k < count; ++k) {
		const Vec3<double>& v = inherited.previous[original[k]];
		setting.previous[k] = { v.x, v.y, v.z, 0 };
	}
}

ContactNow Dynamics::now(const Contact& c) const
{
	const Grain &a = setting.grains[c.i], &b = setting.grains[c.j];
	Vec3<double> separation = separationOf(a, b);
	const Image image = nearestImage(cell(), separation);
	ContactNow n { original[c.i], original[c.j], c.constants, c.history,
		geometryOf(separation, c.constants.radius1 + c.constants.radius2), {}, velocityOf(a) - velocityOf(b) + image.velocity,
		image.shift };
	n.forces = contactForces<AllSprings>(c.constants, n.geometry, c.history, n.velocity);
	n.forces.drag = c.drag;
	if (!(setting.mechanisms & Sliding)) n.forces.sliding = { 0, 0, 0 };
	return n;
}

ContactNow Dynamics::now(const Bond& b) const
{
	const Grain &a = setting.grains[b.i], &other = setting.grains[b.j];
	ContactNow n { original[b.i], original[b.j], setting.constantsOf(b.i, b.j), b.history, geometryOf(separationOf(a, other), b.rest),
		{}, velocityOf(a) - velocityOf(other), { 0, 0, 0 }, true, b.constants, b.rest };
	n.forces = bondForces(b.constants, n.geometry, b.history);
	return n;
}

double Dynamics::normalForce(const Contact& c) const
{
	const Grain &a = setting.grains[c.i], &b = setting.grains[c.j];
	Vec3<double> separation = separationOf(a, b);
	nearestImage(cell(), separation);
	const auto g = geometryOf(separation, c.constants.radius1 + c.constants.radius2);
	return contactForces<0>(c.constants, g, c.history, Vec3<double> {}).normalForce + c.drag;
}

void Dynamics::readAhead(std::vector<GrainInput>& grains) const
{
	read(grains);
	for (int k = 0; k < count; ++k) {
		Grain p = setting.grains[k];
		const double dt = setting.dt;
		kick(p, k, dt);
		p.x += dt * p.vx, p.y += dt * p.vy, p.z += dt * p.vz;
		GrainInput& g = grains[original[k]];
		write(p, g);
		g.orientation = turnedBy(dt * p.wx, dt * p.wy, dt * p.wz, g.orientation);
	}
}

bool Dynamics::constrained() const
{
	for (const auto& domain : domains)
		if (!domain->constraints.grains.empty()) return true;
	return false;
}

} // namespace contact_law
