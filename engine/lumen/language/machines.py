"""A behaviour file as values: a statechart whose targets are resolved.

The keys are XState v5's with UML's `entry`/`do`/`exit`; their meaning is that of W3C SCXML (Appendix D).
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import Any, Literal

from lumen.language.actions import ComputedValue, Expression, PlacedAction, Template
from lumen.language.buttons import Button
from lumen.language.diagnostics import NodePath
from lumen.language.hours import Schedule
from lumen.language.properties import Property


class StateKind(StrEnum):
    """`type:` of a state; a state with children is compound, one without is atomic."""

    ATOMIC = "atomic"
    COMPOUND = "compound"
    PARALLEL = "parallel"
    FINAL = "final"
    HISTORY = "history"


@dataclass(frozen=True, slots=True)
class Approval:
    """A person must approve a transition, `within` this time [s] if it is set; after that, `otherwise` applies."""

    within: float | None = None
    otherwise: Literal["go", "stay"] = "stay"


@dataclass(frozen=True, slots=True)
class Hears:
    """A row of `hears`: the sentences that lead to a transition."""

    number: int
    """The number of the row, unique in its machine."""
    key: str
    """The key in the file."""
    names: tuple[str, ...] = ()
    """Names of `phrases` or `answers`, or paths such as `context.round.entry.right` to phrases of a list's entry."""
    way: Literal["", "not", "asked", "else"] = ""
    """How the names must be in the sentence: found (empty), negated, within a question, or not at all (`else`)."""

    @property
    def title(self) -> str:
        """The row in words: `hears not dance|sing`."""
        return f"hears {' '.join(self.key.split()).replace(' |', '|').replace('| ', '|')}"


@dataclass(frozen=True, slots=True)
class Transition:
    """A candidate: the transition that is taken on `event` if its guard holds."""

    source: str
    event: str = ""
    """A descriptor (`heard`, `error.*`, `*`); empty for `always`."""
    targets: tuple[str, ...] = ()
    """The paths of existing states; empty for a targetless transition."""
    guard: Expression | None = None
    actions: tuple[PlacedAction, ...] = ()
    reenter: bool = False
    """SCXML's `type="external"`."""
    delay: float | Template | None = None
    """The delay of `after` [s], or a template that gives it when the state is entered."""
    exact: bool = False
    """The event's name must equal the descriptor: `onDone` of `talk` ignores `done.state.talk.ask`."""
    where: NodePath = field(default=(), compare=False)
    schedule: Schedule | None = None
    """The times of `at`."""
    approve: Approval | None = None
    """The approval of a person for which the event waits; steps ignore it."""
    offer: bool = False
    """A language model may also raise its event."""
    hears: Hears | None = None
    """The row of `hears`; its event is `heard`."""

    @property
    def timed(self) -> bool:
        """True if a timer of its state selects it instead of an event's name."""
        return self.delay is not None or self.schedule is not None

    @property
    def awaited_time(self) -> str:
        """`after 20 s` or `at 18:00`; empty if no timer selects it."""
        if self.schedule:
            return f"at {self.schedule.text}"
        if isinstance(self.delay, Template):
            return f"after {self.delay.shown}"
        return "" if self.delay is None else f"after {self.delay:g} s"

    def caption(self, failed: str) -> str:
        """Return the trigger in words: its row of `hears`, its time, its event; `done` or `failed` for an end."""
        if self.hears:
            return self.hears.title
        if self.exact and not self.timed:
            return failed if self.event.startswith("error.") else "done"
        return self.awaited_time or self.event


@dataclass(frozen=True, slots=True)
class Invoke:
    """Another behaviour that runs while the state is active; `input` gives keys of its context first values."""

    id: str
    behavior: str
    input: Mapping[str, ComputedValue] = field(default_factory=dict)
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class ForEach:
    """`for` of a state: its content runs once for each entry of a list."""

    each: Expression
    """The list."""
    variable: str
    """The name of the entry in expressions."""
    key: str
    """The context key that holds the entry and the entries that are left."""
    shuffle: bool = False
    """Whether the order is random."""
    most: int | None = None
    """The maximum number of entries; None for all."""
    where: NodePath = field(default=(), compare=False)


Resume = Literal["again", "after", "never", ""]
RESUME_WORDS = ("again", "after", "never")


@dataclass(frozen=True, slots=True)
class State:
    """A state; `path` is its identity, dotted from the root, whose own path is empty."""

    path: str
    kind: StateKind = StateKind.ATOMIC
    parent: str | None = None
    alias: str = ""
    children: tuple[str, ...] = ()
    """Paths in document order."""
    initial: tuple[str, ...] = ()
    """The paths that are entered by default; for a history state, those without a history."""
    deep: bool = False
    entry: tuple[PlacedAction, ...] = ()
    do: tuple[PlacedAction, ...] = ()
    exit: tuple[PlacedAction, ...] = ()
    transitions: tuple[Transition, ...] = ()
    """The candidates in document order."""
    invoke: tuple[Invoke, ...] = ()
    output: ComputedValue = None
    """The data of `done.state.*` for a final state."""
    on_reload: str = ""
    resume: Resume = ""
    """How `do` continues after a history or a restart of the engine; empty to begin anew.

    `again` begins with the same step, `after` with the next one; `never` does not continue.
    """
    life: str = ""
    """The style of life meanwhile; empty to keep that of the surrounding state."""
    gestures: Literal["none", ""] = ""
    """`none`: the robot speaks without gestures."""
    buttons: tuple[Button, ...] = ()
    """Buttons for the operator, also while a state within is active."""
    for_each: ForEach | None = None
    where: NodePath = field(default=(), compare=False)

    @property
    def name(self) -> str:
        """Its name in `configuration`: the alias if it has one, else the path."""
        return self.alias or self.path


@dataclass(frozen=True, slots=True)
class Answer:
    """A row of an `answers:` table: phrases by language, and the value (a text, or one per language)."""

    phrases: Mapping[str, tuple[str, ...]]
    value: Any


@dataclass(frozen=True)
class MachineDefinition:
    """A whole statechart; `states` maps paths to states in document order, the root under the empty path."""

    id: str
    states: Mapping[str, State]
    context: Mapping[str, Any] = field(default_factory=dict)
    types: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    events: Mapping[str, Any] = field(default_factory=dict)
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    """Its own phrases and those of its `words` files, like `answers` and `lists`."""
    answers: Mapping[str, tuple[Answer, ...]] = field(default_factory=dict)
    lists: Mapping[str, tuple[Mapping[str, Any], ...]] = field(default_factory=dict)
    properties: tuple[Property, ...] = ()
    words: tuple[str, ...] = ()
    borrowed: Mapping[tuple[str, str], str] = field(default_factory=dict)
    """The words file of a table's entry: `("answers", "faq")` from `museum`."""
    renamed: Mapping[str, str] = field(default_factory=dict)
    hash: str = ""
    invoked: Mapping[str, "MachineDefinition"] = field(default_factory=dict, repr=False)
    """The machines that its states invoke, by behaviour."""
    robots: tuple[str, ...] = ()
    """The robots of the house, if it has several: events can be sent to them."""
    shared: tuple[str, ...] = ()
    """The keys that these robots share, in the context under the key `shared`."""
    anyhow: frozenset[str] = frozenset()
    """The phrases that match even if they are negated."""

    def __getstate__(self) -> dict[str, Any]:
        """Return its fields for another process, without values that were derived from them here."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def root(self) -> State:
        """The outermost state."""
        return self.states[""]

    def invoked_behavior(self, path: str, id: str) -> str:
        """Return the behaviour that the state at that path invokes under that id; empty if it does not."""
        invokes = self.states[path].invoke if path in self.states else ()
        return next((invoke.behavior for invoke in invokes if invoke.id == id), "")
