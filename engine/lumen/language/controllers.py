"""What a fuzzy controller file says: variables, terms, rules, operators, bindings, and how a head tracks with it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.language.diagnostics import NodePath

TERM_PARAMETERS: Mapping[str, tuple[str, ...]] = {
    "triangle": ("left", "top", "right"),
    "trapezoid": ("bottom left", "top left", "top right", "bottom right"),
    "gaussian": ("mean", "sigma"),
    "gaussian-product": ("mean of the left side", "its sigma", "mean of the right side", "its sigma"),
    "bell": ("center", "width", "slope"),
    "sigmoid": ("inflection", "slope"),
    "sigmoid-difference": ("left inflection", "rising slope", "falling slope", "right inflection"),
    "sigmoid-product": ("left inflection", "rising slope", "falling slope", "right inflection"),
    "ramp": ("start", "end"),
    "rectangle": ("start", "end"),
    "s-shape": ("start", "end"),
    "z-shape": ("start", "end"),
    "pi-shape": ("bottom left", "top left", "top right", "bottom right"),
    "spike": ("center", "width"),
    "cosine": ("center", "width"),
    "concave": ("inflection", "end"),
    "semi-ellipse": ("start", "end"),
    "arc": ("start", "end"),
    "binary": ("start", "direction"),
    "discrete": ("points [x, membership]",),
    "constant": ("value",),
    "linear": ("one coefficient for each input", "a constant"),
    "function": ("a formula",),
}
"""The kinds of term, and what their parameters are called, in order; `discrete` and `linear` take any number."""

VALUE_TERMS = ("constant", "linear")
"""The kinds of term that are a single value, for weighted defuzzifiers; `function` may be that as well as a set."""

HEDGES = ("any", "not", "extremely", "seldom", "somewhat", "very")

T_NORMS = ("minimum", "algebraic-product", "bounded-difference", "drastic-product", "einstein-product",
           "hamacher-product", "nilpotent-minimum")  # fmt: skip

S_NORMS = ("maximum", "algebraic-sum", "bounded-sum", "drastic-sum", "einstein-sum", "hamacher-sum",
           "nilpotent-maximum", "normalized-sum", "unbounded-sum")  # fmt: skip

ACTIVATIONS: Mapping[str, tuple[str, ...]] = {
    "general": (),
    "first": ("rules", "threshold"),
    "last": ("rules", "threshold"),
    "highest": ("rules",),
    "lowest": ("rules",),
    "proportional": (),
    "threshold": ("comparison", "threshold"),
}
"""Which rules of a block take part, and the settings that each method reads."""

COMPARISONS = ("<", "<=", "==", "!=", ">=", ">")

INTEGRAL_DEFUZZIFIERS = ("centroid", "bisector", "smallest-of-maximum", "mean-of-maximum", "largest-of-maximum")
WEIGHTED_DEFUZZIFIERS = ("weighted-average", "weighted-sum")
DEFUZZIFIERS = INTEGRAL_DEFUZZIFIERS + WEIGHTED_DEFUZZIFIERS
"""Integral ones work on the sampled set (Mamdani), weighted ones on the terms (Takagi-Sugeno, Tsukamoto)."""


@dataclass(frozen=True, slots=True)
class Term:
    """A linguistic value: a membership function of `kind` with its parameters in the variable's unit.

    `parameters` stand in the order of `TERMS`; `discrete` has x, membership, x, membership, … and `function` none, but
    a `formula`.
    """

    name: str
    kind: str
    parameters: tuple[float, ...]
    height: float = 1.0
    formula: str = ""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Variable:
    """A linguistic variable over [`minimum`, `maximum`]; `default` is the output where no rule fires.

    `lock_range` keeps the value within the range; `lock_previous` keeps an output as it was where no rule fires.
    `aggregation`, `defuzzifier`, `resolution` (points of the sampled set) and `accuracy` (how far the value may be
    from the integral) are an output's.
    """

    name: str
    minimum: float
    maximum: float
    terms: Mapping[str, Term]
    unit: str = ""
    direction: str = ""
    default: float | None = None
    neutral: float | None = None
    lock_range: bool = False
    lock_previous: bool = False
    aggregation: str = "maximum"
    defuzzifier: str = "centroid"
    resolution: int = 1000
    accuracy: float | None = None
    where: NodePath = field(default=(), compare=False)

    @property
    def weighted(self) -> bool:
        """Whether an output is computed from the values of its terms, and not from a set."""
        return self.defuzzifier in WEIGHTED_DEFUZZIFIERS


@dataclass(frozen=True, slots=True)
class Proposition:
    """`variable is [hedges] term`; the term is empty after the hedge `any`, which needs none."""

    variable: str
    term: str
    hedges: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Negation:
    """`not (operand)`."""

    operand: "Antecedent"


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


Antecedent = Proposition | Negation | Conjunction | Disjunction


@dataclass(frozen=True, slots=True)
class Rule:
    """`if antecedent then consequents with weight`; `text` is the rule as written."""

    antecedent: Antecedent
    consequents: tuple[Proposition, ...]
    weight: float = 1.0
    text: str = ""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Activation:
    """Which rules of a block take part: `method` is one of `ACTIVATIONS`, the rest its settings."""

    method: str = "general"
    rules: int = 1
    threshold: float = 0.0
    comparison: str = ">="


@dataclass(frozen=True, slots=True)
class Operators:
    """How the rules of a block combine: T-norm, S-norm, implication, activation."""

    conjunction: str = "minimum"
    disjunction: str = "maximum"
    implication: str = "minimum"
    activation: Activation = Activation()


@dataclass(frozen=True, slots=True)
class RuleBlock:
    """Rules that are activated together; a later block may ask for what an earlier one concluded."""

    rules: tuple[Rule, ...]
    operators: Operators = Operators()
    name: str = ""


@dataclass(frozen=True, slots=True)
class InputBinding:
    """Where an input comes from: `face.x` is the field `x` of the bodies of the route `face`."""

    variable: str
    route: str
    path: tuple[str, ...]
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class OutputBinding:
    """What an output moves: `joint` by `gain` times the output (the sign in it), within limits [rad].

    `angle` [rad] is what one unit of the output is.
    """

    variable: str
    joint: str
    gain: float
    minimum: float | None = None
    maximum: float | None = None
    angle: float = 1.0
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class ContextInput:
    """An input that is a number of the behaviour's context."""

    variable: str
    key: str
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class VolumeBinding:
    """An output that is how loud the robot speaks, from 0 to 1; told anew when it has changed by `step`."""

    variable: str
    step: float
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class MessageBinding:
    """An output that is a field of a message on `route`, beside what `body` says, sent when it has changed by `step`.

    Outputs that are fields of the same route make one message.
    """

    variable: str
    route: str
    path: tuple[str, ...]
    step: float
    body: Mapping[str, Any] = field(default_factory=dict)
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class ContextBinding:
    """An output that the context's `key` becomes when it has changed by `step`."""

    variable: str
    key: str
    step: float
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class ThresholdBinding:
    """An output that raises `event` once as it goes beyond `threshold`, upwards if `rising`, else downwards.

    It can be raised again after the output has come back by `hysteresis`.
    """

    variable: str
    event: str
    threshold: float
    rising: bool
    hysteresis: float
    where: NodePath = field(default=(), compare=False)


SignalBinding = VolumeBinding | MessageBinding | ContextBinding | ThresholdBinding
"""What an output does that moves no joint."""

CONTROLLER_EVENT = "controller."
"""How the event begins, followed by the controller's name, by which a behaviour's context becomes what one says."""


@dataclass(frozen=True, slots=True)
class TrackingSettings:
    """How joints follow what is seen, and what they do when it is lost.

    For `hold` [s] they stay; for `search` [s] they swing by `sweep` [rad] to either side, once in `period` [s]; then
    they go to `ahead` [rad]. `speed` is the fraction of the joints' greatest. A sight older than `stale` [s] does not
    count. For each sight the controller is asked `looks` times, each time about the image as the head would see it
    after the turn before, and at most `zoom` times magnified. What moves no joint is worked out once in `every` [s] at
    most.
    """

    speed: float = 0.3
    looks: int = 1
    zoom: float = 1.0
    hold: float = 2.0
    search: float = 8.0
    period: float = 4.0
    stale: float = 1.0
    every: float = 0.2
    sweep: Mapping[str, float] = field(default_factory=dict)
    ahead: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class ControllerDefinition:
    """A fuzzy controller; `angle` [rad] is the file's unit of angles."""

    name: str
    inputs: Mapping[str, Variable]
    outputs: Mapping[str, Variable]
    blocks: tuple[RuleBlock, ...]
    input_bindings: tuple[InputBinding, ...] = ()
    output_bindings: tuple[OutputBinding, ...] = ()
    tracking: TrackingSettings = TrackingSettings()
    angle: float = 1.0
    context_inputs: tuple[ContextInput, ...] = ()
    signals: tuple[SignalBinding, ...] = ()

    @property
    def rules(self) -> tuple[Rule, ...]:
        """All rules, in the order written."""
        return tuple(rule for block in self.blocks for rule in block.rules)
