"""Numbers written as arithmetic: what the grammar takes, and that nothing else is evaluated."""

import math
import time
from contextlib import nullcontext

import pytest

from yade_scripts.parameters.arithmetic import NotANumber, evaluate

UNDERSTOOD = {
    "3": 3, " 3.2e0 ": 3.2, "-2": -2, "+1.5e-3": 1.5e-3, "1_000": 1000, "2**60 + 1": 2**60 + 1, "2**-3": 0.125, "-2**2": -4,
    "10**0.5": 10**0.5, "10**(0.1*5)": 10 ** (0.1 * 5), "(1 + 2)*3/4 - 5": -2.75,
    "2*pi*sqrt(2)/e": 2 * math.pi * math.sqrt(2) / math.e, "exp(1) + log(2) + log10(3)": math.e + math.log(2) + math.log10(3),
    "sin(4) + cos(5) + tan(6)": math.sin(4) + math.cos(5) + math.tan(6),
}  # fmt: skip


@pytest.mark.parametrize("text", UNDERSTOOD)
def test_what_is_understood(text):
    found = evaluate(text)
    assert found == UNDERSTOOD[text] and type(found) is type(UNDERSTOOD[text])


REFUSED = [
    '__import__("os").system("id")', "().__class__.__base__.__subclasses__()", "(1).__class__", "pi.__class__", "sqrt.__self__",
    "open('/etc/passwd').read()", "eval('1')", "exec('x = 1')", "lambda: 1", "[x for x in (1, 2)]", "(x := 3)", "1 if 1 else 2",
    "'a' * 9", "b'a'", "f'{1}'", "1, 2", "[1]", "{1}", "x", "sqrt", "sqrt(4, 2)", "sqrt(x=4)", "log(8, 2)", "sqrt(*[4])", "factorial(9)",
    "1 < 2", "1 and 2", "not 1", "~1", "7 // 2", "7 % 2", "1 << 40", "3 | 4", "1 @ 2", "True", "None", "...", "1j", "import os", "x = 1",
    "1; 2", "", "1 +", "((", "\x00", "1/0", "0**-1", "(-8)**0.5", "sqrt(-1)", "log(0)", "exp(1000)", "1e999", "1e308*10", "nan", "inf",
]  # fmt: skip


@pytest.mark.parametrize("text", REFUSED)
def test_what_is_refused(text):
    with pytest.raises(NotANumber, match="^not a finite number$"):
        evaluate(text)


LIMITS = {
    "an exponent above 1000": ("9**9**9**9", "2**1e9", "0.5**-5000"),
    "a whole number of more than 1024 bits": ("(9**99)**99", "9**300*9**300", "9**325"),
    "longer than 200 characters": ("9" * 201,),
    "more than 50 operations within each other": ("1+" * 99 + "1", "-" * 120 + "1"),
    None: ("9" * 190 + "*" + "9" * 9, "(" * 99 + "1" + ")" * 99),
}


@pytest.mark.parametrize("reason", LIMITS)
def test_limits_are_told_at_once(reason):
    start = time.process_time()
    for text in LIMITS[reason]:
        with pytest.raises(NotANumber, match=f"^{reason}$") if reason else nullcontext():
            evaluate(text)
    assert time.process_time() - start < 1
