// Four doubles in an AVX2 register, with what the kernel needs of a number type (kernel/numbers.hpp).
#pragma once
#include <immintrin.h>

namespace contact_law {
namespace avx2 {

	struct PackMask {
		__m256d lanes;
	};

	struct Pack {
		using Mask = PackMask;
		static constexpr int width = 4;
		__m256d v;

		Pack() = default;
		Pack(__m256d x)
		        : v(x)
		{
		}
		Pack(double x)
		        : v(_mm256_set1_pd(x))
		{
		}
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

}
} // namespace contact_law
