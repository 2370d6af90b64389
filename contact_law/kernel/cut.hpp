// The rule of Sirono & Ueno (2017, "S17", section 3.2) for displacements beyond their limits: the spring is cut at the limit, what it stores
// is lost, and a new one without strain takes its place at once. (The rule of Wada et al. 2007 is limits.hpp.)
// A cut is an event inside the step, as formation and breaking are: the force jumps there, and the kick before this instant is the integral
// of the springs' forces over the step less the half step that was given a step ago. MODEL.md, "Cut springs", derives each line.
#pragma once
#include "events.hpp"
#include "limits.hpp"
#include "numbers.hpp"

namespace contact_law {
namespace cut {

	// A displacement that grows evenly through a step while its spring is cut at every limit.
	template <class Displacement> struct Passage {
		bool any = false;     // whether a spring was cut
		Displacement now {};  // of the last spring
		Displacement mean {}; // of all springs, over the time of the passage
	};

	inline Passage<Vec3<double>> passage(const Vec3<double>& before, const Vec3<double>& trial, double limit)
	{
		const Vec3<double> way = trial - before;
		const double length = std::sqrt(dot(way, way));
		const double first = events::fractionUntilLength(before, trial, limit * limit), left = 1 - first;
		const double more = std::floor(left * length / limit), each = more > 0 ? limit / length : 0.; // springs, of the step each
		const double last = left - more * each;
		const double ofNew = 0.5 * (more * each * each + last * last);
		return { true, last * way, first * before + (0.5 * first * first + ofNew) * way };
	}
	inline Passage<double> passage(double before, double trial, double limit)
	{
		const auto p = passage(Vec3<double> { before, 0, 0 }, Vec3<double> { trial, 0, 0 }, limit);
		return { p.any, p.now.x, p.mean.x };
	}

	// What the motion lost to a spring in the step, beyond what it stores now, and what a leapfrog loses when the half kicks before and
	// after this instant are not equal.
	template <class Displacement>
	inline double taken(double stiffness, const Displacement& aStepAgo, const Displacement& trial, const Displacement& now,
	        const events::Kicks& before, const ContactMotion& m)
	{
		return stiffness / 2 * (product(aStepAgo, trial) - product(now, now)) - before.workOnPair(m);
	}
	inline double lostByUnequal(const events::Kicks& before, const events::Kicks& after, const ContactMotion& m)
	{
		return (after.squared(m) - before.squared(m)) * m.dt * m.dt / 2;
	}

	// One contact in one step.
	struct Step {
		const PairConstants<double>& constants;
		const ContactGeometry<double>& geometry;
		const ContactMotion& motion;
		double springsBefore; // fraction of the springs' forces that belongs before this instant without a cut

		template <unsigned mode, class History> ON_GPU events::Kicks kicksOf(const History& h, double fraction) const
		{
			ContactForces<double> f = ContactForces<double>::none();
			tangentialForces<mode>(constants, geometry, h, f);
			events::Kicks kicks;
			kicks.add(0, fraction, geometry, f);
			return kicks;
		}
		// The displacement whose force, given now, is what is missing of the passage.
		template <class Displacement>
		ON_GPU Displacement acting(const Passage<Displacement>& passed, const Displacement& aStepAgo) const
		{
			return 2 * springsBefore * passed.mean - 0.5 * aStepAgo;
		}
		/* A displacement a step ago, turned as a pair turns whose grains do not move against each other: what is left to its value now is
		 * the motion that strains a new spring. */
		ON_GPU Vec3<double> carriedAlong(const Vec3<double>& displacement) const
		{
			const Vec3<double>& n = geometry.normal;
			const Vec3<double> turn = cross(n, normalRate(n, geometry.inverseDistance, motion.velocity))
			        + (0.5 * dot(motion.spin1 + motion.spin2, n)) * n;
			return turned(displacement, motion.dt * turn);
		}
	};

	// Sliding or rolling in one step: its spring is cut by cutIn(), which moves the pointers; book() is for all pointers moved.
	template <class Spring> struct InStep {
		const Step& step;
		const Vec3<double> aStepAgo, trial;
		Passage<Vec3<double>> passed {};

		template <class SomePointers>
		ON_GPU InStep(const Step& s, const Vec3<double>& before, const SomePointers& p)
		        : step(s)
		        , aStepAgo(s.carriedAlong(before))
		        , trial(Spring::displacement(s.constants, p, s.geometry.normal))
		{
		}
		ON_GPU bool beyondLimit() const { return contact_law::beyondLimit<Spring>(step.constants, trial); }
		template <class SomePointers> ON_GPU void cutIn(SomePointers& p)
		{
			passed = passage(aStepAgo, trial, Spring::limit(step.constants));
			p = displaced<Spring>(
			        step.constants, p, passed.now - Spring::displacement(step.constants, p, step.geometry.normal));
		}
		// What it took of the motion; `added`: what its kick before this instant is beyond the ordinary one.
		template <class History> ON_GPU double book(const History& h, events::Kicks& added) const
		{
			const auto& p = h.pointers;
			const Vec3<double> now = Spring::displacement(step.constants, p, step.geometry.normal);
			events::Kicks before = step.kicksOf<Spring::mechanism>(h, step.springsBefore);
			double unequal = 0;
			if (passed.any) {
				added.add(before, -1);
				before = step.kicksOf<Spring::mechanism>(
				        History { displaced<Spring>(step.constants, p, step.acting(passed, aStepAgo) - now), 0 }, 1);
				added.add(before);
				unequal = lostByUnequal(before, step.kicksOf<Spring::mechanism>(h, 0.5), step.motion);
			}
			return taken(Spring::stiffness(step.constants), aStepAgo, trial, now, before, step.motion) + unequal;
		}
	};

	struct Result {
		bool pointersMoved = false;
		events::Kicks added; // to the kicks before this instant
	};

	template <class History> inline void twist(const Step& s, double before, History& h, Dissipation& lost, Result& result)
	{
		const double trial = h.twist;
		const Passage<double> passed = passage(before, trial, s.constants.criticalTwisting);
		h.twist = passed.now;
		History acting = h;
		acting.twist = s.acting(passed, before);
		const events::Kicks kicks = s.kicksOf<Twisting>(acting, 1), after = s.kicksOf<Twisting>(h, 0.5);
		lost.twisting += taken(s.constants.twistingStiffness, before, trial, h.twist, kicks, s.motion)
		        + lostByUnequal(kicks, after, s.motion);
		result.added.add(kicks);
		result.added.add(s.kicksOf<Twisting>(h, s.springsBefore), -1);
	}

	// Sliding and rolling share the pointers: cutting one spring shifts the other in second order, which is booked with the cut.
	template <class History>
	inline void slideAndRoll(
	        unsigned mechanisms, const Step& s, const ContactBefore& before, History& h, Dissipation& lost, Result& result)
	{
		auto& p = h.pointers;
		InStep<SlidingSpring> slide(s, before.sliding, p);
		InStep<RollingSpring> roll(s, before.rolling, p);
		const bool slides = mechanisms & Sliding && slide.beyondLimit(), rolls = mechanisms & Rolling && roll.beyondLimit();
		const bool freed = rollsFreely(mechanisms) && roll.beyondLimit();
		if (!slides && !rolls && !freed) return;
		if (slides) slide.cutIn(p);
		if (rolls) roll.cutIn(p);
		if (freed) p = displaced<RollingSpring>(s.constants, p, -RollingSpring::displacement(s.constants, p));
		result.pointersMoved = true;
		const double bySliding = mechanisms & Sliding ? slide.book(h, result.added) : 0;
		const double byRolling = mechanisms & Rolling ? roll.book(h, result.added) : 0;
		lost.sliding += slides || freed ? rolls ? bySliding : bySliding + byRolling : 0;
		lost.rolling += rolls ? slides ? byRolling : bySliding + byRolling : 0;
	}

} // namespace cut

/* Cut the springs of `h` whose displacements are beyond their limits, and book what that takes. before: a step ago (zero for a contact that
 * formed since); springsBefore: the fraction of the springs' forces that belongs before this instant without a cut, half of the time for
 * which the contact has existed in the step. */
template <class History>
inline cut::Result cutAtLimits(unsigned mechanisms, const PairConstants<double>& c, const ContactGeometry<double>& g,
        const ContactMotion& m, const ContactBefore& before, double springsBefore, History& h, Dissipation& lost)
{
	const cut::Step step { c, g, m, springsBefore };
	cut::Result result;
	if (mechanisms & Twisting && twisting::beyondLimit(c, h.twist)) cut::twist(step, before.twist, h, lost, result);
	if (mechanisms & (Sliding | Rolling)) cut::slideAndRoll(mechanisms, step, before, h, lost, result);
	return result;
}

} // namespace contact_law
