#include "plane_contacts.hpp"
#include <algorithm>

namespace contact_law {

namespace {
	double component(const Vec3<double>& v, int axis) { return (&v.x)[axis]; }

	Vec3<double> normalOf(int axis, double side)
	{
		Vec3<double> normal { 0, 0, 0 };
		(&normal.x)[axis] = side;
		return normal;
	}
}

PlaneContacts::PlaneContacts(SharedState& shared, Ledger& ledger_, int begin_, int end_)
        : s(shared)
        , ledger(ledger_)
        , begin(begin_)
        , end(end_)
{
	for (const PlaneInput& plane : s.planes)
		positions.push_back(plane.position);
	pushes = after = std::vector<Vec3<double>>(s.planes.size(), Vec3<double> { 0, 0, 0 });
}

double PlaneContacts::distance(int grain, int plane) const
{
	const int axis = s.planes[plane].axis;
	return component(positionOf(s.grains[grain]), axis) - component(positions[plane], axis);
}

PlaneContact PlaneContacts::newContact(int grain, int plane) const
{
	return { grain, plane, distance(grain, plane) > 0 ? 1. : -1., {}, {}, {}, s.constantsOnPlane(grain, plane) };
}

void PlaneContacts::place(const PlaneContact& contact)
{
	if (owns(contact.grain)) contacts.insert(std::upper_bound(contacts.begin(), contacts.end(), contact), contact);
}

Plane PlaneContacts::planeOf(const PlaneContact& c) const
{
	const PlaneInput& plane = s.planes[c.plane];
	return { positions[c.plane], normalOf(plane.axis, c.side), plane.velocity };
}

// Of the grain's centre, from the plane's position.
Vec3<double> PlaneContacts::footOf(const PlaneContact& c) const
{
	return planeOf(c).across(positionOf(s.grains[c.grain]) - positions[c.plane]);
}

// Returns whether it touches afterwards.
bool PlaneContacts::step(PlaneContact& c)
{
	const Plane plane = planeOf(c);
	Grain& g = s.grains[c.grain];
	const unsigned blocked = s.blocked[c.grain];
	const ContactMotion m = motionPast(plane, positionOf(g), velocityOf(g), spinOf(g), s.dt,
	        inverseMassAlong(plane.normal, s.inverseMass[c.grain], blocked), inverseInertiaOf(s.inverseInertia[c.grain], blocked));
	const Vec3<double> foot = footOf(c);
	PlaneHistory<double> history { { { turnedALittle(c.n1, s.dt * m.spin1), plane.normal }, c.point - foot }, c.before.twist };
	const ContactStepResult r = planeStepWith[s.mechanisms](c.constants, s.limit, m, c.before, history);
	ledger.bookOnPlane(c.grain, g, r, s.dt);
	if (r.geometry.overlap > s.radius[c.grain]) ledger.tooDeep = true;
	ledger.counts.events += s.dt > 0 && (!c.before.touching || r.isEvent());
	add(c, r.force, r.forceBefore, r.torque1);
	c.n1 = history.pointers.n1;
	c.point = history.pointers.anchor + foot;
	c.before = { r.touching, r.geometry.overlap, r.now.drag, r.now.slidingDisplacement, r.now.rollingDisplacement, history.twist,
		m.velocity, r.damping };
	return r.touching;
}

void PlaneContacts::addForcesOfPlanes(const VelocityRange& velocities)
{
	double fastest = 0;
	for (std::size_t p = 0; p < positions.size(); ++p) {
		const PlaneInput& plane = s.planes[p];
		work -= s.dt * dot(after[p], plane.velocity);
		after[p] = pushes[p] = { 0, 0, 0 };
		const double v = component(plane.velocity, plane.axis);
		fastest = std::max({ fastest, velocities.most[plane.axis] - v, v - velocities.least[plane.axis] });
	}
	approach += s.dt * fastest;
	if (approach > s.skin) findNear();
	stepAll();
	formContacts();
}

void PlaneContacts::stepAll()
{
	long slips = 0;
	std::size_t kept = 0;
	for (std::size_t first = 0; first < contacts.size(); first += lanes) {
		const int count = int(std::min(contacts.size() - first, std::size_t(lanes)));
		const PlanePass pass { s.grains.data(), s.planes.data(), positions.data(), &contacts[first], count, s.dt,
			s.limit == LimitRule::Cut, &ledger.lost, &slips };
		LaneForces out;
		// a pass for damped springs isn't worth its compiling
		const unsigned left =
		        s.displaced.empty() && !(s.mechanisms & SpringDamping) ? s.passes->planeForces[s.mechanisms](pass, out) : ~0u;
		for (int k = 0; k < count; ++k) {
			PlaneContact& c = contacts[first + k];
			if (!(left >> k & 1)) {
				const Vec3<double> force = vectorIn(out.force, k);
				add(c, force, 0.5 * force, vectorIn(out.torque1, k));
			} else if (!step(c))
				continue;
			if (&contacts[kept] != &c) contacts[kept] = c;
			++kept;
		}
	}
	contacts.resize(kept);
	ledger.counts.events += s.dt > 0 ? slips : 0;
}

// A contact's kick on its grain; its plane is given the opposite.
void PlaneContacts::add(const PlaneContact& c, const Vec3<double>& force, const Vec3<double>& forceBefore, const Vec3<double>& torque)
{
	addToGrain(s.grains[c.grain], force, torque);
	work -= s.dt * dot(forceBefore, s.planes[c.plane].velocity);
	after[c.plane] = after[c.plane] + (force - forceBefore);
	pushes[c.plane] = pushes[c.plane] - force;
}

// Of grains that overlap a plane now and do not touch it.
void PlaneContacts::formContacts()
{
	std::vector<PlaneContact> formed;
	auto known = contacts.begin();
	for (const Near& pair : near) {
		while (known != contacts.end() && std::pair(known->grain, known->plane) < std::pair(pair.grain, pair.plane))
			++known;
		if (known != contacts.end() && known->grain == pair.grain && known->plane == pair.plane) continue;
		if (std::abs(distance(pair.grain, pair.plane)) > s.radius[pair.grain]) continue;
		PlaneContact contact = newContact(pair.grain, pair.plane);
		if (step(contact)) formed.push_back(contact);
	}
	for (const PlaneContact& contact : formed)
		place(contact);
}

void PlaneContacts::findNear()
{
	near.clear();
	for (int grain = begin; grain < end; ++grain)
		for (int plane = 0; plane < int(positions.size()); ++plane)
			if (std::abs(distance(grain, plane)) < s.radius[grain] + s.skin) near.push_back({ grain, plane });
	approach = 0;
}

void PlaneContacts::takeVelocities()
{
	for (PlaneContact& c : contacts) {
		const Grain& g = s.grains[c.grain];
		c.before.velocity = velocityOf(g) - s.planes[c.plane].velocity;
		c.before.damping.through = spring_damping::motion(
		        c.constants, geometryOf(c), PlanePointers<double> {}, c.before.velocity, spinOf(g), { 0, 0, 0 }, 0.)
		                                   .rates;
	}
}

ContactGeometry<double> PlaneContacts::geometryOf(const PlaneContact& c) const
{
	return { normalOf(s.planes[c.plane].axis, c.side), 0, s.radius[c.grain] - c.side * distance(c.grain, c.plane) };
}

ContactForces<double> PlaneContacts::forcesOf(const PlaneContact& c) const
{
	const ContactGeometry<double> g = geometryOf(c);
	const PlaneHistory<double> history { { { c.n1, g.normal }, c.point - footOf(c) }, c.before.twist };
	ContactForces<double> f = contactForces<AllSprings>(c.constants, g, history, c.before.velocity);
	f.drag = c.before.drag;
	if (s.mechanisms & SpringDamping)
		spring_damping::addForces(c.constants, g, history.pointers, c.before.damping.now, s.pairs.springDamping, f);
	f.keepOnly(s.mechanisms);
	return f;
}

StoredEnergy<double> PlaneContacts::energies() const
{
	StoredEnergy<double> total { 0, 0, 0, 0 };
	for (const PlaneContact& c : contacts)
		total += storedEnergy(s.mechanisms, c.constants, forcesOf(c), c.before.twist);
	return total;
}

} // namespace contact_law
