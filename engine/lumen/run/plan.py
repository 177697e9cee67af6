"""The plan of an exhibition in this process, or of a part of one, before anything of it is made."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lumen.bus.addresses import within_process
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Bus, Clock
from lumen.run.narrator import Narrator
from lumen.run.presence import BRAIN
from lumen.run.setup import Setup


@dataclass(frozen=True, slots=True)
class Plan:
    """One robot's exhibition in this process: all of it, or the `roles` of one process of several.

    `setup` is the robot, None if another process has it; then `clock` is the time. With a `story` its visitor plays it.
    The bus is an address or an open bus, which ends with the exhibition. `narrator` prints what happens. `language` is
    the one that the robot speaks first, empty for the project's. `speed` is a multiple of real time for one process of
    several, whose others have to have the same.

    A `silent` one publishes nothing of the behaviour, and of the senses only those that the behaviour hears of. With
    `leaps` it passes over ticks in which nothing happens. The functions in `before` are called at each tick with its
    time [s], before the parts. `options` has the other wishes, by the names in the rows of parts.
    """

    project: Project
    setup: Setup | None = None
    bus: str | Bus = "memory://"
    story: Story | None = None
    narrator: Narrator | None = None
    roles: tuple[str, ...] = ()
    clock: Clock | None = None
    language: str = ""
    speed: float = 1.0
    silent: bool = False
    leaps: bool = False
    before: Sequence[Callable[[float], None]] = ()
    options: Mapping[str, Any] = field(default_factory=dict)

    @property
    def url(self) -> str:
        """The address of the bus; for an open bus that of the embedded one."""
        return self.bus if isinstance(self.bus, str) else "memory://"

    @property
    def shared(self) -> bool:
        """Whether other processes are on the bus."""
        return bool(self.roles) or not within_process(self.url)

    @property
    def brain(self) -> bool:
        """Whether the behaviour runs in this process."""
        return not self.roles or BRAIN in self.roles

    @property
    def time(self) -> Clock:
        """The clock of the robot, else the one of the plan. Raises ValueError if there is none."""
        clock = self.setup.clock if self.setup else self.clock
        if clock is None:
            raise ValueError("a plan needs a robot or a clock")
        return clock

    def meets(self, condition: str) -> bool:
        """Return whether a condition of a part's row holds (`PartRow.when`)."""
        kind, _, name = condition.partition(":")
        match kind:
            case "whole":
                return not self.roles
            case "brain":
                return self.brain
            case "follows":
                return not self.brain
            case "role":
                return name in self.roles
            case "section":
                return name in self.project.sections
            case "file":
                return (Path(self.project.root) / name).exists()
            case "option":
                return bool(self.options.get(name))
        raise ValueError(f"there is no condition `{condition}`")
