// Kick and drift of grains one by one. A template over the pack type only so that each instruction set compiles its own.
#pragma once
#include "arrays.hpp"

namespace contact_law {

// v += F dt/m, w += T dt/I, x += v dt, forces to zero; the range grows by the velocities.
template <class Pack>
inline void integrateOneByOne(
        Grain* begin, Grain* end, const double* inverseMass, const double* inverseInertia, double dt, VelocityRange& range)
{
	VelocityRange met = range;
	for (Grain* g = begin; g < end; ++g, ++inverseMass, ++inverseInertia) {
		const double m = *inverseMass * dt, i = *inverseInertia * dt;
		const double* f = &g->fx;
		for (int k = 0; k < 3; ++k)
			met.kick[k] = std::max(met.kick[k], std::abs(f[k] * m));
		g->vx += g->fx * m, g->vy += g->fy * m, g->vz += g->fz * m;
		g->wx += g->tx * i, g->wy += g->ty * i, g->wz += g->tz * i;
		g->x += g->vx * dt, g->y += g->vy * dt, g->z += g->vz * dt;
		g->fx = g->fy = g->fz = g->tx = g->ty = g->tz = 0;
		const double* v = &g->vx;
		for (int k = 0; k < 3; ++k)
			met.least[k] = std::min(met.least[k], v[k]), met.most[k] = std::max(met.most[k], v[k]);
	}
	range = met;
}

} // namespace contact_law
