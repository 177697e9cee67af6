"""A behaviour that runs, and switches to another bundle on request."""

import logging
import os
import time
from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Protocol

from lumen.clock.checked import ability
from lumen.errors import UsageError
from lumen.expressions.wall_clock import zone
from lumen.insight.migration import MigrationPlan, MigrationVerdict
from lumen.insight.replay.entries import JumpKind
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Bus, HasSpeed, RobotCommand
from lumen.run.loop import BRAIN_LOST_AFTER, BehaviorLoop
from lumen.run.setup import Setup
from lumen.run.story import staged
from lumen.run.story_time import story_epoch
from lumen.run.trace_publisher import TracePublisher
from lumen.run.wall_clock_watch import WallClockWatch, date_of_zero
from lumen.statechart.compiled_machine import prepare

_log = logging.getLogger(__name__)

_LINK, _NAME = Path("/etc/localtime"), Path("/etc/timezone")


def local_timezone() -> str:
    """Return the IANA name of this machine's time zone, or its present offset as `UTC+02:00` if the name is unknown."""
    wanted = os.environ.get("TZ", "").removeprefix(":")
    found = next((name for name in (wanted, _linked(), _named()) if name and _known(name)), "")
    if not found:
        offset = datetime.now().astimezone().strftime("%z")
        found = f"UTC{offset[:3]}:{offset[3:5]}"
    if wanted not in ("", found):
        _log.warning("TZ=%s is not a known time zone: times of day are in %s", wanted, found)
    return found


def _linked() -> str:
    try:
        return _LINK.resolve().as_posix().partition("/zoneinfo/")[2]
    except OSError:
        return ""


def _named() -> str:
    try:
        return _NAME.read_text(encoding="ascii").strip()
    except (OSError, UnicodeDecodeError):
        return ""


def _known(name: str) -> bool:
    try:
        zone(name)
    except UsageError:
        return False
    return True


class Forgetter(Protocol):
    """An object that may hold a person's name."""

    def forget(self, person: PersonName) -> None:
        """Delete everything that may contain the name."""
        ...


class LiveBehavior:
    """A project's behaviour in its `loop`, on a robot, a bus and a clock.

    A story sets the behaviour, the language, the time of day and the context at the start. `adopt` switches everything
    around the loop to another bundle, and may raise BusError. With `published` each step is sent to the bus. `refuse`
    returns why the robot may not begin a command; empty if it may. A gap between ticks of `patience` [s] on the clock
    raises `brain.lost`.
    """

    def __init__(
        self,
        project: Project,
        setup: Setup,
        bus: Bus,
        story: Story | None = None,
        *,
        published: bool = True,
        adopt: Callable[[Project], None] = lambda _: None,
        refuse: Callable[[RobotCommand], str] = lambda _: "",
        patience: float = BRAIN_LOST_AFTER,
    ) -> None:
        self._story, self._local_timezone = story, "" if story else local_timezone()
        paced = ability(setup.clock, HasSpeed)
        watch = WallClockWatch(self._timezone, real=story is None and paced is not None and paced.speed == 1.0)
        tracking, clock = setup.tracking, setup.clock
        self.loop = BehaviorLoop(staged(project, story), setup.robot, bus, clock, tracking, refuse, watch, patience)
        self.trace = TracePublisher(
            bus,
            lambda: self.loop.project,
            setup.clock.now,
            lambda: self.loop.runtime.steps,
            lambda: self.loop.step,
            lambda: self.loop.runtime.approvals.waiting,
        )
        self._adopt = adopt
        self.forgetters: list[Forgetter] = []
        """Objects that forget a person together with the behaviour."""
        if published:
            self.loop.observers.append(self.trace)

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self.loop.project

    def start(self, language: str = "") -> None:
        """Enter the initial states, in `language`, by default the story's, else the project's first."""
        story = self._story
        if story is None:
            prepare(self.project.machine)
        timezone = self._timezone()
        now = self.loop.clock.now
        self.loop.start(
            language=language or (story.language if story else ""),
            epoch=story_epoch(story, timezone) - now() if story else date_of_zero(now, time.time),
            timezone=timezone,
            context=story.context if story else None,
        )

    def forget(self, person: PersonName) -> None:
        """Remove a person's name from the behaviour and all forgetters, and publish the new snapshot."""
        for one in self.forgetters:
            one.forget(person)
        if self.loop.runtime.forget(person):
            self.trace.standing(self.loop.runtime.snapshot)

    def plan(self, project: Project, *, now: bool = False, back: bool = False) -> MigrationVerdict:
        """Return how another bundle would continue from here, or why it can't (`Runtime.plan`); nothing changes."""
        return self.loop.plan(staged(project, self._story), now=now, back=back)

    def apply(self, project: Project, plan: MigrationPlan, begun: Callable[[], None] = lambda: None) -> None:
        """Switch to another bundle as planned for this moment, and perform the plan's commands.

        `begun` is called between the switch and the commands. Raises the errors of `switch`.
        """
        old = self.project
        self.switch(project, plan)
        begun()
        self.loop.perform(plan, old)

    def switch(self, project: Project, plan: MigrationPlan, kind: JumpKind = "reload") -> None:
        """Switch to another bundle without performing the plan's commands.

        Raises BusError if the bus refuses its routes, and any internal error; then nothing has changed.
        """
        old, new = self.project, staged(project, self._story)
        try:
            self._adopt(new)
            self.loop.switch(new, plan, kind)
        except Exception:
            self._adopt(old)
            raise
        if self.trace in self.loop.observers and (plan.entered or plan.exited):
            self.trace.migrated(plan)

    def _timezone(self) -> str:
        """Return the project's time zone, else this machine's; for a story UTC, so that it runs the same everywhere."""
        return self.project.timezone or ("" if self._story else self._local_timezone)
