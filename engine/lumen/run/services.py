"""Everything that an exhibition in this process consists of, found by its type."""

from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

from lumen.bus import connect
from lumen.bus.validated import validated
from lumen.language.events import Event
from lumen.language.modules import own_modules
from lumen.language.projects import Project
from lumen.run.claiming import presence_of
from lumen.run.live_behavior import LiveBehavior
from lumen.run.loop import Observer
from lumen.run.nap import Nap
from lumen.run.narrator import Narrator
from lumen.run.node import Node, NodeTime
from lumen.run.parts.added import AddedPart
from lumen.run.parts.part import Part
from lumen.run.parts.robot import RobotPart
from lumen.run.plan import Plan
from lumen.run.presence import BRAIN, MOTION, ROBOT_PART, Presence, host_of
from lumen.run.setup import Setup
from lumen.run.story import staged

EXHIBITION = "exhibition"
"""The sender of messages from an exhibition in one process."""

T = TypeVar("T")


class Services:
    """The bus, clock, node and narrator of an exhibition, its parts, and the objects that the parts provide.

    A part's maker finds earlier objects here: `services[LiveBehavior]`, or `services.get(RobotPart)` if that may be
    missing. Objects given to `provide` are found in the same way. Raises BusError if the bus can't be reached.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan, self.clock, self.nap = plan, plan.time, Nap()
        bus = connect(plan.bus, sender="+".join(plan.roles) or EXHIBITION) if isinstance(plan.bus, str) else plan.bus
        self.bus = validated(bus, plan.project, arrived=self.nap.end, failed=self.failed)
        self.narrator = plan.narrator or Narrator(self.clock.now, lambda: self.project.machine)
        self.presence = self._presence() if plan.shared else None
        self.node = Node(
            staged(plan.project, plan.story),
            self.bus,
            self.clock,
            self.narrator,
            presence=self.presence,
            nap=self.nap,
            before=plan.before,
            time_passes=NodeTime(plan.speed if plan.roles else None, plan.leaps, self._pace),
        )
        self.left_out: list[str] = []
        """The parts of packages that could not be made, each with its package.

        Other parts are notified of these when the exhibition begins.
        """
        self._provided: list[object] = []
        self._places: dict[Part, int] = {}

    def __getitem__(self, kind: type[T]) -> T:
        """Return the part or service of a kind. Raises LookupError if it is missing."""
        if (found := self.get(kind)) is None:
            raise LookupError(f"this process has no {kind.__name__}")
        return found

    def get(self, kind: type[T]) -> T | None:
        """Return the part or service of a kind, else None."""
        parts = (part.own if isinstance(part, AddedPart) else part for part in self.node.parts)
        return next((one for one in (*self._provided, *parts) if isinstance(one, kind)), None)

    def provide(self, *services: object) -> None:
        """Make these objects available by their types."""
        self._provided += services

    def add(self, place: int, *parts: Part) -> None:
        """Add parts after those of lower places and those already at this place.

        A part that `watches` observes the behaviour's steps, if the behaviour is in this process. Raises TypeError if
        such a part is not an `Observer`.
        """
        watching = [_observer(part) for part in parts if part.watches and self.plan.brain]
        self._places |= dict.fromkeys(parts, place)
        if watching:
            self.behavior.loop.observers += watching
        self.node.parts[:] = sorted([*self.node.parts, *parts], key=self._places.__getitem__)

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self.node.project

    @property
    def behavior(self) -> LiveBehavior:
        """The behaviour. Raises LookupError if another process has it."""
        return self[LiveBehavior]

    @property
    def setup(self) -> Setup:
        """The robot of this process. Raises LookupError if another process has it."""
        if self.plan.setup is None:
            raise LookupError("this process has no robot")
        return self.plan.setup

    @property
    def lasts(self) -> bool:
        """Whether this process keeps the run's files in a home.

        False for a story, for a process without a brain, and if another run holds the home or it can't be used.
        """
        directory = self.plan.options.get("directory")
        return bool(directory and directory.home) and self.plan.story is None

    @property
    def needs(self) -> tuple[str, ...]:
        """The parts for which the behaviour's parts wait: the robot, if it may be in another process."""
        return (ROBOT_PART,) if self.plan.roles else ()

    def tell(self, who: str) -> Callable[[str], None]:
        """Return a function that prints lines about a part."""
        return partial(self.narrator.line, who)

    def noticed(self, event: Event) -> None:
        """Pass an event of a robot here, whose brain is elsewhere, to all parts."""
        for part in self.node.parts:
            part.noticed(event)

    def part_stopped(self, part: str, fault: str) -> None:
        """Print why a part of a package was stopped, keep that for the end, and notify all other parts."""
        self.failed(fault)
        for other in self.node.parts:
            other.part_stopped(part)

    def failed(self, fault: str) -> None:
        """Print a fault of a package, and keep it for the end of the run; callable on any thread."""
        self.narrator.line("trouble", fault)
        self.node.faults.append(fault)

    def _presence(self) -> Presence:
        plan = self.plan
        here = tuple(name for name, said in plan.project.modules.items() if said.here and not said.own)
        own = own_modules(plan.project.modules)  # a program is announced only while it runs, its host always
        parts = [role for role in plan.roles if role not in own] if plan.roles else [ROBOT_PART, BRAIN, MOTION, *here]
        starts = plan.brain and plan.story is None
        parts += [host_of(name) for name, said in own.items() if name in plan.roles or (said.here and starts)]
        return presence_of(plan.project, self.bus, tuple(parts), self._said)

    def _said(self) -> dict[str, Any]:
        """Return the fields that this process adds to its presence."""
        robot = self.get(RobotPart)
        body: dict[str, Any] = {"bundle": self.project.hash}
        if self.plan.roles:
            body["speed"] = self.plan.speed
        for part in self.node.parts:
            body |= part.said
        if robot:
            body |= {"time": round(self.node.now, 3), "realtime": self.node.pace.realtime}
        return body

    def _pace(self, realtime: float) -> None:
        if behavior := self.get(LiveBehavior):
            behavior.trace.pace(realtime)


def _observer(part: Part) -> Observer:
    if not isinstance(part, Observer):
        raise TypeError(f"the part {type(part).__name__} watches the behaviour: derive it from Observer, too")
    return part
