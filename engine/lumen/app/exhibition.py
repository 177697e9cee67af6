"""An exhibition in this process: opened, stepped or run, observed, reloaded, asked to stop, and closed."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from lumen.app.alerts.desk import AlertDesk
from lumen.app.answering import answer
from lumen.app.narrator import Narrator
from lumen.app.parts.alerting import AlertPart
from lumen.app.parts.forgetting import ForgettingPart
from lumen.app.parts.kept_hold import keep_hold
from lumen.app.parts.operating import OperatorPart
from lumen.app.parts.recording import RecordingPart
from lumen.app.recovery.recording import record_inputs
from lumen.app.recovery.run_directory import RunDirectory
from lumen.app.reload.alerting import RefusalPart
from lumen.app.reload.records import RunRecords
from lumen.app.reload.reloader import Reloader
from lumen.app.reload.report import ReloadReport
from lumen.app.reload.saved_files import RecordsPart, ReloadPart
from lumen.app.setup import Setup
from lumen.app.whole_node import WholeNode
from lumen.bus import connect
from lumen.buses.validated import ValidatedBus, validated
from lumen.errors import UsageError
from lumen.interpreters.bounds import analyse
from lumen.interpreters.explaining import RecordedStep
from lumen.interpreters.statechart import Step
from lumen.language.causes import PROGRAM, MessageOrigin
from lumen.language.commands import Say
from lumen.language.operator_requests import WHY, WHY_NOT
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.loading.project_folders import FLEET_FILE
from lumen.ports import Bus
from lumen.robots.deduplication_log import DEDUPLICATION_FILE, DeduplicationLog
from lumen.runtime.home import home_of
from lumen.runtime.loop import Observer
from lumen.runtime.presence import BRAIN, ROBOT_PART
from lumen.runtime.resuming import FreshStart, Resumption
from lumen.runtime.sending import send
from lumen.runtime.visitor import VisitorActor

EXHIBITION = "exhibition"
"""The sender of what the parts of an exhibition in one process say."""


class Exhibition:
    """A project on a robot, a bus and a clock: all its parts are in `node`. `start` it, then `tick` or `run`.

    With a story, its visitor plays it. `narrator` is called with what happens. Its files can be reloaded where `reload`
    says how saved ones are taken (`auto`, `manual`, `off`). With a `run_directory` other terminals reach it, and it
    goes on where the run before ended without notice, unless it is to begin `fresh`. `alerts` has people told of what
    goes wrong, and is closed with it. What is said on its bus is recorded into the file `record`. Raises BusError where
    the bus can't be reached.
    """

    def __init__(
        self,
        project: Project,
        setup: Setup,
        bus: str | Bus = "memory://",
        story: Story | None = None,
        narrator: Narrator | None = None,
        *,
        run_directory: RunDirectory | None = None,
        reload: str = "",
        language: str = "",
        fresh: bool = True,
        alerts: AlertDesk | None = None,
        record: Path | None = None,
    ) -> None:
        url = bus if isinstance(bus, str) else "memory://"
        shared = not url.startswith("memory:")
        opened = validated(connect(bus, sender=EXHIBITION) if isinstance(bus, str) else bus, project)
        directory, fresh = run_directory, fresh or story is not None
        records = directory.records if directory else RunRecords(None)
        lasts = directory is not None and directory.home is not None and story is None

        def recover() -> Resumption | FreshStart:
            assert directory
            found = directory.begin_run(behavior, url, self.reloader, fresh=fresh)
            self._operator.recover(records.decisions(), resumed=isinstance(found, Resumption))
            return watch.recovered(found) if watch else found

        self.node = WholeNode(
            project,
            setup,
            opened,
            story,
            narrator,
            language=language,
            shared=shared,
            recover=recover if directory else FreshStart,
            record=records.write if lasts else lambda _: None,
        )
        behavior = self.node.behavior
        self.reloader: Reloader | None = None
        self.node.add(ForgettingPart(project, opened, behavior.forget, records.forget))
        journal = record_inputs(behavior, records, story=story, rehearsed=story is not None or directory is None)
        self.node.closing.append(records.close_inputs)
        if reload:
            taken_by = directory.reloader if directory else Reloader
            self.reloader = taken_by(behavior, self.node.narrator, mode=reload)
            self.node.add(ReloadPart(self.reloader))
            if directory and story is None and (directory.root / FLEET_FILE).exists():
                from lumen.app.fleet.part import fleet_part  # few exhibitions are of a fleet

                tell = partial(self.node.narrator.line, "fleet")
                agent = fleet_part(directory.root, opened, behavior, self.reloader, directory.home, tell)
                self.node.add(*([agent] if agent else []))
        self._operator = OperatorPart(
            behavior,
            self.node.narrator,
            journal,
            stopped=lambda: self.node.robot.server.hold.stopped,
            realtime=lambda: self.node.pace.realtime,
            reloaded=lambda: self.reloader.last_reload if self.reloader else None,
            record=directory.records.write if directory else lambda _: None,
            keep=records.keep_decisions,
            marking=lambda: recording.marking() if recording else "",
        )
        self.node.add(self._operator)
        recording: RecordingPart | None = None
        if directory:
            tell = partial(self.node.narrator.line, "recording")
            ring = directory.home is not None and story is None
            recording = RecordingPart(project, opened, tell, record, ring=ring, patient=story is not None)
            self.node.parts.insert(0, recording)

        def kept() -> str:
            return records.trouble or (recording.trouble if recording else "")

        watch = self._alert(alerts, opened, kept) if alerts else None
        if directory:
            if story is None:
                analyse(project.motions.values(), project.body)
                self.node.parts.append(RecordsPart(directory.records, behavior))
                if directory.home:
                    keep_hold(self.node.robot.server.hold, directory.home.folder)
                    self._operator.model.keep(directory.home.folder)
            if shared:
                log = DeduplicationLog(home_of(directory.root, project.one_of_several) / DEDUPLICATION_FILE)
                self.node.robot.server.recall(log)

    def _alert(self, desk: AlertDesk, bus: ValidatedBus, kept: Callable[[], str]) -> AlertPart:
        """Have people told of what goes wrong."""
        root = Path(self.node.project.root)
        parts, presence = (ROBOT_PART, BRAIN), self.node.presence
        watch = AlertPart(desk, bus, home_of(root, self.node.project.one_of_several), parts, presence, kept)
        self.node.loop.observers.append(watch)
        self.node.add(watch, *([RefusalPart(self.reloader, desk)] if self.reloader else []))
        return watch

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self.node.project

    @property
    def visitor(self) -> VisitorActor | None:
        """Whoever stands in the hall, to be made to `arrive`, `speak` and `leave`; None where there is no hall."""
        return self.node.visitor.actor if self.node.visitor else None

    @property
    def configuration(self) -> frozenset[str]:
        """The active states but the root, by alias where there is one, else by path."""
        return self.node.loop.runtime.snapshot.configuration

    @property
    def context(self) -> dict[str, Any]:
        """What the behaviour remembers."""
        return dict(self.node.loop.runtime.snapshot.context)

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
        self.node.begin()

    def tick(self) -> float:
        """Live through a tick, a 50th of a second; its time [s]."""
        return self.node.tick()

    def run(self, seconds: float | None = None) -> float:
        """Live for so long [s], or until it is over; how long it lived [s]."""
        return self.node.run(seconds)

    def send(self, route: str, body: Mapping[str, Any]) -> None:
        """Send a message on a route, as a module would. Raises UsageError where there is none, or it is not allowed."""
        if reason := send(self.node.bus, self.project, route, body, MessageOrigin(sender=PROGRAM)):
            raise UsageError(f"can't send on `{route}`: {reason}")

    def say(self, text: str, language: str = "") -> None:
        """Let the robot say something, whatever the behaviour is doing."""
        said = Say(text, language)
        self.node.setup.robot.start("operator", said)
        self.node.robot.server.begins(said)

    def stop(self) -> None:
        """Let the robot rest, at once, and the behaviour hear of it (`stop`); nobody moves it until `resume`."""
        self.node.brain.rest(PROGRAM)

    def resume(self) -> None:
        """Let the robot move again, and the behaviour hear of it (`resume`), which may wake it.

        Where the behaviour knows no such event the robot stands up.
        """
        self.node.robot.server.resume(PROGRAM)

    def status(self) -> dict[str, Any]:
        """How it is, as `lumen status --format json` prints it."""
        return self._operator.status()

    def view(self) -> dict[str, Any]:
        """How it is and what can happen next, as `{"ask": "now"}` gets it over the bus: docs/processes.md."""
        return self._operator.now()

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
        return self._operator.steps.steps()

    def observe(self, handler: Callable[[Step], None]) -> None:
        """Call this with each step from now on, in the order taken."""
        self.node.loop.observers.append(_StepHandler(handler))

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
