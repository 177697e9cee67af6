"""The content of a behaviour's picture: boxes within boxes, and arrows between them."""

from collections.abc import Iterator
from dataclasses import dataclass, field


@dataclass(frozen=True)
class StateBox:
    """A state as a box."""

    id: str
    title: str
    """The name that is shown."""
    rows: tuple[str, ...] = ()
    """Lines below the title: transitions, invoked behaviours, and for a hub the number of states that lead to it."""
    within: tuple["StateBox", ...] = ()
    """The boxes inside."""
    parallel: bool = False
    """Whether the boxes inside are side by side."""
    final: bool = False
    """Whether the state is a final state."""
    first: bool = False
    """Whether the enclosing state begins with this state."""
    marked: bool = False
    """Whether the picture is about this state."""


@dataclass(frozen=True)
class Diagram:
    """A picture of a behaviour."""

    title: str
    boxes: tuple[StateBox, ...]
    """The outermost boxes."""
    arrows: tuple[tuple[str, str], ...] = field(default=())
    """The ids of the boxes from which and to which each arrow leads; each pair once, in order."""

    def all(self) -> Iterator[StateBox]:
        """Yield every box, each before the boxes inside it."""
        waiting = list(self.boxes)
        while waiting:
            box = waiting.pop(0)
            yield box
            waiting = [*box.within, *waiting]
