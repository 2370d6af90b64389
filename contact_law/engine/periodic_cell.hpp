// A rectangular periodic cell along the axes, of changing size: nearest images, and what its moving boundaries do to the grains' energy.
#pragma once
#include "../kernel/numbers.hpp"

namespace contact_law {

// Grains keep the positions that their motion gives them, in whatever copy of the cell; no contact keeps a shift.
struct PeriodicCell {
	bool on = false;
	Vec3<double> size { 0, 0, 0 }, inverse { 0, 0, 0 }; // now [m], [1/m]; zero in open space, where nothing is shifted
	Vec3<double> rate { 0, 0, 0 };                      // d(size)/dt through the last step [m/s]

	static PeriodicCell box(const Vec3<double>& size, const Vec3<double>& rate)
	{
		PeriodicCell cell;
		cell.on = true;
		cell.advance(size, rate);
		return cell;
	}
	void advance(const Vec3<double>& newSize, const Vec3<double>& newRate)
	{
		if (!on) return;
		size = newSize;
		inverse = { 1 / size.x, 1 / size.y, 1 / size.z };
		rate = newRate;
	}
	// Every pair's distance is that of its nearest images, and no grain meets two images of another, in cells of at least twice the
	// reach of a pair.
	bool holds(double reach) const
	{
		return size.x >= 2 * reach && size.y >= 2 * reach && size.z >= 2 * reach && std::isfinite(size.x + size.y + size.z);
	}
};

// The cell as a number type of the kernel needs it; an open scene's makes no shift.
template <class T> struct Images {
	Vec3<T> size, inverse, rate;
	explicit Images(const PeriodicCell& c)
	        : size(spread(c.size))
	        , inverse(spread(c.inverse))
	        , rate(spread(c.rate))
	{
	}

	static Vec3<T> spread(const Vec3<double>& v) { return { T(v.x), T(v.y), T(v.z) }; }
	static Vec3<T> times(const Vec3<T>& a, const Vec3<T>& b) { return { a.x * b.x, a.y * b.y, a.z * b.z }; }

	// Cells by which the first of two grains is to be shifted to be the nearest to the second; given: the first's position less the
	// second's.
	Vec3<T> shift(const Vec3<T>& separation) const
	{
		return { -nearest(separation.x * inverse.x), -nearest(separation.y * inverse.y), -nearest(separation.z * inverse.z) };
	}
	// What the shift adds to the separation, and to the relative velocity.
	Vec3<T> distance(const Vec3<T>& shift) const { return times(shift, size); }
	Vec3<T> velocity(const Vec3<T>& shift) const { return times(shift, rate); }
};

// For places that compute one pair in whatever scene.
struct Image {
	Vec3<double> shift { 0, 0, 0 }, velocity { 0, 0, 0 };
};
// Brings x1 - x2 to the nearest image.
inline Image nearestImage(const PeriodicCell& cell, Vec3<double>& separation)
{
	if (!cell.on) return {};
	const Images<double> images(cell);
	const Vec3<double> s = images.shift(separation);
	separation = separation + images.distance(s);
	return { s, images.velocity(s) };
}

/* What a domain's crossing contacts do against the moving boundaries. An impulse J on the first of two grains does the work J.(v1 - v2)
 * on them; the contact's springs see J.(v1 - v2 + shift rate). The rest is the boundaries'. As elsewhere in the ledger half of each
 * kick belongs before its instant, half after it. */
class BoundaryWork {
public:
	double done = 0;                // up to now, against the boundaries [J]
	Vec3<double> kicks { 0, 0, 0 }; // sum over the contacts now of shift times force
	Vec3<double> early { 0, 0, 0 }; // of it what belongs before this instant beyond the half

	void add(const Vec3<double>& shift, const Vec3<double>& kick) { kicks = kicks + Images<double>::times(shift, kick); }
	void addEarly(const Vec3<double>& shift, const Vec3<double>& kick, const Vec3<double>& before)
	{
		early = early + Images<double>::times(shift, before - 0.5 * kick);
	}
	// The cell has come to a new instant: what is left of the kicks before it.
	void arrive(const PeriodicCell& cell, double dt)
	{
		done += dt * dot(cell.rate, 0.5 * kicks - early);
		kicks = early = { 0, 0, 0 };
	}
	// All contacts of this instant have been added.
	void complete(const PeriodicCell& cell, double dt) { done += dt * dot(cell.rate, 0.5 * kicks + early); }
};

} // namespace contact_law
