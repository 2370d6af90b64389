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
	SpringDamping = 16,
	Everything = AllSprings | Drag, // but for damped springs
	Damped = Everything | SpringDamping
};
constexpr int mechanismSets = Damped + 1; // combinations of mechanisms
/* The instances of a function template for all of them: for callers that know theirs at run time only. Of damped springs there is one, since
 * each costs minutes of compiling: all of them are there, and drag too (its coefficients may be 0). */
#define CONTACT_LAW_ALL_MECHANISMS(f)                                                                                                      \
	{                                                                                                                                  \
		f<0>, f<1>, f<2>, f<3>, f<4>, f<5>, f<6>, f<7>, f<8>, f<9>, f<10>, f<11>, f<12>, f<13>, f<14>, f<15>, nullptr, nullptr,    \
		        nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,        \
		        nullptr, f<Damped>                                                                                                 \
	}

constexpr unsigned mechanismsOf(bool sliding, bool rolling, bool twisting, bool drag, bool damped)
{
	if (damped) return Damped;
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

// What strains springs: dzeta/dt [m/s]; how fast grains turn against each other [rad/s], which rolls across the normal and twists along it.
template <class T> struct SpringRates {
	Vec3<T> sliding { T(0.), T(0.), T(0.) }, turning { T(0.), T(0.), T(0.) };
};
// Of damped springs: their rates through the step to this moment, and at it.
template <class T> struct DampingMoment {
	SpringRates<T> through, now;
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
	DampingMoment<double> damping {};
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
	SpringRates<double> slipped {}; // what slips took of the motion, where springs are damped
	DampingMoment<double> damping {};

	ON_GPU void addKicks(const Vec3<double>& f, const Vec3<double>& t1, const Vec3<double>& t2, double before) // of them, a fraction
	{
		force = force + f, torque1 = torque1 + t1, torque2 = torque2 + t2;
		forceBefore = forceBefore + before * f, torqueBefore1 = torqueBefore1 + before * t1,
		torqueBefore2 = torqueBefore2 + before * t2;
	}

	// Of a contact that touched: whether it slipped or broke.
	ON_GPU bool isEvent() const { return pointersMoved || !touching || dissipated.twisting != 0; }
};

} // namespace contact_law
