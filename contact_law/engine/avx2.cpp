// The engine's passes with AVX2: a pack is four doubles in a register.
#include "pass_access.hpp"
#include <immintrin.h>

namespace contact_law {
namespace avx2 {

	// ---- the pack, with what the kernel needs of a number type (kernel/numbers.hpp) ----

	struct PackMask {
		__m256d lanes;
	};

	struct Pack {
		using Mask = PackMask;
		static constexpr int width = 4;
		__m256d v;

		Pack() = default;
		Pack(__m256d x) { v = x; }
		Pack(double x) { v = _mm256_set1_pd(x); }
		static Pack load(const double* p) { return _mm256_load_pd(p); }
		void store(double* p) const { _mm256_store_pd(p, v); }
	};

	inline Pack operator+(Pack a, Pack b) { return _mm256_add_pd(a.v, b.v); }
	inline Pack operator-(Pack a, Pack b) { return _mm256_sub_pd(a.v, b.v); }
	inline Pack operator*(Pack a, Pack b) { return _mm256_mul_pd(a.v, b.v); }
	inline Pack operator/(Pack a, Pack b) { return _mm256_div_pd(a.v, b.v); }
	inline Pack operator-(Pack a) { return _mm256_sub_pd(_mm256_setzero_pd(), a.v); }

	inline PackMask operator<(Pack a, Pack b) { return { _mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ) }; }
	inline PackMask operator|(PackMask a, PackMask b) { return { _mm256_or_pd(a.lanes, b.lanes) }; }
	inline unsigned bitsOf(PackMask m) { return unsigned(_mm256_movemask_pd(m.lanes)); }
	inline bool anyOf(PackMask m) { return bitsOf(m) != 0; }
	inline Pack choose(PackMask m, Pack yes, Pack no) { return _mm256_blendv_pd(no.v, yes.v, m.lanes); }
	inline Pack absolute(Pack a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.), a.v); }
	inline Pack nearest(Pack a) { return _mm256_round_pd(a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }
	inline Pack root(Pack x) { return _mm256_sqrt_pd(x.v); }
	inline Pack inverseRoot(Pack x) { return Pack(1.) / root(x); }

	// ---- grains ----

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
}
}

#include "force_pass.hpp"

namespace contact_law {
InstructionSet avx2Passes() { return allPasses<avx2::Pack>("avx2", &integrateOneByOne<avx2::Pack>); }
}
