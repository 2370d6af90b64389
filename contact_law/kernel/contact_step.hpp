// One contact through one time step of a kick-drift-kick integrator: limits, birth and break as located events, and the energy ledger.
//
// The ledger books the work that the integrator takes out of the grains. Over a step the grains move by velocity * dt, and the kicks are half the
// forces before and half the forces after it. A contact born (or lost) inside the step acted for a part of the step only: its kick is the integral of
// its force over that part, which keeps the trajectory and the ledger of second order in dt. MODEL.md, "Events", derives each line.
#pragma once
#include "contact.hpp"
#include "slip.hpp"
#include "turning.hpp"
#include <array>
#include <utility>

namespace contact_law {

struct ContactMotion {
	Vec3<double> separation;   // x1 - x2 now
	Vec3<double> velocity;     // v1 - v2 through the step, of their images nearest to each other
	Vec3<double> spin1, spin2; // angular velocities through the step
	double dt;
	double inverseMass;                     // 1/m1 + 1/m2
	Vec3<double> imageVelocity { 0, 0, 0 }; // of it, what is not the grains' own but the motion of a periodic cell's boundaries
};

// What the ledger and the drag need of the moment one step ago.
struct ContactBefore {
	bool touching = false;
	double overlap = 0;
	double drag = 0;
	Vec3<double> sliding { 0, 0, 0 }, rolling { 0, 0, 0 }; // displacements
	double twist = 0;
	Vec3<double> velocity { 0, 0, 0 }; // v1 - v2 through the step before this one
};

enum BondMode { ByStretching, BySliding, ByRolling, ByTwisting, bondModes }; // by which a sintered bond breaks (bond_step.hpp)

struct Dissipation {
	double sliding = 0, rolling = 0, twisting = 0, connection = 0, disconnection = 0, drag = 0;
	std::array<double, bondModes> bondBreaking {}; // by mode

	double bonds() const
	{
		return bondBreaking[ByStretching] + bondBreaking[BySliding] + bondBreaking[ByRolling] + bondBreaking[ByTwisting];
	}

	Dissipation& operator+=(const Dissipation& d)
	{
		sliding += d.sliding, rolling += d.rolling, twisting += d.twisting;
		connection += d.connection, disconnection += d.disconnection, drag += d.drag;
		for (int mode = 0; mode < bondModes; ++mode)
			bondBreaking[mode] += d.bondBreaking[mode];
		return *this;
	}
};

struct ContactStepResult {
	bool touching = false, pointersMoved = false;                             // moved by a slip, or new
	Vec3<double> force { 0, 0, 0 }, torque1 { 0, 0, 0 }, torque2 { 0, 0, 0 }; // kicks over dt; minus `force` on grain 2
	Vec3<double> forceBefore { 0, 0, 0 };                                     // the part of `force` that belongs before this instant
	double workBefore = 0; // work of the part of the kicks that belongs before this instant: kinetic energy now minus half a step ago
	ContactGeometry<double> geometry {};
	ContactForces<double> now {}; // the forces at this instant
	StoredEnergy<double> stored { 0, 0, 0, 0 };
	Dissipation dissipated;
};

namespace events {
	// on the grains
	inline double work(const ContactMotion& m, const Vec3<double>& force, const Vec3<double>& torque1, const Vec3<double>& torque2)
	{
		return m.dt * (dot(force, m.velocity - m.imageVelocity) + dot(torque1, m.spin1) + dot(torque2, m.spin2));
	}

	// The contact's memory at the moment it formed, `since` ago, carried to now.
	inline ContactHistory<double> bornHistory(const ContactMotion& m, double since)
	{
		const Vec3<double> then = m.separation - since * m.velocity;
		const Vec3<double> normal = (1 / std::sqrt(dot(then, then))) * then;
		return { { turned(-normal, since * m.spin1), turned(normal, since * m.spin2) }, since * dot(m.spin1 - m.spin2, normal) };
	}

	/* The contact broke inside the step: after the share g of it the overlap passed -delta_c. Its last kicks (before the step) covered half a step;
	 * what is missing to the share g follows now. The normal impulse comes from the energy, which the branch point at pull-off leaves smooth. */
	template <unsigned mechanisms>
	inline ContactStepResult lost(const PairConstants<double>& c, const ContactMotion& m, const ContactGeometry<double>& g,
	        const ContactBefore& before, const ContactHistory<double>& h)
	{
		ContactStepResult r;
		const double opening = before.overlap - g.overlap, share = (before.overlap + c.pullOffOverlap) / opening;
		const double uBefore = normal::rootOfContactRadius(before.overlap / c.equilibriumOverlap),
		             energyUnit = c.pullOffForce * c.pullOffOverlap;
		const double normalWork = energyUnit * (normal::energy(uBefore) - normal::energyAtPullOff);
		// what the steps before missed of the force's last rise, see sumMinusIntegralAtPullOff
		const double missed = c.pullOffForce * normal::pullOffSlope * std::sqrt(opening * c.inverseEquilibriumOverlap)
		        * normal::sumMinusIntegralAtPullOff(share);
		const double push =
		        normalWork / opening - c.pullOffForce * normal::force(uBefore) / 2 + (share - 0.5) * before.drag - missed;
		// at this instant, not at the break, so that forces and torques balance where the grains are
		const ContactForces<double> f = contactForces<mechanisms & AllSprings>(c, g, h, m.velocity);

		r.force = push * g.normal + (share - 0.5) * f.sliding;
		r.torque1 = (share - 0.5) * f.torque1;
		r.torque2 = (share - 0.5) * f.torque2;
		r.forceBefore = r.force;
		r.workBefore = work(m, r.force, r.torque1, r.torque2);

		// stored a step ago, and the work of the springs' half kick then and of their rest now
		const auto released = [&](double k, const auto& start, const auto& now, auto product) {
			return k / 2 * product(start, now) + k * (share - 0.5) * product(now, now - start);
		};
		const auto inner = [](const Vec3<double>& a, const Vec3<double>& b) { return dot(a, b); };
		const auto product = [](double a, double b) { return a * b; };
		const double impulse = push * m.dt;
		double& lostHere = r.dissipated.disconnection;
		lostHere = energyUnit * normal::energyAtPullOff - impulse * impulse * m.inverseMass / 2;
		if constexpr (bool(mechanisms & Sliding))
			lostHere += released(c.slidingStiffness, before.sliding, f.slidingDisplacement, inner);
		if constexpr (bool(mechanisms & Rolling))
			lostHere += released(c.rollingStiffness, before.rolling, f.rollingDisplacement, inner);
		if constexpr (bool(mechanisms & Twisting)) lostHere += released(c.twistingStiffness, before.twist, h.twist, product);
		r.dissipated.drag = -share * before.drag * opening;
		return r;
	}
}

/* The whole law for one contact and one step. `history` holds the pointers as the grains carried them to this instant, and the twist of the step before;
 * it comes back as it is after slips (and made anew for a contact that forms). touching = false in the result: no contact now, forget the history.
 * A contact that overlapped a step ago already and has no history was placed there by the user: nothing is booked for it. */
template <unsigned mechanisms>
inline ContactStepResult contactStep(
        const PairConstants<double>& c, const ContactMotion& m, const ContactBefore& given, ContactHistory<double>& history)
{
	const double sumOfRadii = c.radius1 + c.radius2;
	const ContactGeometry<double> g = geometryOf(m.separation, sumOfRadii);
	const Vec3<double> spin = m.spin1 - m.spin2;
	ContactBefore before = given;
	ContactStepResult r;
	double after = 0.5, ahead = 0.5, aheadTangential = 0.5; // shares of the kicks that belong after and before this instant
	bool born = false;

	if (before.touching) {
		if constexpr (bool(mechanisms & Twisting))
			history.twist += twisting::increment(g.normal, g.inverseDistance, m.velocity, spin, m.dt);
		if (g.overlap < -c.pullOffOverlap) return events::lost<mechanisms>(c, m, g, before, history);
	} else {
		if (g.overlap < 0) return r; // grains that sintering has shrunk are seen before they touch
		const Vec3<double> aStepAgo = m.separation - m.dt * m.velocity;
		before.overlap = sumOfRadii - std::sqrt(dot(aStepAgo, aStepAgo));
		born = before.overlap <= 0 && g.overlap > before.overlap;
		if (born) aheadTangential = ahead = g.overlap / (g.overlap - before.overlap);
		history = events::bornHistory(m, born ? ahead * m.dt : 0.);
		if (born) aheadTangential /= 2; // springs grow from zero
	}

	const Slip<double> slipped = slip<mechanisms>(c, g.normal, { before.sliding, before.rolling, before.twist },
	        { normalRate(g.normal, g.inverseDistance, m.velocity), m.spin1, m.spin2, m.dt }, history);
	r.dissipated.sliding = slipped.sliding, r.dissipated.rolling = slipped.rolling, r.dissipated.twisting = slipped.twisting;
	r.pointersMoved = slipped.pointersMoved || !before.touching;
	r.geometry = g;
	const Vec3<double> velocity =
	        before.touching ? m.velocity + 0.5 * (m.velocity - before.velocity) : m.velocity; // extrapolated to now
	r.touching = true;
	r.now = contactForces<mechanisms>(c, g, history, velocity);
	r.stored = storedEnergy(c, r.now, history.twist);

	const double closing = g.overlap - before.overlap;
	double normalAhead = ahead * (r.now.normalForce + r.now.drag);
	if (born) {
		const double energyUnit = c.pullOffForce * c.pullOffOverlap;
		const double elastic = (r.stored.normal - energyUnit * normal::energyAtConnection) / closing;
		normalAhead = elastic + ahead * r.now.drag;
		const double impulseAhead = normalAhead * m.dt, impulseAfter = after * (r.now.normalForce + r.now.drag) * m.dt;
		r.dissipated.connection = -energyUnit * normal::energyAtConnection
		        + (impulseAfter * impulseAfter - impulseAhead * impulseAhead) * m.inverseMass / 2;
		r.dissipated.drag = ahead * r.now.drag * closing;
	} else if (before.touching) {
		r.dissipated.drag = (before.drag + r.now.drag) / 2 * closing;
	}

	const Vec3<double> forceAhead = normalAhead * g.normal + aheadTangential * r.now.sliding;
	r.forceBefore = forceAhead;
	r.workBefore = events::work(m, forceAhead, aheadTangential * r.now.torque1, aheadTangential * r.now.torque2);
	r.force = forceAhead + after * ((r.now.normalForce + r.now.drag) * g.normal + r.now.sliding);
	r.torque1 = (aheadTangential + after) * r.now.torque1;
	r.torque2 = (aheadTangential + after) * r.now.torque2;
	return r;
}

// contactStep by its mechanisms, for callers that know them at run time only.
using ContactStep = ContactStepResult (*)(
        const PairConstants<double>&, const ContactMotion&, const ContactBefore&, ContactHistory<double>&);

template <size_t... mechanisms> constexpr std::array<ContactStep, sizeof...(mechanisms)> contactSteps(std::index_sequence<mechanisms...>)
{
	return { &contactStep<unsigned(mechanisms)>... };
}
constexpr auto contactStepWith = contactSteps(std::make_index_sequence<Everything + 1> {});

} // namespace contact_law
