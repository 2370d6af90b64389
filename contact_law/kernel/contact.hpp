// The contact law at one instant: forces and torques of a pair from its geometry and its history. This is the one entry that both the
// YADE functors (with T = double) and the fused engine (with packs of doubles) evaluate.
#pragma once
#include "normal.hpp"
#include "pair_constants.hpp"
#include "tangential.hpp"

namespace contact_law {

// What a scene's contacts do besides adhering; a template parameter, so that what a scene doesn't use costs nothing.
enum Mechanism : unsigned {
	Sliding = 1,
	Rolling = 2,
	Twisting = 4,
	Drag = 8,
	AllSprings = Sliding | Rolling | Twisting,
	Everything = AllSprings | Drag
};

constexpr unsigned mechanismsOf(bool sliding, bool rolling, bool twisting, bool drag)
{
	return (sliding ? unsigned(Sliding) : 0u) | (rolling ? unsigned(Rolling) : 0u) | (twisting ? unsigned(Twisting) : 0u)
	        | (drag ? unsigned(Drag) : 0u);
}

// A contact's memory, in the frame of the laboratory. The pointers are saved in the grains' frames.
template <class T> struct ContactHistory {
	Pointers<T> pointers;
	T twist; // phi
};

template <class T> struct ContactGeometry {
	Vec3<T> normal; // n_c, from the centre of grain 2 to that of grain 1
	T inverseDistance;
	T overlap; // delta = r1 + r2 - distance
};

template <class T> inline ContactGeometry<T> geometryOf(const Vec3<T>& separation, const T& sumOfRadii)
{
	const T squared = dot(separation, separation), inverse = inverseRoot(squared);
	return { inverse * separation, inverse, sumOfRadii - squared * inverse };
}

template <class T> struct ContactForces {
	T normalForce;   // elastic, along n_c on grain 1: positive when repulsive
	T drag;          // viscous, likewise
	Vec3<T> sliding; // on grain 1; minus it on grain 2
	Vec3<T> torque1, torque2;
	T contactRadiusRoot; // u = (a/a0)^(1/2)
	Vec3<T> slidingDisplacement, rollingDisplacement;
};

/* Forces from the displacements as they are: limits, births and breaks are events, which contact_step.hpp handles. In two parts, because the
 * engine takes them in two sweeps over its contacts.
 * Along the normal: elastic force and drag. `velocity` is v1 - v2 at this instant; only drag reads it. */
template <unsigned mechanisms, class T>
inline void normalForces(const PairConstants<T>& c, const ContactGeometry<T>& g, const Vec3<T>& velocity, ContactForces<T>& f)
{
	f.contactRadiusRoot = normal::rootOfContactRadius(g.overlap * c.inverseEquilibriumOverlap);
	f.normalForce = c.pullOffForce * normal::force(f.contactRadiusRoot);
	if constexpr (bool(mechanisms & Drag)) { // A22 (7) and K13 (4); v_rel = -(v1 - v2).n_c is positive when approaching
		const T contactRadius = c.equilibriumContactRadius * f.contactRadiusRoot * f.contactRadiusRoot;
		f.drag = -(c.dragPerContactRadius * contactRadius + c.linearDrag) * dot(velocity, g.normal);
	}
}

/* Sliding, rolling and twisting, with the radii and stiffnesses of c (PairConstants, or a bond's). Torques are written with n1 x n2 and n_i x n_c, which need no zeta:
 *   M_s1 = -r1 k_s n1 x zeta = r1 k_s (r2 n1 x n2 + z n1 x n_c),  M_r1 = -R^2 k_r n1 x n2,  z = zeta0.n_c  (A24 eqs A5-A8, any radii). */
template <unsigned mechanisms, class Constants, class T>
inline void tangentialForces(const Constants& c, const ContactGeometry<T>& g, const ContactHistory<T>& h, ContactForces<T>& f)
{
	const Vec3<T>& n = g.normal;
	if constexpr (bool(mechanisms & (Sliding | Rolling))) {
		const Vec3<T>&n1 = h.pointers.n1, &n2 = h.pointers.n2;
		T across = T(0.); // factor of n1 x n2
		if constexpr (bool(mechanisms & Rolling)) {
			f.rollingDisplacement = rolling::displacement(h.pointers, c.reducedRadius);
			across = -(c.reducedRadius * c.reducedRadius * c.rollingStiffness);
		}
		if constexpr (bool(mechanisms & Sliding)) {
			const Vec3<T> zeta0 = sliding::separation(h.pointers, c.radius1, c.radius2);
			const T z = dot(zeta0, n), kz = c.slidingStiffness * z;
			f.slidingDisplacement = zeta0 - z * n;
			f.sliding = (kz * g.inverseDistance) * f.slidingDisplacement;
			f.torque1 = (kz * c.radius1) * cross(n1, n);
			f.torque2 = -((kz * c.radius2) * cross(n2, n));
			across = across + c.slidingStiffness * c.radius1 * c.radius2;
		}
		const Vec3<T> common = across * cross(n1, n2);
		f.torque1 = f.torque1 + common;
		f.torque2 = f.torque2 - common;
	}
	if constexpr (bool(mechanisms & Twisting)) {
		const Vec3<T> twisting = (c.twistingStiffness * h.twist) * n;
		f.torque1 = f.torque1 - twisting;
		f.torque2 = f.torque2 + twisting;
	}
}

template <unsigned mechanisms, class T>
inline ContactForces<T> contactForces(
        const PairConstants<T>& c, const ContactGeometry<T>& g, const ContactHistory<T>& h, const Vec3<T>& velocity)
{
	const Vec3<T> none { T(0.), T(0.), T(0.) };
	ContactForces<T> f { T(0.), T(0.), none, none, none, T(0.), none, none };
	normalForces<mechanisms>(c, g, velocity, f);
	tangentialForces<mechanisms>(c, g, h, f);
	return f;
}

// The energies stored in a contact, by channel.
template <class T> struct StoredEnergy {
	T normal, sliding, rolling, twisting;

	StoredEnergy& operator+=(const StoredEnergy& e)
	{
		normal = normal + e.normal, sliding = sliding + e.sliding, rolling = rolling + e.rolling, twisting = twisting + e.twisting;
		return *this;
	}
};

template <class T> inline StoredEnergy<T> storedEnergy(const PairConstants<T>& c, const ContactForces<T>& f, const T& twist)
{
	return { c.pullOffForce * c.pullOffOverlap * normal::energy(f.contactRadiusRoot),
		T(0.5) * c.slidingStiffness * dot(f.slidingDisplacement, f.slidingDisplacement),
		T(0.5) * c.rollingStiffness * dot(f.rollingDisplacement, f.rollingDisplacement),
		T(0.5) * c.twistingStiffness * twist * twist };
}

} // namespace contact_law
