"""What a behaviour file says: a statechart as frozen values, its targets resolved.

The words are XState v5's with UML's `entry`/`do`/`exit`; what they mean is W3C SCXML (Appendix D).
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
    """A person has to approve a transition, `within` so long [s] where that is said; else it goes or stays."""

    within: float | None = None
    otherwise: Literal["go", "stay"] = "stay"


@dataclass(frozen=True, slots=True)
class Hears:
    """A row of `hears`: the sentences that lead to a transition.

    `number` is unique in its machine, `key` is the key in the file. `way` is how the names must be in
    the sentence: found, negated (`not`), within a question (`asked`), or not at all (`else`). A name is one of
    `phrases` or `answers`, or a path such as `context.round.entry.right` to phrases of a list's entry.
    """

    number: int
    key: str
    names: tuple[str, ...] = ()
    way: Literal["", "not", "asked", "else"] = ""

    @property
    def title(self) -> str:
        """The row in words: `hears not dance|sing`."""
        return f"hears {' '.join(self.key.split()).replace(' |', '|').replace('| ', '|')}"


@dataclass(frozen=True, slots=True)
class Transition:
    """A candidate: taken on `event` where its guard holds.

    `event` is a descriptor (`heard`, `error.*`, `*`), empty for `always`; `delay` is set for `after` ([s], or what says
    how long when its state is entered), `schedule` for `at`. `targets` are the paths of existing states, empty for a
    targetless transition. `reenter` is SCXML's `type="external"`. Where `exact`, the event's name has to be the whole
    descriptor, not begin with it: `onDone` of `talk` has nothing to do with `done.state.talk.ask`. Where it waits for
    somebody to `approve` it, the event waits: no step knows of that.
    An `offer` is for a language model, too, which may raise its event.
    A row of `hears` waits for `heard`, and `hears` is the row.
    """

    source: str
    event: str = ""
    targets: tuple[str, ...] = ()
    guard: Expression | None = None
    actions: tuple[PlacedAction, ...] = ()
    reenter: bool = False
    delay: float | Template | None = None
    exact: bool = False
    where: NodePath = field(default=(), compare=False)
    schedule: Schedule | None = None
    approve: Approval | None = None
    offer: bool = False
    hears: Hears | None = None

    @property
    def timed(self) -> bool:
        """Whether a timer of its state selects it, and no event's name."""
        return self.delay is not None or self.schedule is not None

    @property
    def awaited_time(self) -> str:
        """`after 20 s` or `at 18:00`, empty where no timer selects it."""
        if self.schedule:
            return f"at {self.schedule.text}"
        if isinstance(self.delay, Template):
            return f"after {self.delay.shown}"
        return "" if self.delay is None else f"after {self.delay:g} s"

    def caption(self, failed: str) -> str:
        """The trigger in words: the key of its row of `hears`, its time, its event; `done` or `failed` for an end."""
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
    """`for` of a state: what is in it runs once for each entry of the list `each`, which is `variable` meanwhile.

    `shuffle` draws an order, `most` ends it earlier. `key` is that of the context which holds the entry and those left.
    """

    each: Expression
    variable: str
    key: str
    shuffle: bool = False
    most: int | None = None
    where: NodePath = field(default=(), compare=False)


Resume = Literal["again", "after", "never", ""]
RESUME_WORDS = ("again", "after", "never")


@dataclass(frozen=True, slots=True)
class State:
    """A state; `path` is its identity, dotted from the root, whose own path is empty.

    `initial` holds the paths entered by default (of a compound state, or of a history state without history).
    `children` are paths in document order, `transitions` candidates in document order. `output` is the data of
    `done.state.*` for a final state. `resume` says how its `do` goes on where a history leads back into it, or where
    the engine was away: the step that it was at `again`, the one `after` it, or `never`; empty for all of it anew.
    `buttons` are for the operator, also while a state within is active. `life` names the style in which the robot is
    alive meanwhile, empty where the state around it decides;
    with `gestures` none it speaks without them.
    """

    path: str
    kind: StateKind = StateKind.ATOMIC
    parent: str | None = None
    alias: str = ""
    children: tuple[str, ...] = ()
    initial: tuple[str, ...] = ()
    deep: bool = False
    entry: tuple[PlacedAction, ...] = ()
    do: tuple[PlacedAction, ...] = ()
    exit: tuple[PlacedAction, ...] = ()
    transitions: tuple[Transition, ...] = ()
    invoke: tuple[Invoke, ...] = ()
    output: ComputedValue = None
    on_reload: str = ""
    resume: Resume = ""
    life: str = ""
    gestures: Literal["none", ""] = ""
    buttons: tuple[Button, ...] = ()
    for_each: ForEach | None = None
    where: NodePath = field(default=(), compare=False)

    @property
    def name(self) -> str:
        """What `configuration` calls it: the alias where there is one, else the path."""
        return self.alias or self.path


@dataclass(frozen=True, slots=True)
class Answer:
    """A row of an `answers:` table: phrases by language, and the value (a text, or one per language)."""

    phrases: Mapping[str, tuple[str, ...]]
    value: Any


@dataclass(frozen=True)
class MachineDefinition:
    """A whole statechart; `states` maps paths to states in document order, the root under the empty path.

    `phrases`, `answers` and `lists` are its own and those of its `words` files; `borrowed` says of those from which
    file each comes: `("answers", "faq")` from `museum`. `invoked` holds the machines that its states invoke, by the
    names of their behaviours. `robots` are those of the house, where it has several: events can be sent to them.
    `shared` are the keys that these have in common, in the context under the key of that name. Phrases named in
    `anyhow` count even if they are negated.
    """

    id: str
    states: Mapping[str, State]
    context: Mapping[str, Any] = field(default_factory=dict)
    types: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    events: Mapping[str, Any] = field(default_factory=dict)
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    answers: Mapping[str, tuple[Answer, ...]] = field(default_factory=dict)
    lists: Mapping[str, tuple[Mapping[str, Any], ...]] = field(default_factory=dict)
    properties: tuple[Property, ...] = ()
    words: tuple[str, ...] = ()
    borrowed: Mapping[tuple[str, str], str] = field(default_factory=dict)
    renamed: Mapping[str, str] = field(default_factory=dict)
    hash: str = ""
    invoked: Mapping[str, "MachineDefinition"] = field(default_factory=dict, repr=False)
    robots: tuple[str, ...] = ()
    shared: tuple[str, ...] = ()
    anyhow: frozenset[str] = frozenset()

    def __getstate__(self) -> dict[str, Any]:
        """What it says, for another process: what was made of it here is none of its fields."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @property
    def root(self) -> State:
        return self.states[""]

    def invoked_behavior(self, path: str, id: str) -> str:
        """The behaviour that the state at that path invokes under that id; empty for none."""
        invokes = self.states[path].invoke if path in self.states else ()
        return next((invoke.behavior for invoke in invokes if invoke.id == id), "")
