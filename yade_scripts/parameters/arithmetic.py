"""Numbers written as arithmetic, such as 10**0.5 or 2*pi/3: a small grammar with limits, and nothing else.

Numbers, + - * / **, signs, parentheses, the constants pi and e, and sqrt, exp, log, log10, sin, cos, tan of one number.
"""

import ast
import math
import operator

LONGEST = 200  # characters
DEEPEST = 50  # operations within each other
LARGEST_EXPONENT = 1000
LARGEST_WHOLE = 1024  # bits

CONSTANTS = {"pi": math.pi, "e": math.e}
FUNCTIONS = {name: getattr(math, name) for name in ("sqrt", "exp", "log", "log10", "sin", "cos", "tan")}
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
SIGNS = {ast.UAdd: operator.pos, ast.USub: operator.neg}


class NotANumber(ValueError):
    """A text that is no arithmetic, or beyond the limits; with the reason in a few words."""


def evaluate(text):
    """The finite number (int or float) that a text of this grammar stands for; raises NotANumber.

    Whole numbers stay whole under + - * and ** with a positive exponent.
    """
    if len(text) > LONGEST:
        raise NotANumber(f"longer than {LONGEST} characters")
    try:
        number = _number(ast.parse(text.strip(), mode="eval").body, DEEPEST)
        finite = math.isfinite(number)
    except NotANumber:
        raise
    except (SyntaxError, ValueError, TypeError, ArithmeticError, MemoryError, RecursionError):
        finite = False
    if not finite:
        raise NotANumber("not a finite number")
    return number


def _number(node, depth):
    if depth == 0:
        raise NotANumber(f"more than {DEEPEST} operations within each other")
    inner = lambda child: _number(child, depth - 1)
    match node:
        case ast.Constant(value=value) if type(value) in (int, float):
            number = value
        case ast.Name(id=name) if name in CONSTANTS:
            number = CONSTANTS[name]
        case ast.UnaryOp(op=sign, operand=operand) if type(sign) in SIGNS:
            number = SIGNS[type(sign)](inner(operand))
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            number = _power(inner(left), inner(right))
        case ast.BinOp(left=left, op=operation, right=right) if type(operation) in OPERATORS:
            number = OPERATORS[type(operation)](inner(left), inner(right))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
            number = FUNCTIONS[name](inner(argument))
        case _:
            raise NotANumber("not a finite number")
    if isinstance(number, int) and number.bit_length() > LARGEST_WHOLE:
        raise NotANumber(f"a whole number of more than {LARGEST_WHOLE} bits")
    return number


def _power(base, exponent):
    """base**exponent, refused before it is computed where it would take long."""
    if abs(exponent) > LARGEST_EXPONENT:
        raise NotANumber(f"an exponent above {LARGEST_EXPONENT}")
    if isinstance(base, int) and isinstance(exponent, int) and base.bit_length() * exponent > 2 * LARGEST_WHOLE:
        raise NotANumber(f"a whole number of more than {LARGEST_WHOLE} bits")
    return base**exponent  # complex for a root of a negative number: math.isfinite refuses it
