"""The ways in: a broker, the machine on which an exhibition runs, and imports. Each attacks its target, and checks it.

A lane takes `batch` attacks between two checks. `strike` makes one of them; `check` raises BrokenError if the target
no longer works. If a batch breaks the target, `running.py` starts the lane again and halves the batch.
"""

from collections.abc import Callable, Sequence
from typing import Protocol

from tests.attack.attacks import Attack, Kind
from tests.attack.imports import Imports
from tests.attack.local import Local
from tests.attack.remote import Remote
from tests.attack.targets import Size


class Lane(Protocol):
    """One way in."""

    batch: int

    def strike(self, attack: Attack) -> str:
        """Make the attack; what became of it, in a word or two."""

    def check(self) -> None: ...

    def size(self) -> Size: ...

    def close(self) -> None: ...


def lanes(url: str) -> dict[str, tuple[Sequence[Kind], Callable[[], Lane]]]:
    """The ways in by name, each with the kinds of attacks that it takes; messages come through the broker at `url`."""
    return {
        "broker": (Remote.kinds, lambda: Remote(url)),
        "machine": (Local.kinds, Local),
        "imports": (Imports.kinds, Imports),
    }
