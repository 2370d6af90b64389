"""The floating-point flags of the Makefile are in force in the plugin as it was built."""


def test_flags_are_in_force(yade):
    found = yade("""
import ctypes
library = ctypes.PyDLL(contact_law.LIBRARY)
f = library.contact_law_sum_of_product
f.restype, f.argtypes = ctypes.c_double, [ctypes.c_char_p] + 3 * [ctypes.c_double]
a, b = 1 + 2.0**-27, 1 - 2.0**-27  # a b = 1 - 2^-54, which rounds to 1
for name in ("", "portable", "avx2", "avx512"):
    value = f(name.encode(), a, b, -1.0)
    result[name] = None if math.isnan(value) else value
g = library.contact_law_reassociated
g.restype, g.argtypes = ctypes.c_double, 2 * [ctypes.c_double]
result["reassociated"] = g(1e16, 1.0)
library.contact_law_is_nan.argtypes = [ctypes.c_double]
result["nan"] = library.contact_law_is_nan(float("nan"))
result["denormal"] = f(b"", 1e-200, 1e-120, 0.0)
""")
    assert found[""] == 0 and found["portable"] == 0  # not contracted
    for name in ("avx2", "avx512"):
        assert found[name] in (None, -(2.0**-54))  # contracted
    assert found["reassociated"] == 0 and found["nan"] == 1
    assert found["denormal"] == 1e-200 * 1e-120 != 0
