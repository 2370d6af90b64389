// Forces and torques that something else than contacts puts on grains (in YADE: O.forces), held constant until others are set.
#pragma once
#include "arrays.hpp"
#include <vector>

namespace contact_law {

struct OutsideForce {
	int grain;
	Vec3<double> force, torque; // N, N m

	friend bool operator==(const OutsideForce& a, const OutsideForce& b)
	{
		const auto same = [](const Vec3<double>& u, const Vec3<double>& v) { return u.x == v.x && u.y == v.y && u.z == v.z; };
		return a.grain == b.grain && same(a.force, b.force) && same(a.torque, b.torque);
	}
};

// On one domain's grains. Added as soon as a grain's contacts are complete, before blocked components are withheld.
class OutsideForces {
public:
	std::vector<OutsideForce> grains; // by rising index
	double work = 0;                  // minus what these forces did on the grains [J]

	void begin() { next = 0; } // a step's forces, of which grains will have all

	/* To grains below `end`, unless it has been done. A force that is the same before and after a step does its product with the way: by just that the
	 * leapfrog's kinetic energy grows (MODEL.md, "Outside forces"). */
	void add(Grain* all, double dt, int end)
	{
		double sum = work; // grain by grain, so that it doesn't depend on where `end` stood
		auto at = grains.begin() + next;
		for (; at != grains.end() && at->grain < end; ++at) {
			Grain& g = all[at->grain];
			sum -= dt * (dot(at->force, velocityOf(g)) + dot(at->torque, spinOf(g)));
			addToGrain(g, at->force, at->torque);
		}
		work = sum;
		next = at - grains.begin();
	}

private:
	std::size_t next = 0;
};

} // namespace contact_law
