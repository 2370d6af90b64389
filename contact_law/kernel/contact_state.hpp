// What a contact is at one instant, and what moves it through a step: the types that all mechanisms share.
#pragma once
#include "energy_channels.hpp"
#include "numbers.hpp"

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
constexpr int mechanismSets = Everything + 1; // combinations of mechanisms
// The instances of a function template for all of them: for callers that know theirs at run time only.
#define CONTACT_LAW_ALL_MECHANISMS(f)                                                                                                      \
	{                                                                                                                                  \
		f<0>, f<1>, f<2>, f<3>, f<4>, f<5>, f<6>, f<7>, f<8>, f<9>, f<10>, f<11>, f<12>, f<13>, f<14>, f<15>                       \
	}

constexpr unsigned mechanismsOf(bool sliding, bool rolling, bool twisting, bool drag)
{
	return (sliding ? unsigned(Sliding) : 0u) | (rolling ? unsigned(Rolling) : 0u) | (twisting ? unsigned(Twisting) : 0u)
	        | (drag ? unsigned(Drag) : 0u);
}

// Contact pointers (Wada et al. 2007): unit vectors fixed in the grains, from their centres to the contact when it forms.
template <class T> struct Pointers {
	Vec3<T> n1, n2;
};

// What a contact carries from step to step, in the frame of the laboratory. The pointers are saved in the grains' frames.
template <class T> struct ContactHistory {
	Pointers<T> pointers;
	T twist; // phi
};

/* Of a grain against a plane: n2 is the plane's normal, towards the grain, and `anchor` [m] leads, in the plane, from the foot of the
 * grain's centre to the point of the plane that belongs to n1. */
template <class T> struct PlanePointers : Pointers<T> {
	Vec3<T> anchor;
};
template <class T> struct PlaneHistory {
	PlanePointers<T> pointers;
	T twist;
};

template <class T> struct ContactGeometry {
	Vec3<T> normal;    // n_c, from the centre of grain 2 to that of grain 1
	T inverseDistance; // of the centres; 0: of a grain and a plane
	T overlap;         // delta = r1 + r2 - distance
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

	ON_GPU static ContactForces none()
	{
		const Vec3<T> zero { T(0.), T(0.), T(0.) };
		return { T(0.), T(0.), zero, zero, zero, T(0.), zero, zero };
	}
	// Forces and displacements of no other springs than these; torques stay.
	ON_GPU void keepOnly(unsigned mechanisms)
	{
		if (!(mechanisms & Sliding)) sliding = slidingDisplacement = none().sliding;
		if (!(mechanisms & Rolling)) rollingDisplacement = none().rollingDisplacement;
	}
};

// What the ledger needs of a moment to book drag: the force along the normal, and the overlap along which it works.
template <class T> struct DragMoment {
	T force, overlap;
};

struct ContactMotion {
	Vec3<double> separation;   // x1 - x2 now
	Vec3<double> velocity;     // v1 - v2 through the step, of their images nearest to each other
	Vec3<double> spin1, spin2; // angular velocities through the step
	double dt;
	double inverseMass;                     // 1/m1 + 1/m2
	Vec3<double> imageVelocity { 0, 0, 0 }; // of it, what is not the grains' own but the motion of a periodic cell's boundaries
	double inverseInertia1 = 0, inverseInertia2 = 0; // 1/I of the grains
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

struct ContactStepResult {
	bool touching = false, pointersMoved = false;                             // moved by a slip, or new
	Vec3<double> force { 0, 0, 0 }, torque1 { 0, 0, 0 }, torque2 { 0, 0, 0 }; // kicks over dt; minus `force` on grain 2
	Vec3<double> forceBefore { 0, 0, 0 }, torqueBefore1 { 0, 0, 0 },
	        torqueBefore2 { 0, 0, 0 }; // of them, what belongs before this instant
	double workBefore = 0; // work of the part of the kicks that belongs before this instant: kinetic energy now minus half a step ago
	ContactGeometry<double> geometry {};
	ContactForces<double> now {}; // the forces at this instant
	StoredEnergy<double> stored { 0, 0, 0, 0 };
	Dissipation dissipated;

	// Of a contact that touched: whether it slipped or broke.
	ON_GPU bool isEvent() const { return pointersMoved || !touching || dissipated.twisting != 0; }
};

} // namespace contact_law
