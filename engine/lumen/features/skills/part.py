"""The exhibition's part that runs its robot's skills in a workshop."""

import threading
from collections.abc import Callable, Mapping
from typing import Any

from lumen.errors import BusError
from lumen.features.skills.workshop import Workshop, register
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.ports import Bus, PretendsSkills
from lumen.robot.robot_routes import publish_on
from lumen.run.live_behavior import LiveBehavior
from lumen.run.parts.part import Part
from lumen.run.services import Services
from lumen.run.status import SKILL_STATES
from lumen.upkeep.threads import WatchedThread

LOOK_PERIOD = 0.5
"""The time between two checks of the skills' code for changes [s]."""
TROUBLE_ROUTE, TROUBLE_TTL = "trouble", 10.0
FAILED = "error.execution"
REAL_SKILLS = "real_skills"
"""The plan's option that lets a story run the skills' code."""


class SkillsPart(Part):
    """Manages the skills' processes for the robot's calls, and starts those of `warm` skills."""

    name = "skills"
    patient = True

    def __init__(
        self,
        project: Project,
        bus: Bus,
        tell: Callable[[str, str], None],
        happen: Callable[[Event], None] = lambda event: None,
    ) -> None:
        self._bus, self._tell, self._happen = bus, tell, happen
        self.workshop = Workshop(project, bus, tell, self._report, self._failed)
        self._unregister = register(self.workshop)
        self._ending = threading.Event()
        self._thread = WatchedThread("lumen-skills", self._look)
        self._begun = False

    @property
    def said(self) -> Mapping[str, Any]:
        """The skills' states, and the hashes of their code for comparing two houses; empty without skills."""
        hashes, states = self.workshop.hashes, self.workshop.states
        return {**({"skills": hashes} if hashes else {}), **({SKILL_STATES: states} if states else {})}

    def begin(self, now: float) -> None:
        self._begun = True
        self._look_after(self.workshop.project)

    def use(self, project: Project) -> None:
        self.workshop.use(project)
        self._look_after(project)

    def _look_after(self, project: Project) -> None:
        """Start watching the skills' code, if the project has skills and the part has begun."""
        if self._begun and project.verbs and not self._thread.started:
            self._thread.start()

    def close(self) -> None:
        self._ending.set()
        self._unregister()
        self.workshop.close()
        if self._thread.started:
            self._thread.join(1.0)

    def _look(self) -> None:
        """Check the skills' code for changes until the part closes."""
        while not self._ending.is_set():
            self.workshop.look()
            self._ending.wait(LOOK_PERIOD)

    def _failed(self, skill: str, reason: str) -> None:
        """Raise an event about a failed call, in addition to the `onError` of a `do` that waited for it."""
        self._happen(Event(FAILED, {"skill": skill, "reason": reason}))

    def _report(self, skill: str, text: str) -> None:
        self._tell(skill, text)
        try:
            body = {"module": f"skill {skill}", "text": text[:500]}
            publish_on(self._bus, self.workshop.project, TROUBLE_ROUTE, body, ttl=TROUBLE_TTL)
        except BusError:
            pass  # the line above is printed in any case


class PretendedSkillsPart(Part):
    """Replaces SkillsPart if no skill's code runs, as in a story; prints a note if the robot is real."""

    name = "skills"
    patient = True

    def __init__(self, project: Project, tell: Callable[[str, str], None], *, real: bool) -> None:
        self._names = ", ".join(f"`{name}`" for name in project.verbs)
        self._tell, self._real = tell, real
        self._unregister = register(project)

    def begin(self, now: float) -> None:
        if self._real:
            self._tell("skills", f"a story does not run their code: the robot only waits during {self._names}")

    def close(self) -> None:
        self._unregister()


def skills(services: Services) -> Part | None:
    """Make the part; without REAL_SKILLS, a story or a recording robot runs no skill's code.

    Return None if no code runs and the project has no skills.
    """
    plan = services.plan
    hall = services.setup.hall
    simulated = isinstance(hall, PretendsSkills)
    pretends = plan.story is not None or (isinstance(hall, PretendsSkills) and hall.runs_no_skills)
    if pretends and not plan.options.get(REAL_SKILLS):
        project = services.project
        return PretendedSkillsPart(project, services.narrator.line, real=not simulated) if project.verbs else None
    if (behavior := services.get(LiveBehavior)) is None:
        return SkillsPart(services.project, services.bus, services.narrator.line)
    return SkillsPart(services.project, services.bus, services.narrator.line, lambda event: behavior.loop.happen(event))
