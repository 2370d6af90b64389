// The engine's passes with AVX2.
#include "pack_avx2.hpp"
#include "arrays.hpp"
#include "scalar_grains.hpp"

namespace contact_law {
namespace avx2 {

	static inline void transpose(__m256d r[4])
	{
		const __m256d a = _mm256_unpacklo_pd(r[0], r[1]), b = _mm256_unpackhi_pd(r[0], r[1]);
		const __m256d c = _mm256_unpacklo_pd(r[2], r[3]), d = _mm256_unpackhi_pd(r[2], r[3]);
		r[0] = _mm256_permute2f128_pd(a, c, 0x20);
		r[1] = _mm256_permute2f128_pd(b, d, 0x20);
		r[2] = _mm256_permute2f128_pd(a, c, 0x31);
		r[3] = _mm256_permute2f128_pd(b, d, 0x31);
	}

	static inline void gather(const Grain* grains, const int* index, Pack out[9])
	{
		for (int half = 0; half < 2; ++half) {
			__m256d r[4];
			for (int lane = 0; lane < 4; ++lane)
				r[lane] = _mm256_load_pd(&grains[index[lane]].x + 4 * half);
			transpose(r);
			for (int k = 0; k < 4; ++k)
				out[4 * half + k] = r[k];
		}
		out[8] = _mm256_set_pd(grains[index[3]].wz, grains[index[2]].wz, grains[index[1]].wz, grains[index[0]].wz);
	}

	static inline void scatterAdd(Grain* grains, const int* index, const Pack values[6])
	{
		__m256d low[4] = { _mm256_setzero_pd(), _mm256_setzero_pd(), values[0].v, values[1].v };
		__m256d high[4] = { values[2].v, values[3].v, values[4].v, values[5].v };
		transpose(low);
		transpose(high);
		for (int lane = 0; lane < 4; ++lane) {
			double* line = &grains[index[lane]].wz;
			_mm256_store_pd(line, _mm256_add_pd(_mm256_load_pd(line), low[lane]));
			_mm256_store_pd(line + 4, _mm256_add_pd(_mm256_load_pd(line + 4), high[lane]));
		}
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
InstructionSet avx2Passes()
{
	return NeighbourPasses<avx2::Pack>::addTo(
	        BondPasses<avx2::Pack>::addTo(EnergyPasses<avx2::Pack>::addTo(Passes<avx2::Pack>::all("avx2", &avx2::integrate))));
}
}
