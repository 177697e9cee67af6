"""Lanes of attacks: a broker, the machine on which an exhibition runs, and imports. Each checks its own target.

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
    """One way in for attacks."""

    batch: int

    def strike(self, attack: Attack) -> str:
        """Make the attack; return its outcome in a word or two."""

    def check(self) -> None: ...

    def size(self) -> Size: ...

    def close(self) -> None: ...


def lanes(url: str) -> dict[str, tuple[Sequence[Kind], Callable[[], Lane]]]:
    """Return the kinds of attacks that each lane takes, and its maker, by name; the broker is at `url`."""
    return {
        "broker": (Remote.kinds, lambda: Remote(url)),
        "machine": (Local.kinds, Local),
        "imports": (Imports.kinds, Imports),
    }
