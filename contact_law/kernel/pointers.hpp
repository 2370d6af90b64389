// What sliding and rolling share: contact pointers that turn with the grains and are moved when a displacement is returned to its limit
// (Wada et al. 2007), and what follows for both from their stiffness, limit, displacement, its rate, and how the pointers are moved.
#pragma once
#include "contact_state.hpp"
#include "pair_constants.hpp"

namespace contact_law {

/* A pointer moved along the unit vector e by move/radius. Renormalising undoes (n.e)^2 of a move (Wada et al. 2007): it goes that much
 * further; both are done at once, and without a division. */
template <class T> inline Vec3<T> movedPointer(const Vec3<T>& pointer, const T& move, const T& radius, const Vec3<T>& e)
{
	const T along = dot(pointer, e);
	const Vec3<T> moved = (radius * (T(1.) - along * along)) * pointer + move * e;
	return inverseRoot(dot(moved, moved)) * moved;
}
// A plane's anchor likewise: the limit of r movedPointer() for an infinite radius r.
template <class T> inline Vec3<T> movedAnchor(const PlanePointers<T>& p, const T& move, const Vec3<T>& e)
{
	const T along = dot(p.n2, e);
	return p.anchor + (move / (T(1.) - along * along)) * (e - along * p.n2);
}

template <class T> inline Vec3<T> choose(const MaskOf<T>& m, const Vec3<T>& yes, const Vec3<T>& no)
{
	return { choose(m, yes.x, no.x), choose(m, yes.y, no.y), choose(m, yes.z, no.z) };
}
template <class T> inline Pointers<T> choose(const MaskOf<T>& m, const Pointers<T>& yes, const Pointers<T>& no)
{
	return { choose<T>(m, yes.n1, no.n1), choose<T>(m, yes.n2, no.n2) };
}
template <class T> inline PlanePointers<T> choose(const MaskOf<T>& m, const PlanePointers<T>& yes, const PlanePointers<T>& no)
{
	return { { choose<T>(m, yes.n1, no.n1), no.n2 }, choose<T>(m, yes.anchor, no.anchor) };
}

// The way of pointers from `a` to `b`.
template <class T> inline Pointers<T> way(const Pointers<T>& a, const Pointers<T>& b) { return { b.n1 - a.n1, b.n2 - a.n2 }; }
template <class T> inline PlanePointers<T> way(const PlanePointers<T>& a, const PlanePointers<T>& b)
{
	return { { b.n1 - a.n1, b.n2 - a.n2 }, b.anchor - a.anchor };
}

// How the grains moved through the step.
template <class T> struct Turning {
	Vec3<T> normalRate, spin1, spin2; // dn/dt, angular velocities
	T dt;
};

template <class T> inline Vec3<T> normalRate(const Vec3<T>& normal, const T& inverseDistance, const Vec3<T>& velocity)
{
	return inverseDistance * (velocity - dot(velocity, normal) * normal);
}

// ---- Spring: SlidingSpring or RollingSpring ----

// U = k D^2/2 (A24 appendix A), of a contact or a bond
template <class Spring, class Constants, class T> inline T springEnergy(const Constants& c, const Vec3<T>& displacement)
{
	return T(0.5) * Spring::stiffness(c) * dot(displacement, displacement);
}
template <class Spring, class T> inline MaskOf<T> beyondLimit(const PairConstants<T>& c, const Vec3<T>& displacement)
{
	return Spring::limit(c) * Spring::limit(c) < dot(displacement, displacement);
}
// The pointers with their displacement returned to a limit, in its direction.
template <class Spring, class SomePointers, class T>
inline SomePointers returned(const PairConstants<T>& c, const SomePointers& p, const Vec3<T>& displacement, const T& limit)
{
	const T squared = dot(displacement, displacement), inverse = inverseRoot(squared), excess = squared * inverse - limit;
	return Spring::moved(c, p, -excess, inverse * displacement);
}
// The pointers with a displacement that is another `by`, a vector across the normal.
template <class Spring, class SomePointers>
inline SomePointers displaced(const PairConstants<double>& c, const SomePointers& p, const Vec3<double>& by)
{
	const double length = std::sqrt(dot(by, by));
	return length == 0 ? p : Spring::moved(c, p, length, (1 / length) * by);
}

/* The energy that a slip dissipates in one step of a kick-drift-kick integrator: the return of displacement `trial` to that of pointers
 * p, `after`, which moved them by `moved`. The kicks use the forces before the step (displacement `before`) and after the return, so that
 * the motion loses k/2 (before + after).(trial - before), while k/2 (after^2 - before^2) is stored. The last kick's lever arms are those
 * of the pointers returned: over the step their displacement would have changed by `further` more than the one that was returned, and
 * that too the kick takes. */
template <class Spring, class T, class SomePointers>
inline T slipDissipation(const PairConstants<T>& c, const Vec3<T>& normal, const Vec3<T>& before, const Vec3<T>& trial,
        const SomePointers& p, const SomePointers& moved, const Turning<T>& t)
{
	const Vec3<T> further = t.dt * Spring::rate(c, moved, normal, t), after = Spring::displacement(c, p, normal);
	return T(0.5) * Spring::stiffness(c) * (dot(before + after, trial - after) + dot(after, further));
}

/* What a spring gives up when its contact breaks after a fraction of the step: what it stored a step ago (displacement `before`), and
 * the work of its half kick then and of the rest of it now (displacement `now`). */
inline double product(double a, double b) { return a * b; }
inline double product(const Vec3<double>& a, const Vec3<double>& b) { return dot(a, b); }
template <class Displacement>
inline double springRelease(double stiffness, const Displacement& before, const Displacement& now, double fraction)
{
	return stiffness / 2 * product(before, now) + stiffness * (fraction - 0.5) * product(now, now - before);
}

} // namespace contact_law
