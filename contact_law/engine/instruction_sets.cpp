#include "dynamics.hpp"
#include <stdexcept>

namespace contact_law {

// Each compiled for its instruction set as a whole: to be called only on a machine that has it. Nor may these files define anything that the
// linker might take for all of the plugin, such as functions of std::vector.
InstructionSet avx512Passes();
InstructionSet avx2Passes();
InstructionSet portablePasses();

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
