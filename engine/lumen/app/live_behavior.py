"""A behaviour that runs, and goes on with another bundle where that is asked for."""

from collections.abc import Callable
from datetime import datetime

from lumen.app.setup import Setup
from lumen.interpreters.migration import MigrationPlan, MigrationVerdict
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Bus
from lumen.runtime.loop import BehaviorLoop
from lumen.runtime.story import staged
from lumen.runtime.trace_publisher import TracePublisher

MORNING = "10:00"
"""The time of day at which a story begins that does not say."""


class LiveBehavior:
    """A project's behaviour in its `loop`, on a robot, a bus and a clock.

    A story says which behaviour it is about, in which language and at what time of day it begins, and remembering
    what. `adopt` lets everything around the loop go by another bundle; it may raise BusError. Where it is `published`,
    the bus is told of each step.
    """

    def __init__(
        self, project: Project, setup: Setup, bus: Bus, story: Story | None = None, *, published: bool = True
    ) -> None:
        self._story = story
        self.loop = BehaviorLoop(staged(project, story), setup.robot, bus, setup.clock, setup.tracking)
        self.trace = TracePublisher(bus, lambda: self.loop.project, setup.clock.now)
        self.adopt: Callable[[Project], None] = lambda _: None
        if published:
            self.loop.observers.append(self.trace)

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self.loop.project

    def start(self, language: str = "") -> None:
        """Enter the initial states."""
        story = self._story
        self.loop.start(
            language=language or (story.language if story else ""),
            epoch=time_of_day((story.clock or MORNING) if story else ""),
            context=story.context if story else None,
        )

    def forget(self, person: PersonName) -> None:
        """Go on without somebody's name, and tell so."""
        if self.loop.runtime.forget(person):
            self.trace.standing(self.loop.runtime.snapshot)

    def plan(self, project: Project, *, now: bool = False, back: bool = False) -> MigrationVerdict:
        """How another bundle would go on from here, or why it can't; nothing changes."""
        return self.loop.plan(staged(project, self._story), now=now, back=back)

    def apply(self, project: Project, plan: MigrationPlan, begun: Callable[[], None] = lambda: None) -> None:
        """Go on with another bundle as planned for this moment; `begun` is called before what that asks for is done.

        Raises what `switch` raises.
        """
        old = self.project
        self.switch(project, plan)
        begun()
        self.loop.perform(plan, old)

    def switch(self, project: Project, plan: MigrationPlan) -> None:
        """Go on with another bundle, and leave undone what that asks for.

        Raises BusError where the bus refuses its routes, and whatever a fault of ours raises; nothing has changed then.
        """
        old, new = self.project, staged(project, self._story)
        try:
            self.adopt(new)
            self.loop.switch(new, plan)
        except Exception:
            self.adopt(old)
            raise


def time_of_day(clock: str = "") -> float:
    """`09:30`, or now on this machine's clock, in [s] since midnight."""
    if clock:
        hours, minutes = clock.split(":")
        return int(hours) * 3600.0 + int(minutes) * 60.0
    now = datetime.now()
    return now.hour * 3600.0 + now.minute * 60.0 + now.second
