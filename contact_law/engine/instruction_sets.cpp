#include "dynamics.hpp"
#include <stdexcept>

namespace contact_law {

InstructionSet avx512Passes();
InstructionSet avx2Passes();
InstructionSet portablePasses();

const InstructionSet& instructionSet(const std::string& name)
{
	static const InstructionSet sets[] = { avx512Passes(), avx2Passes(), portablePasses() };
	const bool here[] = { __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq")
		        && __builtin_cpu_supports("avx512vl"),
		__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"), true };
	for (int k = 0; k < 3; ++k)
		if (here[k] && (name.empty() || name == sets[k].name)) return sets[k];
	throw std::invalid_argument("instructions = '" + name + "': must be here '' (the best), " + (here[0] ? "'avx512', " : "")
	        + (here[1] ? "'avx2', " : "") + "'portable'");
}

} // namespace contact_law
