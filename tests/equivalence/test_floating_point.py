"""The floating-point flags of the Makefile are in force in the plugin as it was built."""

import ctypes
import math

import pytest
from scenes import *


@pytest.mark.in_yade
def test_flags_are_in_force():
    library = ctypes.PyDLL(contact_law.LIBRARY)
    f, g = library.contact_law_sum_of_product, library.contact_law_reassociated
    f.restype, f.argtypes = ctypes.c_double, [ctypes.c_char_p] + 3 * [ctypes.c_double]
    g.restype, g.argtypes = ctypes.c_double, 2 * [ctypes.c_double]
    a, b = 1 + 2.0**-27, 1 - 2.0**-27  # a b = 1 - 2^-54, which rounds to 1
    for name in (b"", b"portable"):
        assert f(name, a, b, -1.0) == 0  # not contracted
    for name in (b"avx2", b"avx512"):
        value = f(name, a, b, -1.0)
        assert math.isnan(value) or value == -(2.0**-54)  # contracted, where the machine has it
    assert g(1e16, 1.0) == 0
    assert f(b"", 1e-200, 1e-120, 0.0) == 1e-200 * 1e-120 != 0  # denormal
