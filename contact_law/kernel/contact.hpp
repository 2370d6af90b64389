// The contact law at one instant: the one place where mechanisms are put together. contactForces() is the one entry that both the YADE
// functors (with T = double) and the fused engine (with packs of doubles) evaluate. Each mechanism's formulas stand in its own file.
#pragma once
#include "drag.hpp"
#include "normal.hpp"
#include "rolling.hpp"
#include "sliding.hpp"
#include "twisting.hpp"

namespace contact_law {

/* Forces from the displacements as they are: limits, formation and breaking are events, which contact_step.hpp handles. In two parts,
 * because the engine takes them in two sweeps over its contacts.
 * Along the normal: elastic force and drag. `velocity` is v1 - v2 at this instant; only drag reads it. */
template <unsigned mechanisms, class T>
inline void normalForces(const PairConstants<T>& c, const ContactGeometry<T>& g, const Vec3<T>& velocity, ContactForces<T>& f)
{
	normal::addForces(c, g, f);
	if constexpr (bool(mechanisms & Drag)) f.drag = drag::force(c, g.normal, velocity, f.contactRadiusRoot);
}

// Sliding, rolling and twisting, with the radii and stiffnesses of c (PairConstants, or a bond's).
template <unsigned mechanisms, class Constants, class T, class History>
inline void tangentialForces(const Constants& c, const ContactGeometry<T>& g, const History& h, ContactForces<T>& f)
{
	if constexpr (bool(mechanisms & (Sliding | Rolling))) {
		T across = T(0.); // factor of n1 x n2 in the torques, which sliding and rolling share
		if constexpr (bool(mechanisms & Rolling)) across = RollingSpring::addForces(c, h.pointers, f);
		if constexpr (bool(mechanisms & Sliding)) across = across + SlidingSpring::addForces(c, g, h.pointers, f);
		const Vec3<T> common = across * cross(h.pointers.n1, h.pointers.n2);
		f.torque1 = f.torque1 + common;
		f.torque2 = f.torque2 - common;
	}
	if constexpr (bool(mechanisms & Twisting)) twisting::addTorques(c, g, h.twist, f);
}

// History: ContactHistory, or of a grain and a plane PlaneHistory.
template <unsigned mechanisms, class T, class History>
inline ContactForces<T> contactForces(const PairConstants<T>& c, const ContactGeometry<T>& g, const History& h, const Vec3<T>& velocity)
{
	ContactForces<T> f = ContactForces<T>::none();
	normalForces<mechanisms>(c, g, velocity, f);
	tangentialForces<mechanisms>(c, g, h, f);
	return f;
}

// Of springs that are left out the forces have no displacement; the twist means nothing there.
template <class T>
inline StoredEnergy<T> storedEnergy(unsigned mechanisms, const PairConstants<T>& c, const ContactForces<T>& f, const T& twist)
{
	return { normal::energy(c, f.contactRadiusRoot), springEnergy<SlidingSpring>(c, f.slidingDisplacement),
		springEnergy<RollingSpring>(c, f.rollingDisplacement), mechanisms & Twisting ? twisting::energy(c, twist) : T(0.) };
}

/* What disconnection takes of a contact whose grains a script has moved apart: pull-off's energy, and what its springs held before. Of each no more than at its limit:
 * where the contact was handed over after the move, its displacements are of the new places. */
inline double letGo(unsigned mechanisms, const PairConstants<double>& c, const ContactBefore& before)
{
	const auto held = [](double stiffness, double squared, double limit) { return 0.5 * stiffness * std::min(squared, limit * limit); };
	double taken = normal::energyUnit(c) * normal::energyAtPullOff;
	if (mechanisms & Sliding) taken += held(c.slidingStiffness, dot(before.sliding, before.sliding), c.criticalSliding);
	if (mechanisms & Rolling) taken += held(c.rollingStiffness, dot(before.rolling, before.rolling), c.criticalRolling);
	if (mechanisms & Twisting) taken += held(c.twistingStiffness, before.twist * before.twist, c.criticalTwisting);
	return taken;
}

/* Springs that come in after they were left out have no strain: what their displacements did meanwhile means nothing. Sliding and rolling have their pointers in common:
 * these start anew, with the displacement of the one that was there. before: a step ago. */
inline void startPointers(const Vec3<double>& normal, Pointers<double>& p) { p = { -normal, normal }; }
inline void startPointers(const Vec3<double>& normal, PlanePointers<double>& p) { p.n1 = -normal, p.anchor = { 0, 0, 0 }; }
template <class History>
void startSprings(unsigned mechanisms, unsigned started, const PairConstants<double>& c, const Vec3<double>& normal, History& h,
        ContactBefore& before)
{
	const Vec3<double> none { 0, 0, 0 };
	const auto across = [&](const Vec3<double>& v) { // as long
		const Vec3<double> w = v - dot(v, normal) * normal;
		return dot(w, w) > 0 ? std::sqrt(dot(v, v) / dot(w, w)) * w : none;
	};
	if (started & Twisting) h.twist = before.twist = 0;
	if (!(started & (Sliding | Rolling))) return;
	const unsigned there = mechanisms & ~started;
	const Vec3<double> slid = there & Sliding ? SlidingSpring::displacement(c, h.pointers, normal) : none;
	const Vec3<double> rolled = there & Rolling ? across(RollingSpring::displacement(c, h.pointers)) : none;
	startPointers(normal, h.pointers);
	h.pointers = displaced<RollingSpring>(c, displaced<SlidingSpring>(c, h.pointers, slid), rolled);
	if (started & Sliding) before.sliding = none;
	if (started & Rolling) before.rolling = none;
}

// What the springs of a contact give up when it breaks after a fraction of the step (pointers.hpp), added to what disconnection takes.
template <unsigned mechanisms>
inline void addSpringRelease(const PairConstants<double>& c, const ContactBefore& before, const ContactForces<double>& f, double twist,
        double fraction, Dissipation& lost)
{
	double& taken = lost.disconnection;
	if constexpr (bool(mechanisms & Sliding))
		taken += springRelease(c.slidingStiffness, before.sliding, f.slidingDisplacement, fraction);
	if constexpr (bool(mechanisms & Rolling))
		taken += springRelease(c.rollingStiffness, before.rolling, f.rollingDisplacement, fraction);
	if constexpr (bool(mechanisms & Twisting)) taken += springRelease(c.twistingStiffness, before.twist, twist, fraction);
}

} // namespace contact_law
