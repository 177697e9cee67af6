"""Conditions that must hold in every run: `properties` of a behaviour or of a story."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from lumen.language.actions import Expression
from lumen.language.diagnostics import NodePath


@dataclass(frozen=True, slots=True)
class Property:
    """A condition that must hold: `always: CONDITION`, or `eventually: CONDITION`."""

    name: str
    always: Expression | None = None
    """The condition that must hold in every configuration; None for `eventually`."""
    eventually: Expression | None = None
    """The condition that must hold at some time before the deadline; None for `always`."""
    whenever: Expression | None = None
    """The condition that starts the wait whenever it becomes true; None to wait from the beginning of the run."""
    within: float = 0.0
    """The time until the deadline [s]."""
    where: NodePath = field(default=(), compare=False)


def conditions_of(properties: Iterable[Property]) -> Iterator[Expression]:
    """Yield the conditions in properties."""
    for one in properties:
        yield from filter(None, (one.always, one.whenever, one.eventually))
