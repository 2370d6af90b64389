// Events inside a step: when a contact forms or breaks, with which pointers it forms, and the work of kicks. MODEL.md, "The integrator and
// the ledger", derives each line.
#pragma once
#include "contact_state.hpp"
#include "pair_constants.hpp"
#include "numbers.hpp"

namespace contact_law {
namespace events {

	// Of kicks at this instant, on the grains over the last step.
	inline double work(const ContactMotion& m, const Vec3<double>& force, const Vec3<double>& torque1, const Vec3<double>& torque2)
	{
		return m.dt * (dot(force, m.velocity - m.imageVelocity) + dot(torque1, m.spin1) + dot(torque2, m.spin2));
	}

	// Kicks of one contact at this instant, on the first grain (minus the force on the second).
	struct Kicks {
		Vec3<double> force { 0, 0, 0 }, torque1 { 0, 0, 0 }, torque2 { 0, 0, 0 };

		ON_GPU void add(double ofNormal, double ofSprings, const ContactGeometry<double>& g, const ContactForces<double>& f)
		{
			force = force + (ofNormal * (f.normalForce + f.drag)) * g.normal + ofSprings * f.sliding;
			torque1 = torque1 + ofSprings * f.torque1;
			torque2 = torque2 + ofSprings * f.torque2;
		}
		ON_GPU void add(const Kicks& other, double times = 1)
		{
			force = force + times * other.force;
			torque1 = torque1 + times * other.torque1;
			torque2 = torque2 + times * other.torque2;
		}
		// Kinetic energy that they would give to grains at rest, twice over dt^2.
		ON_GPU double squared(const ContactMotion& m) const
		{
			return dot(force, force) * m.inverseMass + dot(torque1, torque1) * m.inverseInertia1
			        + dot(torque2, torque2) * m.inverseInertia2;
		}
		ON_GPU double work(const ContactMotion& m) const { return events::work(m, force, torque1, torque2); }
		// That on a periodic cell's boundaries too.
		ON_GPU double workOnPair(const ContactMotion& m) const { return work(m) + m.dt * dot(force, m.imageVelocity); }
	};

	// The history of a contact that formed a time `since` ago, carried to now.
	inline ContactHistory<double> formedHistory(const ContactMotion& m, double since)
	{
		const Vec3<double> then = m.separation - since * m.velocity;
		const Vec3<double> normal = (1 / std::sqrt(dot(then, then))) * then;
		return { { turned(-normal, since * m.spin1), turned(normal, since * m.spin2) }, since * dot(m.spin1 - m.spin2, normal) };
	}

	inline void form(const ContactMotion& m, double since, ContactHistory<double>& h) { h = formedHistory(m, since); }
	// On a plane, whose normal stays.
	inline void form(const ContactMotion& m, double since, PlaneHistory<double>& h)
	{
		const Vec3<double>& n = h.pointers.n2;
		h.pointers.n1 = turned(-n, since * m.spin1);
		h.pointers.anchor = -(since * (m.velocity - dot(m.velocity, n) * n));
		h.twist = since * dot(m.spin1, n);
	}

	inline double overlapAStepAgo(
	        const ContactMotion& m, const ContactGeometry<double>&, double sumOfRadii, const ContactHistory<double>&)
	{
		const Vec3<double> aStepAgo = m.separation - m.dt * m.velocity;
		return sumOfRadii - std::sqrt(dot(aStepAgo, aStepAgo));
	}
	inline double overlapAStepAgo(const ContactMotion& m, const ContactGeometry<double>& g, double, const PlaneHistory<double>&)
	{
		return g.overlap + m.dt * dot(m.velocity, g.normal);
	}

	// Of grains that touch now and did not a step ago.
	struct Formation {
		double overlapBefore;
		bool inStep;     // otherwise they overlapped a step ago already: they were placed there
		double fraction; // of the step for which the contact has existed
	};
	inline Formation formationOf(double before, double overlap)
	{
		const bool inStep = before <= 0 && overlap > before;
		return { before, inStep, inStep ? overlap / (overlap - before) : 0. };
	}

	// Whether a contact has opened by more than twice what the grains' motion does.
	inline bool isTorn(const ContactMotion& m, double opening)
	{
		return opening * opening > 4 * m.dt * m.dt * dot(m.velocity, m.velocity);
	}

	// The fraction of the step after which the overlap passed -delta_c: 0 where it was past it before. (The engine takes a contact of the
	// functors as it was a small step of its own ago, and theirs may have been longer.)
	inline double fractionUntilPullOff(const PairConstants<double>& c, double overlapBefore, double opening)
	{
		const double left = overlapBefore + c.pullOffOverlap;
		return left > 0 ? left / opening : 0;
	}

	// The fraction of a step after which a displacement that goes evenly from `before` to `now` has the length whose square is given.
	inline double fractionUntilLength(const Vec3<double>& before, const Vec3<double>& now, double lengthSquared)
	{
		const Vec3<double> way = now - before;
		const double squared = dot(way, way), along = dot(before, way), missing = lengthSquared - dot(before, before);
		if (missing <= 0 || squared == 0) return 0;
		const double fraction = (std::sqrt(along * along + squared * missing) - along) / squared;
		return fraction < 1 ? fraction : 1;
	}

} // namespace events
} // namespace contact_law
