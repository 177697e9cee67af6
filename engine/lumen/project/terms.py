"""Read the terms of a fuzzy variable, and check their kind, number of parameters, shape and formula."""

from collections.abc import Mapping, Sequence
from math import inf, isfinite
from typing import Any

from lumen.errors import ExpressionError
from lumen.expressions import parse_expression
from lumen.expressions.expression_findings import (
    EXPRESSION_SYNTAX,
    TYPE_MISMATCH,
    UNKNOWN_FUNCTION,
    UNKNOWN_NAME,
    WRONG_ARGUMENT_COUNT,
)
from lumen.expressions.tree import (
    Binary,
    Conditional,
    ExpressionNode,
    FunctionCall,
    Identifier,
    Literal,
    Logic,
    Unary,
    walk,
)
from lumen.fuzzy.formulas import FORMULA_FUNCTIONS
from lumen.language.controllers import TERM_PARAMETERS, Term
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.numbers import is_number
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import NOT_FINITE
from lumen.project.rule_parser import KEYWORDS
from lumen.project.word_places import report_word

_PLAIN = (Identifier, Unary, Logic, Conditional)


def check_formula(text: str, names: Sequence[str], report: DocumentReport, path: NodePath) -> bool:
    """Return True if the text at `path` is a formula of x and the variables called `names`; report its faults."""
    try:
        tree = parse_expression(text)
    except ExpressionError as error:
        report_word(report, EXPRESSION_SYNTAX, path, text, error.offset, 1, error.message, error.hint)
        return False
    found = [_sound(node, text, names, report, path) for node, _ in walk(tree)]
    return all(found)


def _sound(node: ExpressionNode, text: str, names: Sequence[str], report: DocumentReport, path: NodePath) -> bool:
    def refuse(code: Code, offset: int, length: int, message: str, hint: str) -> bool:
        report_word(report, code, path, text, offset, length, message, hint)
        return False

    match node:
        case Identifier(name) if name not in (*names, "x", "pi"):
            hint = did_you_mean(name, ("x", "pi", *names), "available:")
            return refuse(UNKNOWN_NAME, node.offset, len(name), f"a formula has no variable `{name}`", hint)
        case FunctionCall(name) if name not in FORMULA_FUNCTIONS:
            hint = did_you_mean(name, FORMULA_FUNCTIONS, "the functions are")
            return refuse(UNKNOWN_FUNCTION, node.named, len(name), f"a formula has no function `{name}`", hint)
        case FunctionCall(name, arguments) if len(arguments) != FORMULA_FUNCTIONS[name]:
            wanted = FORMULA_FUNCTIONS[name]
            message = f"`{name}` has {len(arguments)} argument{'s' * (len(arguments) != 1)}, but needs {wanted}"
            hint = f"write {name}({', '.join('ab'[:wanted])})"
            return refuse(WRONG_ARGUMENT_COUNT, node.named, len(name), message, hint)
        case Literal(value) if not is_number(value):
            length = node.end - node.offset
            return refuse(TYPE_MISMATCH, node.offset, length, "a formula can only contain numbers", "write a number")
        case Binary("in"):
            return refuse(TYPE_MISMATCH, node.offset, 1, "a formula can't contain lists", "compare with `==`")
        case FunctionCall() | Literal() | Binary():
            return True
    if not isinstance(node, _PLAIN):
        return refuse(TYPE_MISMATCH, node.offset, 1, "a formula can't contain lists or fields", "use numbers alone")
    return True


EMPTY_TERM = Code("empty-term", "controllers", ERROR, "a term covers nothing")
NO_SHAPE = Code("no-shape", "controllers", ERROR, "a term has no shape")
NOT_ASCENDING = Code("not-ascending", "controllers", ERROR, "the corners of a term are not in rising order")
NOT_POSITIVE = Code("not-positive", "controllers", ERROR, "the width of a term is not above 0")
RESERVED_NAME = Code(
    "reserved-name", "controllers", ERROR, "a variable or term has a name that rules use for something else"
)
TWO_SHAPES = Code("two-shapes", "controllers", ERROR, "a term has two shapes")
WRONG_PARAMETERS = Code("wrong-parameters", "controllers", ERROR, "a term has too few or too many numbers")


_POSITIVE: Mapping[str, tuple[int, ...]] = {
    "gaussian": (1,), "gaussian-product": (1, 3), "bell": (1,), "spike": (1,), "cosine": (1,),
}  # fmt: skip
_ASCENDING = ("triangle", "trapezoid", "pi-shape", "s-shape", "z-shape", "discrete")
_DIFFERENT = ("ramp", "arc", "semi-ellipse", "concave", "binary", "s-shape", "z-shape")
_INFINITE = ("triangle", "trapezoid", "binary", "rectangle")


def build_terms(
    data: Mapping[str, Any], report: DocumentReport, path: NodePath, inputs: int, names: Sequence[str] = ()
) -> dict[str, Term]:
    """Return the usable terms by name; the faults of the others are reported at the faulty number.

    `inputs` is the number of inputs of the controller, for each of which a `linear` term has a coefficient; `names` are
    the variables that a formula may use.
    """
    terms = (_Term(name, shape, report, (*path, name), inputs, names).build() for name, shape in data.items())
    return {term.name: term for term in terms if term}


def plain_name(name: str, report: DocumentReport, path: NodePath) -> None:
    """Report the name of a variable or term, at `path`, if it is a keyword in rules."""
    if name.lower() in KEYWORDS:
        report(RESERVED_NAME, path, f"`{name}` is a keyword in rules", hint="choose another name", key=True)


class _Term:
    """One term under construction."""

    def __init__(
        self,
        name: str,
        shape: Mapping[str, Any],
        report: DocumentReport,
        path: NodePath,
        inputs: int,
        names: Sequence[str],
    ) -> None:
        self.name, self.shape, self.report, self.path = name, shape, report, path
        self.inputs, self.names = inputs, names
        self.kinds = [kind for kind in shape if kind in TERM_PARAMETERS]

    def build(self) -> Term | None:
        plain_name(self.name, self.report, self.path)
        if len(self.kinds) != 1:
            self.shapeless()
            return None
        kind = self.kinds[0]
        if kind == "function":
            return self.function(self.shape[kind])
        parameters = _flat(self.shape[kind])
        if not (self.counted(kind, parameters) and self.sound(kind, parameters)):
            return None
        return Term(self.name, kind, parameters, float(self.shape.get("height", 1.0)), where=self.path)

    def function(self, text: str) -> Term | None:
        if not check_formula(text, self.names, self.report, (*self.path, "function")):
            return None
        return Term(self.name, "function", (), float(self.shape.get("height", 1.0)), text, self.path)

    def shapeless(self) -> None:
        if len(self.kinds) > 1:
            message = f"`{self.name}` is a `{self.kinds[0]}` and a `{self.kinds[1]}`: a term can have only one shape"
            self.report(TWO_SHAPES, (*self.path, self.kinds[1]), message, hint="split it into two terms", key=True)
        elif not any(pruned[: len(self.path)] == self.path for pruned in self.report.pruned):
            hint = "write, for example, `gaussian: [0, 80]`"
            self.report(NO_SHAPE, self.path, f"`{self.name}` has no shape", hint=hint, key=True)

    def counted(self, kind: str, parameters: tuple[float, ...]) -> bool:
        names, count = TERM_PARAMETERS[kind], len(parameters)
        if kind == "discrete":
            right, wanted = count >= 2, "at least one point [x, membership]"
        elif kind == "linear":
            right = count in (self.inputs, self.inputs + 1)
            wanted = f"{self.inputs} coefficients, one for each input, and optionally a constant"
        else:
            right, wanted = count == len(names), f"{len(names)} ({', '.join(names)})"
        if not right and not self.report.broken((*self.path, kind)):
            message = f"`{kind}` of `{self.name}` has {count} parameter{'s' * (count != 1)}, but needs {wanted}"
            hint = f"write `{kind}: [{', '.join(names)}]`" if kind not in ("discrete", "linear") else ""
            self.report(WRONG_PARAMETERS, (*self.path, kind), message, hint=hint)
        return right

    def sound(self, kind: str, parameters: tuple[float, ...]) -> bool:
        return self.finite(kind, parameters) and self.positive(kind, parameters) and self.ordered(kind, parameters)

    def finite(self, kind: str, parameters: tuple[float, ...]) -> bool:
        for i, parameter in enumerate(parameters):
            if not isfinite(parameter):
                if parameter in (inf, -inf) and kind in _INFINITE:
                    continue
                message = f"{self.what(kind, i)} of `{self.name}` is not a finite number"
                self.report(NOT_FINITE, self.at(kind, i), message, hint="write a number")
                return False
        return True

    def positive(self, kind: str, parameters: tuple[float, ...]) -> bool:
        for i in _POSITIVE.get(kind, ()):
            if not parameters[i] > 0:
                message = f"{self.what(kind, i)} of `{self.name}` is {parameters[i]:g}: it must be above 0"
                self.report(
                    NOT_POSITIVE, self.at(kind, i), message, hint="write a number above 0: it is the width of the term"
                )
                return False
        return True

    def ordered(self, kind: str, parameters: tuple[float, ...]) -> bool:
        values = parameters[::2] if kind == "discrete" else parameters
        if kind in _ASCENDING:
            for i in range(1, len(values)):
                if values[i] < values[i - 1]:
                    what, before = self.what(kind, i), values[i - 1]
                    message = f"{what} of `{self.name}` is {values[i]:g}, but the number before it is {before:g}"
                    hint = f"write them in ascending order: {', '.join(f'{v:g}' for v in sorted(values))}"
                    self.report(NOT_ASCENDING, self.at(kind, i), message, hint=hint)
                    return False
        if kind in _DIFFERENT and values[0] == values[1]:
            message = f"`{kind}` of `{self.name}` begins and ends at {values[0]:g}, so it covers nothing"
            self.report(EMPTY_TERM, (*self.path, kind), message, hint="write two different numbers")
            return False
        return True

    def what(self, kind: str, i: int) -> str:
        return (
            f"point {i + 1}"
            if kind == "discrete"
            else f"the {TERM_PARAMETERS[kind][i]}"
            if i < len(TERM_PARAMETERS[kind])
            else "a number"
        )

    def at(self, kind: str, i: int) -> NodePath:
        return (*self.path, kind) if kind == "constant" else (*self.path, kind, i)


def _flat(value: Any) -> tuple[float, ...]:
    """Return a number, a list of numbers or a list of points as one row of numbers."""
    if isinstance(value, list | tuple):
        return tuple(number for item in value for number in _flat(item))
    return (float(value),)
