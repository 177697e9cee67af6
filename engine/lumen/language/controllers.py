"""What a fuzzy controller file says: variables, terms, rules, operators, bindings."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.language.diagnostics import Path


@dataclass(frozen=True, slots=True)
class Term:
    """A linguistic value: a membership function of `kind` with its parameters in the variable's unit."""

    name: str
    kind: str
    parameters: tuple[float, ...]
    where: Path = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Variable:
    """A linguistic variable over [`minimum`, `maximum`]; `default` is the output where no rule fires."""

    name: str
    minimum: float
    maximum: float
    terms: Mapping[str, Term]
    unit: str = ""
    direction: str = ""
    default: float | None = None
    where: Path = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Proposition:
    """`variable is [hedges] term`."""

    variable: str
    term: str
    hedges: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Conjunction:
    """`left and right`."""

    left: "Antecedent"
    right: "Antecedent"


@dataclass(frozen=True, slots=True)
class Disjunction:
    """`left or right`."""

    left: "Antecedent"
    right: "Antecedent"


Antecedent = Proposition | Conjunction | Disjunction


@dataclass(frozen=True, slots=True)
class Rule:
    """`if antecedent then consequents with weight`; `text` is the rule as written."""

    antecedent: Antecedent
    consequents: tuple[Proposition, ...]
    weight: float = 1.0
    text: str = ""
    where: Path = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Operators:
    """How rules combine: T-norm, S-norm, implication, aggregation, defuzzifier and its number of points."""

    conjunction: str = "minimum"
    disjunction: str = "maximum"
    implication: str = "minimum"
    aggregation: str = "maximum"
    defuzzifier: str = "centroid"
    resolution: int = 1000


@dataclass(frozen=True, slots=True)
class InputBinding:
    """Where an input comes from: `face.x` is the field `x` of the bodies of the route `face`."""

    variable: str
    route: str
    path: tuple[str, ...]
    where: Path = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class OutputBinding:
    """What an output moves: `joint` by `gain` times the output (the sign in it), within limits [rad]."""

    variable: str
    joint: str
    gain: float
    minimum: float | None = None
    maximum: float | None = None
    where: Path = field(default=(), compare=False)


@dataclass(frozen=True)
class Controller:
    """A fuzzy controller; `angle` [rad] is what one unit of an angular output is."""

    name: str
    inputs: Mapping[str, Variable]
    outputs: Mapping[str, Variable]
    rules: tuple[Rule, ...]
    operators: Operators = Operators()
    input_bindings: tuple[InputBinding, ...] = ()
    output_bindings: tuple[OutputBinding, ...] = ()
    angle: float = 1.0
