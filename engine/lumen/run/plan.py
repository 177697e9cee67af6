"""The plan of an exhibition in this process, or of some parts of an exhibition, before anything is made."""

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
    """One robot's exhibition in this process: all of it, or the `roles` of one process of several."""

    project: Project
    """The bundle to run."""
    setup: Setup | None = None
    """The robot; None if another process has it."""
    bus: str | Bus = "memory://"
    """The address of the bus, or an open bus, which is closed with the exhibition."""
    story: Story | None = None
    """The story that the visitor plays; None without a story."""
    narrator: Narrator | None = None
    """Prints what happens; None for a silent run."""
    roles: tuple[str, ...] = ()
    """The roles of this process; empty for a whole exhibition."""
    clock: Clock | None = None
    """The clock, if there is no `setup`."""
    language: str = ""
    """The language that the robot speaks first; empty for the project's."""
    speed: float = 1.0
    """The multiple of real time of one process of several; the others must have the same."""
    silent: bool = False
    """Whether to publish nothing of the behaviour, and only the senses that it uses."""
    leaps: bool = False
    """Whether to skip ticks in which nothing happens."""
    before: Sequence[Callable[[float], None]] = ()
    """Functions that are called at each tick with its time [s], before the parts."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Further settings, by the names in the rows of parts."""

    @property
    def url(self) -> str:
        """The address of the bus; for an open bus that of the embedded one."""
        return self.bus if isinstance(self.bus, str) else "memory://"

    @property
    def shared(self) -> bool:
        """Whether other processes can connect to the bus."""
        return bool(self.roles) or not within_process(self.url)

    @property
    def brain(self) -> bool:
        """Whether the behaviour runs in this process."""
        return not self.roles or BRAIN in self.roles

    @property
    def time(self) -> Clock:
        """The robot's clock, else the plan's. Raises ValueError if there is neither."""
        clock = self.setup.clock if self.setup else self.clock
        if clock is None:
            raise ValueError("a plan needs a robot or a clock")
        return clock

    def meets(self, condition: str) -> bool:
        """Return whether a condition of a part's row holds (`PartRow.when`). Raises ValueError if it is unknown."""
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
