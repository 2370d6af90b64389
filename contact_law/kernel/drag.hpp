// Drag: normal forces against the relative velocity, the viscoelastic one of A22 (eq 7) and the linear one of K13 (eq 4), and what they
// dissipate.
#pragma once
#include "pair_constants.hpp"
#include "contact_state.hpp"

namespace contact_law {
namespace drag {

	// v1 - v2 at this instant, extrapolated from the velocities through the step to it and the step before.
	template <class T> inline Vec3<T> velocityNow(const Vec3<T>& velocity, const Vec3<T>& before)
	{
		return velocity + T(0.5) * (velocity - before);
	}

	/* Along n_c on grain 1: F_D = (2 A E* a + k_n m0/t0) v_rel, v_rel = -(v1 - v2).n_c, positive when approaching.
	 * contactRadiusRoot: u = (a/a0)^(1/2); velocity: v1 - v2 at this instant. */
	template <class T>
	inline T force(const PairConstants<T>& c, const Vec3<T>& normal, const Vec3<T>& velocity, const T& contactRadiusRoot)
	{
		const T contactRadius = c.equilibriumContactRadius * contactRadiusRoot * contactRadiusRoot;
		return -(c.dragPerContactRadius * contactRadius + c.linearDrag) * dot(velocity, normal);
	}

} // namespace drag

// Dissipated over a step: the mean of the two forces times the way. Only where `counted`.
template <class T>
inline void bookDrag(const DragMoment<T>& before, const DragMoment<T>& now, const MaskOf<T>& counted, DissipationOf<T>& lost)
{
	lost.drag = lost.drag + choose(counted, T(0.5) * (before.force + now.force) * (now.overlap - before.overlap), T(0.));
}
// Over a fraction of the step of which the overlap changes by `closing`, with the force of one moment: of a contact that formed or
// broke inside the step.
inline void bookDragFraction(double fraction, const DragMoment<double>& at, double closing, Dissipation& lost)
{
	lost.drag += fraction * at.force * closing;
}

} // namespace contact_law
