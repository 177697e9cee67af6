"""An exhibition inside a Python program."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import TracebackType
from typing import Any, Self

from lumen.errors import UsageError
from lumen.insight.explaining import RecordedStep
from lumen.language.causes import PROGRAM, MessageOrigin
from lumen.language.commands import Say
from lumen.language.operator_requests import WHY, WHY_NOT
from lumen.language.projects import Project
from lumen.run.answering import answer
from lumen.run.compose import compose, start
from lumen.run.live_behavior import LiveBehavior
from lumen.run.loop import BehaviorLoop, Observer
from lumen.run.parts.brain import BrainPart
from lumen.run.parts.operating import OperatorPart
from lumen.run.parts.robot import RobotPart
from lumen.run.parts.visitor import VisitorPart
from lumen.run.plan import Plan
from lumen.run.reload.reloader import Reloader
from lumen.run.reload.report import ReloadReport
from lumen.run.sending import send
from lumen.run.story import StoryPlayer
from lumen.run.visitor import VisitorActor
from lumen.statechart import Step


class Exhibition:
    """A whole exhibition, held by a program that calls `start`, and then `tick` or `run`.

    It is made from a plan; `services` are its parts, and `node` ticks them. Raises BusError if the bus can't be
    reached.
    """

    def __init__(self, plan: Plan) -> None:
        self.services = compose(replace(plan, options={"operated": True, **plan.options}))
        self.node = self.services.node

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self.node.project

    @property
    def visitor(self) -> VisitorActor | None:
        """The visitor in the hall, to control by `arrive`, `speak` and `leave`; None if there is no hall."""
        visitor = self.services.get(VisitorPart)
        return visitor.actor if visitor else None

    @property
    def player(self) -> StoryPlayer | None:
        """The player of the exhibition's story; None if it has no story."""
        visitor = self.services.get(VisitorPart)
        return visitor.player if visitor else None

    @property
    def behavior(self) -> LiveBehavior:
        """The behaviour that runs."""
        return self.services.behavior

    @property
    def loop(self) -> BehaviorLoop:
        """The loop of the behaviour."""
        return self.behavior.loop

    @property
    def robot(self) -> RobotPart:
        """The part that runs the robot."""
        return self.services[RobotPart]

    @property
    def brain(self) -> BrainPart:
        """The part that steps the behaviour."""
        return self.services[BrainPart]

    @property
    def reloader(self) -> Reloader | None:
        """The reloader of saved files; None if saved files are ignored."""
        return self.services.get(Reloader)

    @property
    def configuration(self) -> frozenset[str]:
        """The active states except the root, by alias if there is one, else by path."""
        return self.loop.runtime.snapshot.configuration

    @property
    def context(self) -> dict[str, Any]:
        """A copy of the behaviour's context."""
        return dict(self.loop.runtime.snapshot.context)

    @property
    def now(self) -> float:
        """The exhibition's time [s]."""
        return self.node.now

    @property
    def over(self) -> bool:
        """Whether the story has ended, or the run was interrupted."""
        return self.node.over

    def start(self) -> None:
        """Begin all parts: enter the initial states, or continue where the previous run crashed.

        Raises UsageError if another process on the bus already is this robot.
        """
        start([self.services])

    def tick(self) -> float:
        """Run one tick, a 50th of a second; return its time [s]."""
        return self.node.tick()

    def run(self, seconds: float | None = None) -> float:
        """Run until the exhibition is over, for at most `seconds` [s] (None: no limit); return how long it ran [s]."""
        return self.node.run(seconds)

    def send(self, route: str, body: Mapping[str, Any]) -> None:
        """Send a message on a route, as a module would.

        Raises UsageError if there is no such route, or the body is not allowed on it.
        """
        if reason := send(self.services.bus, self.project, route, body, MessageOrigin(sender=PROGRAM)):
            raise UsageError(f"can't send on `{route}`: {reason}")

    def say(self, text: str, language: str = "") -> None:
        """Make the robot say a text, independently of the behaviour.

        Without a language, the robot's current language is used.
        """
        said = Say(text, language)
        self.robot.robot.start("operator", said)
        self.robot.server.begins(said)

    def stop(self) -> None:
        """Make the robot rest at once and raise `stop` in the behaviour; no motion is possible until `resume`."""
        self.brain.rest(PROGRAM)

    def resume(self) -> None:
        """Allow motions again and raise `resume` in the behaviour, which may wake the robot.

        If the behaviour does not use `resume`, the robot stands up.
        """
        self.robot.server.resume(PROGRAM)

    def status(self) -> dict[str, Any]:
        """Return the state of the exhibition, as `lumen status --format json` prints it."""
        return self.services[OperatorPart].status()

    def view(self) -> dict[str, Any]:
        """Return the state and possible next events, as `{"ask": "now"}` does over the bus: docs/deployment.md."""
        return self.services[OperatorPart].now()

    def why(self, what: str = "", at: str | None = None) -> dict[str, Any]:
        """Return why something happened, as `lumen why --format json` prints it.

        `what` is a text that was said, a state, a motion or the id of a command; without it the last thing that
        happened is explained. `at` is an ISO 8601 time: only what happened until then counts. Raises UsageError, with
        advice, if it did not happen.
        """
        return answer(self.history(), WHY.ask, what, at)

    def why_not(self, what: str, at: str | None = None) -> dict[str, Any]:
        """Return why something did not happen, as `lumen why-not --format json` prints it; raises as `why` does."""
        return answer(self.history(), WHY_NOT.ask, what, at)

    def history(self) -> list[RecordedStep]:
        """Return the steps of the last minutes, the oldest first; `why` and `why_not` use them."""
        return self.services[OperatorPart].steps.steps()

    def observe(self, handler: Callable[[Step], None]) -> None:
        """Call `handler` with each step from now on, in order."""
        self.loop.observers.append(_StepHandler(handler))

    def reload(self) -> ReloadReport:
        """Reload the files from disk, and return a report.

        Its `verdict` is `unchanged`, `applied`, `refused` (see `diagnostics`), or `waiting` while the behaviour is
        busy: the files are then applied at a later tick. Raises UsageError if the exhibition was opened without
        `reload`.
        """
        if self.reloader is None:
            raise UsageError('this exhibition was opened with reload="off", so it can\'t reload files')
        return self.reloader.reload(self.now)

    def close(self) -> None:
        """Close the exhibition with its threads, files and windows."""
        self.node.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class _StepHandler(Observer):
    def __init__(self, handler: Callable[[Step], None]) -> None:
        self._handler = handler

    def stepped(self, step: Step) -> None:
        self._handler(step)
