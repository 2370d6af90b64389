"""Numbers written as arithmetic, such as 10**0.5 or 2*pi/3: a small grammar, and nothing else.

Numbers, + - * / **, signs, parentheses, the constants pi and e, and sqrt, exp, log, log10, sin, cos, tan of one number.
"""

import ast
import math
import operator

LARGEST_EXPONENT = 1000
CONSTANTS = {"pi": math.pi, "e": math.e}
FUNCTIONS = {name: getattr(math, name) for name in ("sqrt", "exp", "log", "log10", "sin", "cos", "tan")}
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
SIGNS = {ast.UAdd: operator.pos, ast.USub: operator.neg}


class NotANumber(ValueError):
    """A text that is no arithmetic."""


def evaluate(text):
    """The finite number (int or float) that a text of this grammar stands for; raises NotANumber.

    Whole numbers stay whole under + - * and ** with a positive exponent.
    """
    try:
        number = _number(ast.parse(text.strip(), mode="eval").body)
        if math.isfinite(number):
            return number
    except (SyntaxError, ValueError, TypeError, ArithmeticError, MemoryError, RecursionError):
        pass
    raise NotANumber("not a finite number")


def _number(node):
    match node:
        case ast.Constant(value=value) if type(value) in (int, float):
            return value
        case ast.Name(id=name) if name in CONSTANTS:
            return CONSTANTS[name]
        case ast.UnaryOp(op=sign, operand=operand) if type(sign) in SIGNS:
            return SIGNS[type(sign)](_number(operand))
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            base, exponent = _number(left), _number(right)
            if abs(exponent) > LARGEST_EXPONENT:  # 9**9**9 would take long
                raise NotANumber
            return base**exponent  # complex for a root of a negative number: math.isfinite refuses it
        case ast.BinOp(left=left, op=operation, right=right) if type(operation) in OPERATORS:
            return OPERATORS[type(operation)](_number(left), _number(right))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
            return FUNCTIONS[name](_number(argument))
    raise NotANumber
