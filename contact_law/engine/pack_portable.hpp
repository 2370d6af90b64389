// One double as a pack: the engine on a machine without AVX2.
#pragma once
#include "../kernel/numbers.hpp"

namespace contact_law {
namespace portable {

	struct PackMask {
		bool is;
	};

	struct Pack {
		using Mask = PackMask;
		static constexpr int width = 1;
		double v;

		Pack() = default;
		Pack(double x)
		        : v(x)
		{
		}
		static Pack load(const double* p) { return *p; }
		void store(double* p) const { *p = v; }
	};

	inline Pack operator+(Pack a, Pack b) { return a.v + b.v; }
	inline Pack operator-(Pack a, Pack b) { return a.v - b.v; }
	inline Pack operator*(Pack a, Pack b) { return a.v * b.v; }
	inline Pack operator/(Pack a, Pack b) { return a.v / b.v; }
	inline Pack operator-(Pack a) { return -a.v; }

	inline PackMask operator<(Pack a, Pack b) { return { a.v < b.v }; }
	inline PackMask operator|(PackMask a, PackMask b) { return { a.is || b.is }; }
	inline unsigned bitsOf(PackMask m) { return m.is; }
	inline bool anyOf(PackMask m) { return m.is; }
	inline Pack choose(PackMask m, Pack yes, Pack no) { return m.is ? yes : no; }
	inline Pack absolute(Pack a) { return std::fabs(a.v); }
	inline Pack nearest(Pack a) { return contact_law::nearest(a.v); }
	inline Pack root(Pack x) { return std::sqrt(x.v); }
	inline Pack inverseRoot(Pack x) { return 1 / std::sqrt(x.v); }

}
} // namespace contact_law
