// Eight doubles in an AVX-512 register, with what the kernel needs of a number type (kernel/numbers.hpp).
#pragma once
#include <immintrin.h>

namespace contact_law {
namespace avx512 {

	struct PackMask {
		__mmask8 bits;
	};

	struct Pack {
		using Mask = PackMask;
		static constexpr int width = 8;
		__m512d v;

		Pack() = default;
		Pack(__m512d x)
		        : v(x)
		{
		}
		Pack(double x)
		        : v(_mm512_set1_pd(x))
		{
		}
		static Pack load(const double* p) { return _mm512_load_pd(p); }
		void store(double* p) const { _mm512_store_pd(p, v); }
	};

	inline Pack operator+(Pack a, Pack b) { return _mm512_add_pd(a.v, b.v); }
	inline Pack operator-(Pack a, Pack b) { return _mm512_sub_pd(a.v, b.v); }
	inline Pack operator*(Pack a, Pack b) { return _mm512_mul_pd(a.v, b.v); }
	inline Pack operator/(Pack a, Pack b) { return _mm512_div_pd(a.v, b.v); }
	inline Pack operator-(Pack a) { return _mm512_sub_pd(_mm512_setzero_pd(), a.v); }

	inline PackMask operator<(Pack a, Pack b) { return { _mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ) }; }
	inline PackMask operator|(PackMask a, PackMask b) { return { __mmask8(a.bits | b.bits) }; }
	inline unsigned bitsOf(PackMask m) { return m.bits; }
	inline bool anyOf(PackMask m) { return m.bits != 0; }
	inline Pack choose(PackMask m, Pack yes, Pack no) { return _mm512_mask_blend_pd(m.bits, no.v, yes.v); }
	inline Pack absolute(Pack a) { return _mm512_abs_pd(a.v); }
	inline Pack nearest(Pack a) { return _mm512_roundscale_pd(a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }

	// 14 bits from the table, doubled twice by Newton's method: faster here than a square root and a division.
	inline Pack inverseRoot(Pack x)
	{
		Pack r = _mm512_rsqrt14_pd(x.v);
		const Pack half = Pack(0.5) * x;
		r = r + r * (Pack(0.5) - half * r * r);
		return r + r * (Pack(0.5) - half * r * r);
	}
	inline Pack root(Pack x) { return choose(Pack(1e-300) < x, x * inverseRoot(x), Pack(0.)); }

}
} // namespace contact_law
