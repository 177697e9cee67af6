"""The content of a behaviour's picture: boxes within boxes, and arrows between them."""

from collections.abc import Iterator
from dataclasses import dataclass, field


@dataclass(frozen=True)
class StateBox:
    """A state as a box; `rows` describe its transitions, `marked` is whether the picture is about it.

    `first` is whether the enclosing state begins with it. The boxes in a `parallel` one are side by side.
    """

    id: str
    title: str
    rows: tuple[str, ...] = ()
    within: tuple["StateBox", ...] = ()
    parallel: bool = False
    final: bool = False
    first: bool = False
    marked: bool = False


@dataclass(frozen=True)
class Diagram:
    """A picture: its outermost boxes, and the arrows between boxes by their ids, each once, in order."""

    title: str
    boxes: tuple[StateBox, ...]
    arrows: tuple[tuple[str, str], ...] = field(default=())

    def all(self) -> Iterator[StateBox]:
        """Yield every box, outer ones first."""
        waiting = list(self.boxes)
        while waiting:
            box = waiting.pop(0)
            yield box
            waiting = [*box.within, *waiting]
