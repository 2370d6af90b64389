// What the compiler's flags make of floating-point arithmetic (tests/equivalence/test_floating_point.py).
#include "../engine/dynamics.hpp"
#include <limits>

extern "C" {

// a b + c as the functors compute it, or (set = "avx512", "avx2", "portable") as the engine's passes do; not a number where the machine lacks the set.
double contact_law_sum_of_product(const char* set, double a, double b, double c)
{
	if (!*set) return a * b + c;
	try {
		return contact_law::instructionSet(set).sumOfProduct(a, b, c);
	} catch (const std::exception&) {
		return std::numeric_limits<double>::quiet_NaN();
	}
}

// (a + b) - a, which -ffast-math would make b
double contact_law_reassociated(double a, double b) { return (a + b) - a; }

int contact_law_is_nan(double a) { return a != a; }
}
