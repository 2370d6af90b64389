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
    """A text that is no arithmetic, or beyond the limits; the message says which, in a few words."""


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
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        number = node.value
    elif isinstance(node, ast.Name) and node.id in CONSTANTS:
        number = CONSTANTS[node.id]
    elif isinstance(node, ast.UnaryOp) and type(node.op) in SIGNS:
        number = SIGNS[type(node.op)](_number(node.operand, depth - 1))
    elif isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        number = OPERATORS[type(node.op)](_number(node.left, depth - 1), _number(node.right, depth - 1))
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
        number = _power(_number(node.left, depth - 1), _number(node.right, depth - 1))
    elif _is_function(node):
        number = FUNCTIONS[node.func.id](_number(node.args[0], depth - 1))
    else:
        raise NotANumber("not a finite number")
    if isinstance(number, int) and number.bit_length() > LARGEST_WHOLE:
        raise NotANumber(f"a whole number of more than {LARGEST_WHOLE} bits")
    return number


def _is_function(node):
    return (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id in FUNCTIONS
        and len(node.args) == 1
        and not node.keywords
    )


def _power(base, exponent):
    """base**exponent, refused before it is computed where it would take long."""
    if abs(exponent) > LARGEST_EXPONENT:
        raise NotANumber(f"an exponent above {LARGEST_EXPONENT}")
    if isinstance(base, int) and isinstance(exponent, int) and base.bit_length() * exponent > 2 * LARGEST_WHOLE:
        raise NotANumber(f"a whole number of more than {LARGEST_WHOLE} bits")
    return base**exponent  # complex for a root of a negative number: math.isfinite refuses it
