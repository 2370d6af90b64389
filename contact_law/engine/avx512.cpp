// The engine's passes with AVX-512: a pack is eight doubles in a register.
#include "pass_access.hpp"
#include <immintrin.h>

namespace contact_law {
namespace avx512 {

	// ---- the pack, with what the kernel needs of a number type (kernel/numbers.hpp) ----

	struct PackMask {
		__mmask8 bits;
	};

	struct Pack {
		using Mask = PackMask;
		static constexpr int width = 8;
		__m512d v;

		Pack() = default;
		Pack(__m512d x) { v = x; }
		Pack(double x) { v = _mm512_set1_pd(x); }
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

	// ---- grains ----

	// Rows of eight doubles, one a grain, to one register a column.
	static inline void transpose(__m512d r[8])
	{
		__m512d a[8], b[8];
		for (int k = 0; k < 8; k += 2) {
			a[k] = _mm512_unpacklo_pd(r[k], r[k + 1]);
			a[k + 1] = _mm512_unpackhi_pd(r[k], r[k + 1]);
		}
		for (int k = 0; k < 2; ++k) { // pairs of rows: 0-3 and 4-7
			const __m512d* p = a + 4 * k;
			b[4 * k] = _mm512_shuffle_f64x2(p[0], p[2], 0x88);
			b[4 * k + 1] = _mm512_shuffle_f64x2(p[1], p[3], 0x88);
			b[4 * k + 2] = _mm512_shuffle_f64x2(p[0], p[2], 0xdd);
			b[4 * k + 3] = _mm512_shuffle_f64x2(p[1], p[3], 0xdd);
		}
		for (int k = 0; k < 4; ++k) {
			r[k] = _mm512_shuffle_f64x2(b[k], b[4 + k], 0x88);
			r[4 + k] = _mm512_shuffle_f64x2(b[k], b[4 + k], 0xdd);
		}
		// columns come out as 0 1 2 3 | 4 5 6 7 with lanes in the order of rows
	}

	static inline void gather(const Grain* grains, const int* index, Pack out[9])
	{
		__m512d r[8];
		for (int lane = 0; lane < 8; ++lane)
			r[lane] = _mm512_load_pd(&grains[index[lane]].x);
		transpose(r);
		for (int k = 0; k < 8; ++k)
			out[k] = r[k];
		const __m256i rows = _mm256_slli_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(index)), 4);
		out[8] = _mm512_i32gather_pd(rows, &grains[0].wz, 8);
	}

	// Rows that are added to a grain's second line, from what is to be added to eight grains' force and torque.
	static inline void asRows(const Pack values[6], __m512d r[8])
	{
		r[0] = r[1] = _mm512_setzero_pd();
		for (int k = 0; k < 6; ++k)
			r[2 + k] = values[k].v;
		transpose(r);
	}

	static inline void scatterAdd(Grain* grains, const int* index, const Pack values[6])
	{
		__m512d r[8];
		asRows(values, r);
		for (int lane = 0; lane < 8; ++lane) {
			double* line = &grains[index[lane]].wz;
			_mm512_store_pd(line, _mm512_add_pd(_mm512_load_pd(line), r[lane]));
		}
	}

	/* The same where equal grains follow each other: their sum stays in a register, where one addition would wait for the store of
	 * the one before. In lists that are not quite in order they need not follow each other. */
	static inline void scatterAddInOrder(Grain* grains, const int* index, const Pack values[6])
	{
		const __m256i to = _mm256_load_si256(reinterpret_cast<const __m256i*>(index));
		const __m256i one = _mm256_permutevar8x32_epi32(to, _mm256_set_epi32(6, 5, 4, 3, 2, 1, 0, 0)),
		              earlier = _mm256_conflict_epi32(to);
		const unsigned asBefore = _mm256_cmpeq_epi32_mask(to, one) & 0xfe;
		if (__builtin_expect(_mm256_test_epi32_mask(earlier, earlier) != asBefore, 0)) return scatterAdd(grains, index, values);
		__m512d r[8], was[8];
		asRows(values, r);
		for (int lane = 0; lane < 8; ++lane)
			was[lane] = _mm512_load_pd(&grains[index[lane]].wz);
		__m512d sum;
		for (int lane = 0; lane < 8; ++lane) {
			const __mmask8 goesOn = -(asBefore >> lane & 1);
			sum = _mm512_add_pd(lane ? _mm512_mask_mov_pd(was[lane], goesOn, sum) : was[lane], r[lane]);
			_mm512_store_pd(&grains[index[lane]].wz, sum);
		}
	}

	static void integrate(
	        Grain* begin, Grain* end, const double* inverseMass, const double* inverseInertia, double dt, VelocityRange& range)
	{
		const __m512i toVelocity =
		        _mm512_set_epi64(6, 5, 4, 3, 2, 0, 0, 0); // line 2 is wz, -, f, t; velocities and wx, wy stand at 3 .. 7 of line 1
		const __m512i underPositions = _mm512_set_epi64(0, 0, 0, 0, 0, 5, 4, 3); // where velocities go
		const __m512d step = _mm512_set1_pd(dt);
		const auto wide = [](const double* four) { return _mm512_castpd256_pd512(_mm256_load_pd(four)); };
		__m512d least = wide(range.least), most = wide(range.most), kicked = _mm512_setzero_pd();
		for (Grain* g = begin; g < end; ++g, ++inverseMass, ++inverseInertia) {
			const __m512d second = _mm512_load_pd(&g->wz);
			const __m512d m = _mm512_set1_pd(*inverseMass * dt), i = _mm512_set1_pd(*inverseInertia * dt);
			__m512d first = _mm512_load_pd(&g->x);
			const __m512d kick = _mm512_mul_pd(_mm512_permutexvar_pd(toVelocity, second), _mm512_mask_blend_pd(0xc0, m, i));
			kicked = _mm512_max_pd(kicked, _mm512_abs_pd(kick));
			first = _mm512_mask_add_pd(first, 0xf8, first, kick);
			const __m512d moved = _mm512_maskz_permutexvar_pd(0x07, underPositions, first);
			first = _mm512_mask3_fmadd_pd(moved, step, first, 0x07);
			_mm512_store_pd(&g->x, first);
			// wz += tz dt/I, and forces to zero
			const __m512d wz = _mm512_fmadd_pd(_mm512_permutexvar_pd(_mm512_set1_epi64(7), second), i, second);
			_mm512_store_pd(&g->wz, _mm512_maskz_mov_pd(0x01, wz));
			least = _mm512_min_pd(least, moved);
			most = _mm512_max_pd(most, moved);
		}
		kicked = _mm512_maskz_permutexvar_pd(0x07, underPositions, kicked);
		_mm256_store_pd(range.kick, _mm256_max_pd(_mm512_castpd512_pd256(kicked), _mm256_load_pd(range.kick)));
		_mm256_store_pd(range.least, _mm512_castpd512_pd256(least));
		_mm256_store_pd(range.most, _mm512_castpd512_pd256(most));
	}
}
}

#include "force_pass.hpp"

namespace contact_law {
InstructionSet avx512Passes() { return allPasses<avx512::Pack>("avx512", &avx512::integrate); }
}
