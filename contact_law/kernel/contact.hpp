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
		if constexpr (bool(mechanisms & Rolling)) across = rolling::addForces(c, h.pointers, f);
		if constexpr (bool(mechanisms & Sliding)) across = across + sliding::addForces(c, g, h.pointers, f);
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

template <class T> inline StoredEnergy<T> storedEnergy(const PairConstants<T>& c, const ContactForces<T>& f, const T& twist)
{
	return { normal::energy(c, f.contactRadiusRoot), sliding::energy(c, f.slidingDisplacement),
		rolling::energy(c, f.rollingDisplacement), twisting::energy(c, twist) };
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
