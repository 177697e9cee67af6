"""Conditions that must hold whatever happens: `properties` of a behaviour and of a story."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from lumen.language.actions import Expression
from lumen.language.diagnostics import NodePath


@dataclass(frozen=True, slots=True)
class Property:
    """`always: CONDITION`, or `eventually: CONDITION` at most `within` [s] after `whenever` comes to hold, each time.

    Without `whenever` that time is the beginning.
    """

    name: str
    always: Expression | None = None
    eventually: Expression | None = None
    whenever: Expression | None = None
    within: float = 0.0
    where: NodePath = field(default=(), compare=False)


def conditions_of(properties: Iterable[Property]) -> Iterator[Expression]:
    """Yield the conditions in properties."""
    for one in properties:
        yield from filter(None, (one.always, one.whenever, one.eventually))
