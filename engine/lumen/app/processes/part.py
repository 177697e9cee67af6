"""What a process is made of."""

from collections.abc import Sequence
from typing import Protocol

from lumen.language.events import Event
from lumen.language.projects import Project


class Part(Protocol):
    """One of robot, brain, motion and visitor (`name`); it begins when the parts that it `needs` are there.

    `tick` is called with the time [s] and with what the presence of others has changed; `use` with another bundle,
    where that is not the brain's own doing. `interrupt` is what Ctrl-C asks for; true where another one has to end it.
    """

    name: str
    needs: tuple[str, ...]

    @property
    def over(self) -> bool: ...

    @property
    def failed(self) -> bool: ...

    def begin(self, now: float) -> None: ...

    def tick(self, now: float, changes: Sequence[Event]) -> None: ...

    def use(self, project: Project) -> None: ...

    def interrupt(self) -> bool: ...

    def summary(self) -> None: ...

    def close(self) -> None: ...
