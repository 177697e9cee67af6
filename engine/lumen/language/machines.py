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
    """The `type:` of a state.

    Without it, a state with children is compound, and any other state is atomic.
    """

    ATOMIC = "atomic"
    COMPOUND = "compound"
    PARALLEL = "parallel"
    FINAL = "final"
    HISTORY = "history"


@dataclass(frozen=True, slots=True)
class Approval:
    """The approval of a person that a transition needs."""

    within: float | None = None
    """The time limit [s]; None for none."""
    otherwise: Literal["go", "stay"] = "stay"
    """The decision when the time is over: `go` takes the transition, `stay` drops its event."""


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
    """The form in which a sentence must contain one of the names: plainly (empty), negated (`not`) or in a question.

    `else` matches a sentence that no other row matches.
    """

    @property
    def title(self) -> str:
        """The row in words: `hears not dance|sing`."""
        return f"hears {' '.join(self.key.split()).replace(' |', '|').replace('| ', '|')}"


@dataclass(frozen=True, slots=True)
class Transition:
    """A transition, which is taken on `event` if its guard holds and no earlier one is taken."""

    source: str
    event: str = ""
    """A descriptor (`heard`, `error.*`, `*`); empty for `always`."""
    targets: tuple[str, ...] = ()
    """The paths of existing states; empty for a targetless transition."""
    guard: Expression | None = None
    actions: tuple[PlacedAction, ...] = ()
    reenter: bool = False
    """True to exit and enter `source` even if all targets are inside it: SCXML's `type="external"`."""
    delay: float | Template | None = None
    """The delay of `after` [s], or a template that gives it when the state is entered; None for other transitions."""
    exact: bool = False
    """True if the event's name must equal the descriptor: `onDone` of `talk` ignores `done.state.talk.ask`."""
    where: NodePath = field(default=(), compare=False)
    schedule: Schedule | None = None
    """The times of `at`; None for other transitions."""
    approve: Approval | None = None
    """The approval of a person, for which the runtime delays the event; steps ignore it. None if none is needed."""
    offer: bool = False
    """True if a language model may also raise the transition's event."""
    hears: Hears | None = None
    """The row of `hears`, whose event is `heard`; None for other transitions."""

    @property
    def timed(self) -> bool:
        """True if a timer of the transition's state selects the transition, instead of an event's name."""
        return self.delay is not None or self.schedule is not None

    @property
    def awaited_time(self) -> str:
        """The time in words: `after 20 s` or `at 18:00`; empty if no timer selects the transition."""
        if self.schedule:
            return f"at {self.schedule.text}"
        if isinstance(self.delay, Template):
            return f"after {self.delay.shown}"
        return "" if self.delay is None else f"after {self.delay:g} s"

    def caption(self, failed: str) -> str:
        """Return the trigger in words: the row of `hears`, the time or the event.

        For the end of an activity it is "done", or the text `failed` after an error.
        """
        if self.hears:
            return self.hears.title
        if self.exact and not self.timed:
            return failed if self.event.startswith("error.") else "done"
        return self.awaited_time or self.event


@dataclass(frozen=True, slots=True)
class Invoke:
    """Another behaviour that runs while the state is active; `input` sets initial values in its context."""

    id: str
    behavior: str
    input: Mapping[str, ComputedValue] = field(default_factory=dict)
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class ForEach:
    """`for` of a state: its content runs once for each entry of a list."""

    each: Expression
    """The expression of the list."""
    variable: str
    """The name of the entry in expressions."""
    key: str
    """The context key that holds the entry and the entries that are left."""
    shuffle: bool = False
    """True for a random order."""
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
    """The paths that are entered by default; for a history state, as long as it remembers nothing."""
    deep: bool = False
    entry: tuple[PlacedAction, ...] = ()
    do: tuple[PlacedAction, ...] = ()
    exit: tuple[PlacedAction, ...] = ()
    transitions: tuple[Transition, ...] = ()
    """The candidates in document order."""
    invoke: tuple[Invoke, ...] = ()
    output: ComputedValue = None
    """The data of `done.state.*` when this final state is entered."""
    on_reload: str = ""
    resume: Resume = ""
    """How `do` continues when a history or a restart of the engine enters the state; empty to begin anew.

    `again` begins with the interrupted step, `after` with the next one; `never` does not continue.
    """
    life: str = ""
    """The style of life while the state is active; empty for that of the surrounding state."""
    gestures: Literal["none", ""] = ""
    """`none` if the robot speaks without gestures in the state; empty otherwise."""
    buttons: tuple[Button, ...] = ()
    """Buttons for the operator, which are also available while a state within is active."""
    for_each: ForEach | None = None
    where: NodePath = field(default=(), compare=False)

    @property
    def name(self) -> str:
        """The name of the state in `configuration`: its alias if it has one, else its path."""
        return self.alias or self.path


@dataclass(frozen=True, slots=True)
class Answer:
    """A row of an `answers:` table."""

    phrases: Mapping[str, tuple[str, ...]]
    """The phrases by language; those for all languages have an empty key."""
    value: Any
    """The value of the answer: a text, or texts by language."""


@dataclass(frozen=True)
class MachineDefinition:
    """A whole statechart; `states` maps paths to states in document order, the root under the empty path."""

    id: str
    states: Mapping[str, State]
    context: Mapping[str, Any] = field(default_factory=dict)
    types: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    events: Mapping[str, Any] = field(default_factory=dict)
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    """The phrases of the behaviour and of its `words` files. The same is true of `answers` and `lists`."""
    answers: Mapping[str, tuple[Answer, ...]] = field(default_factory=dict)
    lists: Mapping[str, tuple[Mapping[str, Any], ...]] = field(default_factory=dict)
    properties: tuple[Property, ...] = ()
    words: tuple[str, ...] = ()
    borrowed: Mapping[tuple[str, str], str] = field(default_factory=dict)
    """The words file from which an entry of a table comes: `("answers", "faq")` is from `museum`."""
    renamed: Mapping[str, str] = field(default_factory=dict)
    hash: str = ""
    invoked: Mapping[str, "MachineDefinition"] = field(default_factory=dict, repr=False)
    """The machines that the behaviour's states invoke, by behaviour."""
    robots: tuple[str, ...] = ()
    """The robots of the house if there are several, since events can be sent to them."""
    shared: tuple[str, ...] = ()
    """The keys that these robots share, in the context under the key `shared`."""
    anyhow: frozenset[str] = frozenset()
    """The phrases that match even if they are negated."""

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields for pickling, without the values that this process derived from them."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def root(self) -> State:
        """The outermost state."""
        return self.states[""]

    def invoked_behavior(self, path: str, id: str) -> str:
        """Return the behaviour that the state at that path invokes under that id; empty if it invokes none."""
        invokes = self.states[path].invoke if path in self.states else ()
        return next((invoke.behavior for invoke in invokes if invoke.id == id), "")


def path_of(machine: MachineDefinition, name: str) -> str:
    """Return the path of the state with that id or path. Raises KeyError if no state has it."""
    found = next((state.path for state in machine.states.values() if name == state.alias), name)
    return machine.states[found].path


def hearing_states(machine: MachineDefinition) -> list[State]:
    """Return the states that have rows of `hears`, in document order."""
    return [state for state in machine.states.values() if any(t.hears for t in state.transitions)]


def rows_around(machine: MachineDefinition, path: str) -> list[Hears]:
    """Return the rows of `hears` of a state and of the states around it, inner states first."""
    found: list[Hears] = []
    at: str | None = path
    while at is not None:
        state = machine.states[at]
        found += [t.hears for t in state.transitions if t.hears]
        at = state.parent
    return found


def is_within(path: str, outer: str) -> bool:
    """Return True if `path` is the state `outer` or a state in it; the empty path is the whole machine."""
    return path == outer or not outer or path.startswith(f"{outer}.")


def transition_domain(machine: MachineDefinition, transition: Transition) -> str:
    """Return the path of the innermost compound state around a transition's source and targets.

    The transition does not leave this state, its domain (`getTransitionDomain` in SCXML). The path is empty for the
    whole machine.
    """
    path = transition.source
    if transition.reenter:
        path = machine.states[path].parent or ""
    while path and not (
        machine.states[path].kind is StateKind.COMPOUND
        and all(target != path and is_within(target, path) for target in transition.targets)
    ):
        path = machine.states[path].parent or ""
    return path
