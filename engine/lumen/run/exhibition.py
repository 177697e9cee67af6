"""An exhibition in this process: opened, stepped or run, observed, reloaded, asked to stop, and closed."""

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
    """A whole exhibition, for a program that holds it: `start` it, then `tick` or `run`.

    It is made of a plan; `services` are all its parts, `node` is what ticks them. Raises BusError if the bus can't be
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
        """Whoever stands in the hall, to be made to `arrive`, `speak` and `leave`; None where there is no hall."""
        visitor = self.services.get(VisitorPart)
        return visitor.actor if visitor else None

    @property
    def player(self) -> StoryPlayer | None:
        """The player of its story, None without one."""
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
        """The robot, as it takes part."""
        return self.services[RobotPart]

    @property
    def brain(self) -> BrainPart:
        """The part that steps the behaviour."""
        return self.services[BrainPart]

    @property
    def reloader(self) -> Reloader | None:
        """The reloader of saved files, None without one."""
        return self.services.get(Reloader)

    @property
    def configuration(self) -> frozenset[str]:
        """The active states but the root, by alias where there is one, else by path."""
        return self.loop.runtime.snapshot.configuration

    @property
    def context(self) -> dict[str, Any]:
        """What the behaviour remembers."""
        return dict(self.loop.runtime.snapshot.context)

    @property
    def now(self) -> float:
        """The exhibition's time [s]."""
        return self.node.now

    @property
    def over(self) -> bool:
        """Whether its story is at its end, or it was interrupted."""
        return self.node.over

    def start(self) -> None:
        """Begin all parts: enter the initial states, or go on where the run before ended without notice.

        Raises UsageError where another process on the bus is this robot already.
        """
        start([self.services])

    def tick(self) -> float:
        """Live through a tick, a 50th of a second; its time [s]."""
        return self.node.tick()

    def run(self, seconds: float | None = None) -> float:
        """Live for so long [s], or until it is over; how long it lived [s]."""
        return self.node.run(seconds)

    def send(self, route: str, body: Mapping[str, Any]) -> None:
        """Send a message on a route, as a module would. Raises UsageError where there is none, or it is not allowed."""
        if reason := send(self.services.bus, self.project, route, body, MessageOrigin(sender=PROGRAM)):
            raise UsageError(f"can't send on `{route}`: {reason}")

    def say(self, text: str, language: str = "") -> None:
        """Let the robot say something, whatever the behaviour is doing."""
        said = Say(text, language)
        self.robot.robot.start("operator", said)
        self.robot.server.begins(said)

    def stop(self) -> None:
        """Let the robot rest, at once, and the behaviour hear of it (`stop`); nobody moves it until `resume`."""
        self.brain.rest(PROGRAM)

    def resume(self) -> None:
        """Let the robot move again, and the behaviour hear of it (`resume`), which may wake it.

        Where the behaviour knows no such event the robot stands up.
        """
        self.robot.server.resume(PROGRAM)

    def status(self) -> dict[str, Any]:
        """How it is, as `lumen status --format json` prints it."""
        return self.services[OperatorPart].status()

    def view(self) -> dict[str, Any]:
        """How it is and what can happen next, as `{"ask": "now"}` gets it over the bus: docs/processes.md."""
        return self.services[OperatorPart].now()

    def why(self, what: str = "", at: str | None = None) -> dict[str, Any]:
        """Why something happened, as `lumen why --format json` prints it; the last thing that did without `what`.

        `what` is a text that was said, a state, a motion or the id of a command; `at` an ISO 8601 time until which it
        happened. Raises UsageError, saying what to do, where it did not.
        """
        return answer(self.history(), WHY.ask, what, at)

    def why_not(self, what: str, at: str | None = None) -> dict[str, Any]:
        """Why something did not happen, as `lumen why-not --format json` prints it; raises as `why` does."""
        return answer(self.history(), WHY_NOT.ask, what, at)

    def history(self) -> list[RecordedStep]:
        """The steps of the last minutes, the oldest first: what `why` and `why_not` are answered from."""
        return self.services[OperatorPart].steps.steps()

    def observe(self, handler: Callable[[Step], None]) -> None:
        """Call this with each step from now on, in the order taken."""
        self.loop.observers.append(_StepHandler(handler))

    def reload(self) -> ReloadReport:
        """Take the files as they are on the disk; what came of it.

        Its `verdict` is `unchanged`, `applied`, `refused` (see `diagnostics`), or `waiting` for what the behaviour is
        doing: then it is applied at a later tick. Raises UsageError where it was opened without `reload`.
        """
        if self.reloader is None:
            raise UsageError('this exhibition was opened with reload="off", so it can\'t reload files')
        return self.reloader.reload(self.now)

    def close(self) -> None:
        """End what has threads, files or windows open."""
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
