// Damping of the springs of sliding, rolling and twisting (Kelvin-Voigt): beside k D each has the force k c dD/dt, c one time for all. MODEL.md,
// "Damped springs", derives each line. dD/dt is that of the spring: what slips take of the grains' motion strains none.
#pragma once
#include "events.hpp"
#include "limits.hpp"

namespace contact_law {

template <class T> inline SpringRates<T> operator+(const SpringRates<T>& a, const SpringRates<T>& b)
{
	return { a.sliding + b.sliding, a.turning + b.turning };
}
template <class T> inline SpringRates<T> operator-(const SpringRates<T>& a, const SpringRates<T>& b)
{
	return { a.sliding - b.sliding, a.turning - b.turning };
}
template <class T> inline SpringRates<T> operator*(const T& s, const SpringRates<T>& a) { return { s * a.sliding, s * a.turning }; }

namespace spring_damping {

	// By which levers the grains' motion strains the sliding spring: across the normal, and by their spins.
	template <class T> struct Levers {
		T across, first, second;
	};
	template <class T> inline Levers<T> leversOf(const PairConstants<T>& c, const T& inverseDistance, const Pointers<T>&)
	{
		return { (c.radius1 + c.radius2) * inverseDistance, c.radius1, c.radius2 };
	}
	template <class T> inline Levers<T> leversOf(const PairConstants<T>& c, const T&, const PlanePointers<T>&)
	{
		return { T(1.), c.radius1, T(0.) };
	}

	// The grains' motion through a step, with the normal half-way through it, so that its work is of second order.
	template <class T> struct Motion {
		Vec3<T> normal;
		SpringRates<T> rates;
	};
	template <class T, class SomePointers>
	inline Motion<T> motion(const PairConstants<T>& c, const ContactGeometry<T>& g, const SomePointers& p, const Vec3<T>& velocity,
	        const Vec3<T>& spin1, const Vec3<T>& spin2, const T& dt)
	{
		const T along = dot(velocity, g.normal), turned = T(0.5) * dt * g.inverseDistance;
		const Vec3<T> n = g.normal - turned * (velocity - along * g.normal);
		const Levers<T> l = leversOf(c, g.inverseDistance * (T(1.) + turned * along), p);
		const Vec3<T> across = l.across * (velocity - dot(velocity, n) * n);
		return { n, { across - cross(l.first * spin1 + l.second * spin2, n), spin1 - spin2 } };
	}

	// What slips took of it: displacements before and after they were returned to their limits.
	template <class T>
	inline SpringRates<T> slipRates(
	        const PairConstants<T>& c, const Vec3<T>& normal, const Displacements<T>& trial, const Displacements<T>& after, const T& dt)
	{
		const T rate = T(1.) / dt;
		return { rate * (trial.sliding - after.sliding),
			(rate / c.reducedRadius) * cross(trial.rolling - after.rolling, normal)
			        + (rate * (trial.twist - after.twist)) * normal };
	}
	template <class T, class History>
	inline Displacements<T> displacements(const PairConstants<T>& c, const Vec3<T>& normal, const History& h)
	{
		return { SlidingSpring::displacement(c, h.pointers, normal), RollingSpring::displacement(c, h.pointers), h.twist };
	}

	// At this instant, from the rates through the step to it and the step before, as drag's velocity.
	template <class T> inline DampingMoment<T> now(const SpringRates<T>& rates, const SpringRates<T>& before)
	{
		return { rates, rates + T(0.5) * (rates - before) };
	}

	// Forces and torques of these rates; time: c.
	template <class T, class SomePointers>
	inline void addForces(const PairConstants<T>& c, const ContactGeometry<T>& g, const SomePointers& p, const SpringRates<T>& rates,
	        const T& time, ContactForces<T>& f)
	{
		const Vec3<T>& n = g.normal;
		const Levers<T> l = leversOf(c, g.inverseDistance, p);
		const T along = dot(rates.turning, n), rolling = c.reducedRadius * c.reducedRadius * c.rollingStiffness;
		const Vec3<T> force = (time * c.slidingStiffness) * (rates.sliding - dot(rates.sliding, n) * n), moment = cross(n, force);
		const Vec3<T> couple = time * (rolling * (rates.turning - along * n) + (c.twistingStiffness * along) * n);
		f.sliding = f.sliding - l.across * force;
		f.torque1 = f.torque1 + l.first * moment - couple;
		f.torque2 = f.torque2 + l.second * moment + couple;
	}

	// Stiffnesses times the products of two rates, by springs.
	template <class T> struct Powers {
		T sliding, rolling, twisting;
	};
	template <class T>
	inline Powers<T> powers(const PairConstants<T>& c, const Vec3<T>& normal, const SpringRates<T>& a, const SpringRates<T>& b)
	{
		const T along = dot(a.turning, normal) * dot(b.turning, normal);
		return { c.slidingStiffness * dot(a.sliding, b.sliding),
			c.reducedRadius * c.reducedRadius * c.rollingStiffness * (dot(a.turning, b.turning) - along),
			c.twistingStiffness * along };
	}

	/* Dissipated over a step, where `counted`: the mean of the forces before and after it, times the springs' way; and by the slips, times
	 * theirs. */
	template <class T>
	inline void book(const PairConstants<T>& c, const Motion<T>& m, const SpringRates<T>& before, const SpringRates<T>& now,
	        const SpringRates<T>& slipped, const T& time, const T& dt, const MaskOf<T>& counted, DissipationOf<T>& lost)
	{
		const T half = choose(counted, T(0.5) * time * dt, T(0.));
		const Powers<T> springs = powers(c, m.normal, before + now, m.rates - slipped),
		                slips = powers(c, m.normal, before + now, slipped);
		lost.springDamping = lost.springDamping + half * (springs.sliding + springs.rolling + springs.twisting);
		lost.sliding = lost.sliding + half * slips.sliding;
		lost.rolling = lost.rolling + half * slips.rolling;
		lost.twisting = lost.twisting + half * slips.twisting;
	}

	/* Of one contact in one step, added to what its springs give. share: of the step for which it has existed; one that was placed there has
	 * moved so far as it does now, and nothing is booked. */
	template <class History>
	inline void add(const PairConstants<double>& c, const ContactMotion& m, const ContactBefore& before, const History& h, double share,
	        bool placed, ContactStepResult& r)
	{
		const Motion<double> way = motion(c, r.geometry, h.pointers, m.velocity, m.spin1, m.spin2, m.dt);
		r.damping = now(share * way.rates - r.slipped, placed ? way.rates : before.damping.through);
		book(c, way, before.damping.now, r.damping.now, r.slipped, c.springDamping, m.dt, !placed, r.dissipated);
		ContactForces<double> f = ContactForces<double>::none();
		addForces(c, r.geometry, h.pointers, r.damping.now, c.springDamping, f);
		events::Kicks kicks;
		kicks.add(0, 1, r.geometry, f);
		r.now.sliding = r.now.sliding + f.sliding;
		r.addKicks(kicks.force, kicks.torque1, kicks.torque2, 0.5);
		r.workBefore += 0.5 * kicks.work(m);
	}

	/* Of one that breaks: what is missing of its kicks to the fraction of the step. Before r.workBefore is known. */
	template <class History>
	inline void addUntilBreaking(const PairConstants<double>& c, const ContactMotion& m, const ContactBefore& before, const History& h,
	        double fraction, ContactStepResult& r, const ContactGeometry<double>& g)
	{
		const Motion<double> way = motion(c, g, h.pointers, m.velocity, m.spin1, m.spin2, m.dt);
		const Powers<double> taken = powers(c, way.normal, before.damping.now, way.rates);
		r.dissipated.springDamping = fraction * c.springDamping * m.dt * (taken.sliding + taken.rolling + taken.twisting);
		ContactForces<double> f = ContactForces<double>::none();
		addForces(c, g, h.pointers, before.damping.now, c.springDamping, f);
		events::Kicks kicks;
		kicks.add(0, fraction - 0.5, g, f);
		r.addKicks(kicks.force, kicks.torque1, kicks.torque2, 1);
	}

} // namespace spring_damping
} // namespace contact_law
