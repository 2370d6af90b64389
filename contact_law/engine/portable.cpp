// The engine's passes for any machine, where a pack is one double; and which instruction set a run takes.
#include "dynamics.hpp"
#include "pass_access.hpp"
#include <stdexcept>

namespace contact_law {
namespace portable {

	// ---- the pack, with what the kernel needs of a number type (kernel/numbers.hpp) ----

	struct PackMask {
		bool is;
	};

	struct Pack {
		using Mask = PackMask;
		static constexpr int width = 1;
		double v;

		Pack() = default;
		Pack(double x) { v = x; }
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

	// ---- grains ----

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
}
}

#include "force_pass.hpp"

namespace contact_law {

InstructionSet portablePasses() { return allPasses<portable::Pack>("portable", &integrateOneByOne<portable::Pack>); }

// Each compiled for its instruction set as a whole: to be called only on a machine that has it. Nor may these files define anything that
// the linker might take for all of the plugin, such as functions of std::vector.
InstructionSet avx512Passes();
InstructionSet avx2Passes();

const InstructionSet& instructionSet(const std::string& name)
{
	static const std::vector<InstructionSet> here = [] {
		std::vector<InstructionSet> found;
#ifdef __x86_64__
		const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd")
		        && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
		if (avx512) found.push_back(avx512Passes());
		if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) found.push_back(avx2Passes());
#endif
		found.push_back(portablePasses());
		return found;
	}();
	std::string names;
	for (const InstructionSet& set : here) {
		if (name.empty() || name == set.name) return set;
		names += std::string(", '") + set.name + "'";
	}
	throw std::invalid_argument("instructions = '" + name + "': must be here '' (the best)" + names);
}

} // namespace contact_law
