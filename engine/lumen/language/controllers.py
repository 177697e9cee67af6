"""A fuzzy controller's file as values: variables, terms, rules, operators, bindings, and settings of head tracking."""

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
"""The kinds of term, and the names of their parameters, in order; `discrete` and `linear` have any number."""

VALUE_TERMS = ("constant", "linear")
"""The kinds of term that are a single value, for weighted defuzzifiers; a `function` may be a value or a set."""

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
"""The methods that select which rules of a block are applied, each with the settings that it reads."""

COMPARISONS = ("<", "<=", "==", "!=", ">=", ">")

INTEGRAL_DEFUZZIFIERS = ("centroid", "bisector", "smallest-of-maximum", "mean-of-maximum", "largest-of-maximum")
WEIGHTED_DEFUZZIFIERS = ("weighted-average", "weighted-sum")
DEFUZZIFIERS = INTEGRAL_DEFUZZIFIERS + WEIGHTED_DEFUZZIFIERS
"""Integral ones work on the sampled set (Mamdani), weighted ones on the terms (Takagi-Sugeno, Tsukamoto)."""


@dataclass(frozen=True, slots=True)
class Term:
    """A linguistic value: a membership function of `kind`."""

    name: str
    kind: str
    parameters: tuple[float, ...]
    """In the order of `TERM_PARAMETERS`, in the variable's unit; `discrete` has x, membership, x, …"""
    height: float = 1.0
    formula: str = ""
    """The formula of a `function`, which has no parameters."""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Variable:
    """A linguistic variable over [`minimum`, `maximum`]."""

    name: str
    minimum: float
    maximum: float
    terms: Mapping[str, Term]
    unit: str = ""
    direction: str = ""
    default: float | None = None
    """The value of an output if no rule fires; None if the file sets none."""
    neutral: float | None = None
    lock_range: bool = False
    """True to keep the value within the range."""
    lock_previous: bool = False
    """True to keep the previous value of an output if no rule fires."""
    aggregation: str = "maximum"
    defuzzifier: str = "centroid"
    resolution: int = 1000
    """The number of points of an output's sampled set."""
    accuracy: float | None = None
    """The maximum distance of an output's value from the exact integral; None if the file sets none."""
    where: NodePath = field(default=(), compare=False)

    @property
    def weighted(self) -> bool:
        """True if an output is computed from the values of its terms instead of from a set."""
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
    """The selection of a block's rules that are applied: `method` is one of `ACTIVATIONS`, the rest its settings."""

    method: str = "general"
    rules: int = 1
    threshold: float = 0.0
    comparison: str = ">="


@dataclass(frozen=True, slots=True)
class Operators:
    """The operators of a block's rules: a T-norm for `and`, an S-norm for `or`, the implication, the activation."""

    conjunction: str = "minimum"
    disjunction: str = "maximum"
    implication: str = "minimum"
    activation: Activation = Activation()


@dataclass(frozen=True, slots=True)
class RuleBlock:
    """Rules that are activated together; a later block may use the conclusions of an earlier one."""

    rules: tuple[Rule, ...]
    operators: Operators = Operators()
    name: str = ""


@dataclass(frozen=True, slots=True)
class InputBinding:
    """The source of an input: `face.x` is the field `x` of messages on the route `face`."""

    variable: str
    route: str
    path: tuple[str, ...]
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class OutputBinding:
    """The joint that an output moves."""

    variable: str
    """The name of the output."""
    joint: str
    """The joint, by name or role."""
    gain: float
    """The factor by which the output is multiplied; negative to turn the other way."""
    minimum: float | None = None
    """The lower limit [rad]; None for that of the joint."""
    maximum: float | None = None
    """The upper limit [rad]; None for that of the joint."""
    angle: float = 1.0
    """The angle of one unit of the output [rad]."""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class ContextInput:
    """An input whose value is a number in the behaviour's context."""

    variable: str
    key: str
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class VolumeBinding:
    """An output that sets the robot's volume, from 0 to 1. It is sent again when it has changed by `step`."""

    variable: str
    step: float
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class MessageBinding:
    """An output that is a field of a message; outputs for fields of the same route make one message."""

    variable: str
    """The output."""
    route: str
    """The name of the route."""
    path: tuple[str, ...]
    """The path of the field in the message."""
    step: float
    """The change after which the message is sent again."""
    body: Mapping[str, Any] = field(default_factory=dict)
    """Constant fields of the message, to which the output is added."""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class ContextBinding:
    """An output that sets a key of the context."""

    variable: str
    """The output."""
    key: str
    """The name of the context key."""
    step: float
    """The change after which the key is set again."""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class ThresholdBinding:
    """An output that raises an event once when it passes a threshold."""

    variable: str
    """The output."""
    event: str
    """The name of the event."""
    threshold: float
    """The threshold, in the output's unit."""
    rising: bool
    """True if the event is raised on the way up, False on the way down."""
    hysteresis: float
    """The distance that the output must return before the event can be raised again."""
    where: NodePath = field(default=(), compare=False)


SignalBinding = VolumeBinding | MessageBinding | ContextBinding | ThresholdBinding
"""The targets of an output that moves no joint."""

CONTROLLER_EVENT = "controller."
"""The prefix of the events, followed by the controller's name, with which a controller sets the context."""


@dataclass(frozen=True, slots=True)
class TrackingSettings:
    """The settings by which joints follow a face, and search for it after they lose it."""

    speed: float = 0.3
    """The fraction of the joints' maximum speed."""
    looks: int = 1
    """The number of evaluations of the controller for each image, each with the face as seen after the turn before."""
    zoom: float = 1.0
    """The maximum magnification of these evaluations."""
    hold: float = 2.0
    """The time that the joints stay after a loss [s]."""
    search: float = 8.0
    """The time for which the joints then swing to search [s]."""
    period: float = 4.0
    """The period of the swing [s]."""
    stale: float = 1.0
    """The age above which a face is ignored [s]."""
    every: float = 0.2
    """The minimum time between two evaluations of outputs that move no joint [s]."""
    sweep: Mapping[str, float] = field(default_factory=dict)
    """The amplitude of the swing to either side, by joint [rad]."""
    ahead: Mapping[str, float] = field(default_factory=dict)
    """The angles to which joints return after the search, by joint [rad]."""


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
