"""The actions of `entry`, `do`, `exit` and `actions`: one class for each verb of the YAML.

A verb without expressions is a command itself (`Play`, `Posture`, …). The classes here are the others: a step evaluates
their expressions and templates. `where` is a node's path in its document, for diagnostics; it is not compared.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Union  # a recursive alias needs it: `|` does not take names in quotes

from lumen.language.commands import SaysGestures, VerbCommand
from lumen.language.diagnostics import NodePath


@dataclass(frozen=True, slots=True)
class Expression:
    """The source of an expression."""

    source: str
    where: NodePath = field(default=(), compare=False)
    """The path of the text in the document."""
    written: str = field(default="", compare=False)
    """The author's text if it differs from `source`, because names or functions in it were replaced; else ""."""

    @property
    def shown(self) -> str:
        """The expression as the author wrote it."""
        return self.written or self.source


@dataclass(frozen=True, slots=True)
class Template:
    """A text that may contain `{{ expression }}`."""

    text: str
    where: NodePath = field(default=(), compare=False)
    """The path of the text in the document."""
    written: str = field(default="", compare=False)
    """The author's text if it differs from `text`; else ""."""

    @property
    def shown(self) -> str:
        """The text as the author wrote it."""
        return self.written or self.text


ComputedValue = Union[Expression, None, bool, int, float, tuple["ComputedValue", ...], Mapping[str, "ComputedValue"]]  # noqa: UP007
"""A value to be computed: a text in the YAML is an expression; everything else is used as it is."""


@dataclass(frozen=True, slots=True)
class SayText:
    """`say`: for each language (`""` for any) the alternatives, one of which is drawn at random."""

    texts: Mapping[str, tuple[Template, ...]]
    gestures: SaysGestures = ""


@dataclass(frozen=True, slots=True)
class PublishBody:
    """`publish`: send a message with that body on a route."""

    route: str
    body: ComputedValue = None


@dataclass(frozen=True, slots=True)
class Assign:
    """`assign`: context keys and their new values, evaluated and stored in the order written.

    A key with dots, such as `visitor.name`, leads to a key within a map of the context.
    """

    values: Mapping[str, ComputedValue]


def context_key(way: str) -> str:
    """Return the context key that a key of `assign` changes: `visitor` for `visitor.name`."""
    return way.partition(".")[0]


@dataclass(frozen=True, slots=True)
class Raise:
    """`raise`: an event for this machine, which it processes before any event from outside."""

    event: str
    data: ComputedValue = None


PARENT = "parent"
"""The `to` of a `send` to the behaviour that invoked this one."""


@dataclass(frozen=True, slots=True)
class Send:
    """`send`: an event for this machine or another, after a delay."""

    event: str
    """The name of the event."""
    data: ComputedValue = None
    delay: float | Template = 0.0
    """The delay [s]; a template, such as `{{ context.patience }}s`, is evaluated when the action is performed."""
    id: str = ""
    """The id by which `cancel` can withdraw the event; empty for none."""
    to: str = ""
    """The id of an invoked behaviour, PARENT for the invoking one, or a robot of the house; empty for this one."""


@dataclass(frozen=True, slots=True)
class CancelSend:
    """`cancel`: withdraw the delayed `send` of that id."""

    id: str


@dataclass(frozen=True, slots=True)
class Wait:
    """`wait`, in `do` only: pause for `seconds` [s]."""

    seconds: float


@dataclass(frozen=True, slots=True)
class LogText:
    """`log`: a line for the exhibition's log."""

    text: Template


@dataclass(frozen=True, slots=True)
class If:
    """`if`/`then`/`else` around actions."""

    guard: Expression
    then: tuple["PlacedAction", ...]
    otherwise: tuple["PlacedAction", ...] = ()


@dataclass(frozen=True, slots=True)
class Parallel:
    """`parallel`, in `do` only: perform all of these at once, until the last of them ends."""

    branches: tuple["PlacedAction", ...]


@dataclass(frozen=True, slots=True)
class AskQuestion:
    """`ask`, in `do` only: speak the answer to a question. If no answer comes `within` [s], perform `otherwise`."""

    question: Expression
    within: float
    otherwise: tuple["PlacedAction", ...]


ComputedAction = (
    SayText | PublishBody | Assign | Raise | Send | CancelSend | Wait | LogText | If | Parallel | AskQuestion
)
"""The actions that a step must evaluate or decide."""

Action = ComputedAction | VerbCommand


@dataclass(frozen=True, slots=True)
class PlacedAction:
    """One action and its path in the document."""

    action: Action
    where: NodePath = field(default=(), compare=False)


def nested(block: tuple[PlacedAction, ...]) -> Iterator[PlacedAction]:
    """Yield the actions of a block, including those inside `if` and `parallel`."""
    for step in block:
        yield step
        match step.action:
            case If(then=then, otherwise=otherwise):
                yield from nested(then)
                yield from nested(otherwise)
            case Parallel(branches) | AskQuestion(otherwise=branches):
                yield from nested(branches)
