// The pass over contacts of grains and planes, for one pack type: included by each instruction set's file. Contacts are taken out of their
// row eight at a time, each number of the eight side by side, go through what planeStep() of the kernel does for contacts that stay, and are
// written back. Those that break, are pressed beyond the fit or have springs cut are left as they were.
#pragma once
#include "../kernel/limits.hpp"
#include "pass_access.hpp"

namespace contact_law {

template <class Pack> struct PlanePasses {
	using P = PassAccess<Pack>;
	static constexpr int width = Pack::width;

	struct alignas(64) Block {
		double normal[3][lanes], position[3][lanes], velocity[3][lanes]; // of the planes
		double n1[3][lanes], point[3][lanes], twist[lanes], constants[keptCount][lanes];
		double sliding[3][lanes], rolling[3][lanes], past[3][lanes], drag[lanes], overlap[lanes]; // of PlaneContact::before
		int grain[lanes];
	};

	static void put(const Vec3<double>& v, double (*to)[lanes], int k) { to[0][k] = v.x, to[1][k] = v.y, to[2][k] = v.z; }
	static void take(const double (*from)[lanes], int k, Vec3<double>& v) { v.x = from[0][k], v.y = from[1][k], v.z = from[2][k]; }

	static void put(const PlanePass& pass, const PlaneContact& c, Block& b, int k)
	{
		const PlaneInput& plane = pass.planes[c.plane];
		for (int axis = 0; axis < 3; ++axis)
			b.normal[axis][k] = axis == plane.axis ? c.side : 0;
		put(pass.positions[c.plane], b.position, k);
		put(plane.velocity, b.velocity, k);
		put(c.n1, b.n1, k), put(c.point, b.point, k);
		put(c.before.sliding, b.sliding, k), put(c.before.rolling, b.rolling, k), put(c.before.velocity, b.past, k);
		b.twist[k] = c.before.twist, b.drag[k] = c.before.drag, b.overlap[k] = c.before.overlap;
		b.grain[k] = c.grain;
		for (int n = 0; n < keptCount; ++n)
			b.constants[n][k] = c.constants.*keptConstants<double>[n];
	}
	static void take(const Block& b, int k, PlaneContact& c)
	{
		take(b.n1, k, c.n1), take(b.point, k, c.point);
		take(b.sliding, k, c.before.sliding), take(b.rolling, k, c.before.rolling), take(b.past, k, c.before.velocity);
		c.before.twist = b.twist[k], c.before.drag = b.drag[k], c.before.overlap = b.overlap[k];
	}

	// `width` contacts, of which those of `used` (bits) count. Returns which are left as they were.
	template <unsigned mechanisms>
	static unsigned sweep(const PlanePass& pass, Block& b, LaneForces& out, unsigned used, int at, DissipationOf<Pack>& lost)
	{
		const Pack none(0.), dt(pass.dt);
		const PairConstants<Pack> c = P::template fromKept<Pack>([&](int n) { return Pack::load(b.constants[n] + at); });
		Pack grain[9];
		gather(pass.grains, b.grain + at, grain);
		const Vec3<Pack> n = P::load(b.normal, at), spin { grain[6], grain[7], grain[8] };
		const Vec3<Pack> from = Vec3<Pack> { grain[0], grain[1], grain[2] } - P::load(b.position, at);
		const Vec3<Pack> velocity = Vec3<Pack> { grain[3], grain[4], grain[5] } - P::load(b.velocity, at);
		const Pack away = dot(from, n), old = Pack::load(b.twist + at);
		const Vec3<Pack> foot = from - away * n;
		const ContactGeometry<Pack> g { n, none, c.radius1 - away };
		PlaneHistory<Pack> h { { { turnedALittle(P::load(b.n1, at), dt * spin), n }, P::load(b.point, at) - foot }, old };
		if constexpr (bool(mechanisms & Twisting)) h.twist = h.twist + twisting::increment(n, none, velocity, spin, dt);
		Vec3<Pack> now = velocity;
		if constexpr (bool(mechanisms & Drag)) now = drag::velocityNow(velocity, P::load(b.past, at));
		ContactForces<Pack> f = contactForces<mechanisms>(c, g, h, now);

		const Pack inUnits = g.overlap * c.inverseEquilibriumOverlap;
		unsigned left = bitsOf((inUnits < Pack(-normal::pullOffRatio)) | (Pack(largestFittedOverlap) < inUnits));
		const unsigned slips = bitsOf(beyondLimits<mechanisms>(c, f, h)) & used & ~left;
		if (slips && pass.cut)
			left |= slips;
		else if (slips) {
			const Displacements<Pack> before { P::load(b.sliding, at), P::load(b.rolling, at), old };
			const Vec3<Pack> still { none, none, none };
			returnToLimits<mechanisms>(c, n, before, { still, spin, still, dt }, h, P::maskOf(slips), lost);
			const Pack normalForce = f.normalForce, drag = f.drag;
			f = ContactForces<Pack>::none();
			tangentialForces<mechanisms>(c, g, h, f);
			f.normalForce = normalForce, f.drag = drag;
			*pass.slips += __builtin_popcount(slips);
		}
		if constexpr (bool(mechanisms & Drag))
			bookDrag<Pack>({ Pack::load(b.drag + at), Pack::load(b.overlap + at) }, { f.drag, g.overlap },
			        P::maskOf(used & ~left), lost);
		P::store((f.normalForce + f.drag) * n + f.sliding, out.force, at);
		P::store(f.torque1, out.torque1, at);
		P::store(h.pointers.n1, b.n1, at), P::store(h.pointers.anchor + foot, b.point, at);
		P::store(f.slidingDisplacement, b.sliding, at), P::store(f.rollingDisplacement, b.rolling, at),
		        P::store(velocity, b.past, at);
		h.twist.store(b.twist + at), f.drag.store(b.drag + at), g.overlap.store(b.overlap + at);
		return left;
	}

	template <unsigned mechanisms> [[gnu::flatten]] static unsigned forces(const PlanePass& pass, LaneForces& out)
	{
		Block b;
		for (int k = 0; k < lanes; ++k) // behind the last one, that one again
			put(pass, pass.contacts[k < pass.count ? k : pass.count - 1], b, k);
		const unsigned used = (1u << pass.count) - 1;
		unsigned left = 0;
		DissipationOf<Pack> lost;
		for (int at = 0; at < pass.count; at += width)
			left |= sweep<mechanisms>(pass, b, out, used >> at, at, lost) << at;
		for (std::size_t k = 0; k < std::size(lostMembers<double>); ++k)
			pass.dissipated->*lostMembers<double>[k] += sumOf(lost.*lostMembers<Pack>[k]);
		for (int k = 0; k < pass.count; ++k)
			if (!(left >> k & 1)) take(b, k, pass.contacts[k]);
		return left & used;
	}
};

} // namespace contact_law
