"""Formulas of `function` terms: Lumen's expressions over real numbers.

`x` and the names of variables are numbers, `/` is a division of reals, and a comparison counts as 1 or 0. A formula has
no value (NaN) if one of its parts has no value or an infinite one, as after a division by zero or a square root of -1.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache, reduce
from operator import add, and_, eq, ge, gt, le, lt, mul, ne, neg, sub, truediv
from typing import Any

from lumen.expressions import ExpressionNode, parse_expression
from lumen.expressions.tree import Binary, Conditional, FunctionCall, Identifier, Literal, Logic, Unary
from lumen.fuzzy.arithmetic import NUMBERS, Arithmetic, Number

Formula = Callable[[Number, Sequence[Number]], Number]
"""Returns the value of a formula at x, given the values of the named variables."""

FormulaPart = Callable[[Number, Sequence[Number]], Any]

FORMULA_FUNCTIONS: Mapping[str, int] = {
    **dict.fromkeys(("abs", "sqrt", "exp", "log", "log10", "log1p", "floor", "ceil", "round", "sin", "cos", "tan"), 1),
    **dict.fromkeys(("asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh"), 1),
    **dict.fromkeys(("min", "max", "pow", "atan2", "fmod"), 2),
}
"""The functions of formulas and the number of arguments of each."""

_NUMPY = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "asinh": "arcsinh", "acosh": "arccosh",
          "atanh": "arctanh", "atan2": "arctan2", "pow": "float_power", "min": "minimum", "max": "maximum"}  # fmt: skip
_MATH: Mapping[str, Callable[..., float]] = {"abs": abs, "min": min, "max": max, "round": round}
_COMPARE: Mapping[str, Callable[[Any, Any], Any]] = {"<": lt, "<=": le, "==": eq, "!=": ne, ">": gt, ">=": ge}
_ARITHMETIC: Mapping[str, Callable[[Any, Any], Any]] = {"+": add, "-": sub, "*": mul, "/": truediv}


def formula(m: Arithmetic, text: str, names: Sequence[str]) -> Formula:
    """Return the compiled formula; `names` is the order of the variables.

    Raises ExpressionError for an invalid formula.
    """
    part = _Compiler(m, names).part(parse_expression(text))
    return _on_numbers(part) if m is NUMBERS else _on_arrays(part)


def _on_numbers(part: FormulaPart) -> Formula:
    def value(x: float, values: Sequence[float]) -> float:
        try:
            found = float(part(x, values))
        except (ArithmeticError, ValueError, TypeError):  # such as a power of a negative number, which is complex
            return math.nan
        return found if math.isfinite(found) else math.nan

    return value


@cache
def _finite() -> Callable[[Any], Any]:
    import numpy as np

    return lambda value: np.where(np.isfinite(value), value, np.nan)


def _on_arrays(part: FormulaPart) -> Formula:
    import numpy as np

    def value(x: Any, values: Sequence[Any]) -> Any:
        with np.errstate(all="ignore"):
            return _finite()(np.broadcast_to(part(x, values), np.shape(x)) + 0.0)

    return value


class _Compiler:
    """Compiles the tree of a checked formula to functions: lazy ones for numbers, eager ones for whole arrays."""

    def __init__(self, m: Arithmetic, names: Sequence[str]) -> None:
        self._m, self._names = m, {name: i for i, name in enumerate(names)}
        self._lazy = m is NUMBERS

    def part(self, node: ExpressionNode) -> FormulaPart:
        match node:
            case Literal(value):
                number = float(value)  # type: ignore[arg-type]
                return lambda x, values: number
            case Identifier(name):
                return self._name(name)
            case Unary(sign, operand):
                negated: Callable[[Any], Any] = neg if sign == "-" else lambda a: self._degree(a == 0.0, a)
                return self._apply(negated, operand)
            case Binary(sign, left, right) if sign in _COMPARE:
                compare = _COMPARE[sign]
                return self._apply(lambda a, b: self._degree(compare(a, b), a, b), left, right)
            case Binary(sign, left, right):
                return self._apply(self._function("fmod") if sign == "%" else _ARITHMETIC[sign], left, right)
            case Logic(sign, operands):
                return self._logic(sign, [self.part(operand) for operand in operands])
            case Conditional(condition, then, otherwise):
                return self._choice(self.part(condition), self.part(then), self.part(otherwise))
            case FunctionCall(name, arguments):
                return self._apply(self._function(name), *arguments)
        raise AssertionError(f"not allowed in a formula: {node}")

    def _name(self, name: str) -> FormulaPart:
        if name in self._names:
            i = self._names[name]
            return lambda x, values: values[i]
        return (lambda x, values: x) if name == "x" else (lambda x, values: math.pi)

    def _apply(self, work: Callable[..., Any], *nodes: ExpressionNode) -> FormulaPart:
        parts = [self.part(node) for node in nodes]
        if self._lazy:
            return lambda x, values: work(*[part(x, values) for part in parts])
        finite = _finite()
        return lambda x, values: finite(work(*[part(x, values) for part in parts]))

    def _function(self, name: str) -> Callable[..., Any]:
        if self._lazy:
            return _MATH.get(name) or getattr(math, name)
        import numpy as np

        return getattr(np, _NUMPY.get(name, name))  # type: ignore[no-any-return]

    def _degree(self, holds: Any, *compared: Any) -> Any:
        """Return 1 or 0; NaN if one of the compared values is NaN."""
        known = reduce(and_, [a == a for a in compared])
        return self._m.where(known, self._m.where(holds, 1.0, 0.0), math.nan)

    def _logic(self, sign: str, parts: list[FormulaPart]) -> FormulaPart:
        if self._lazy:
            join = all if sign == "&&" else any
            return lambda x, values: float(join(part(x, values) != 0.0 for part in parts))
        end = 0.0 if sign == "&&" else 1.0

        def value(x: Any, values: Sequence[Any]) -> Any:
            """Return the same as a lazy evaluation from the left: parts after the deciding one have no influence."""
            found = parts[-1](x, values)
            found = self._degree(found != 0.0, found)
            for part in reversed(parts[:-1]):
                left = part(x, values)
                left = self._degree(left != 0.0, left)
                found = self._m.where((left == end) | (left != left), left, found)
            return found

        return value

    def _choice(self, condition: FormulaPart, then: FormulaPart, otherwise: FormulaPart) -> FormulaPart:
        if self._lazy:
            return lambda x, values: then(x, values) if condition(x, values) != 0.0 else otherwise(x, values)

        def value(x: Any, values: Sequence[Any]) -> Any:
            asked = condition(x, values)
            chosen = self._m.where(asked != 0.0, then(x, values), otherwise(x, values))
            return self._m.where(asked == asked, chosen, math.nan)

        return value
