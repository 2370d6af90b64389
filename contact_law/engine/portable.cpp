// The engine's passes for any machine.
#include "pack_portable.hpp"
#include "arrays.hpp"
#include "scalar_grains.hpp"

namespace contact_law {
namespace portable {

	static inline void gather(const Grain* grains, const int* index, Pack out[9])
	{
		const Grain& g = grains[*index];
		out[0] = g.x, out[1] = g.y, out[2] = g.z, out[3] = g.vx, out[4] = g.vy, out[5] = g.vz, out[6] = g.wx, out[7] = g.wy,
		out[8] = g.wz;
	}

	static inline void scatterAdd(Grain* grains, const int* index, const Pack values[6])
	{
		Grain& g = grains[*index];
		g.fx += values[0].v, g.fy += values[1].v, g.fz += values[2].v, g.tx += values[3].v, g.ty += values[4].v,
		        g.tz += values[5].v;
	}

	static inline void scatterAddInOrder(Grain* grains, const int* index, const Pack values[6]) { scatterAdd(grains, index, values); }

	static void integrate(
	        Grain* begin, Grain* end, const double* inverseMass, const double* inverseInertia, double dt, VelocityRange& range)
	{
		integrateOneByOne<Pack>(begin, end, inverseMass, inverseInertia, dt, range);
	}
}
}

#include "bond_pass.hpp"
#include "energy_pass.hpp"
#include "force_pass.hpp"
#include "neighbour_search.hpp"

namespace contact_law {
InstructionSet portablePasses()
{
	return NeighbourPasses<portable::Pack>::addTo(BondPasses<portable::Pack>::addTo(
	        EnergyPasses<portable::Pack>::addTo(Passes<portable::Pack>::all("portable", &portable::integrate))));
}
}
