"""The loop of a running behaviour: the order of things, fifty times a second."""

from collections.abc import Callable, Mapping, Sequence
from datetime import date
from math import inf
from typing import Any, Protocol

from lumen.expressions.wall_clock import local_time, moment
from lumen.insight.explaining.pressing import pressed
from lumen.insight.migration import MigrationPlan, MigrationVerdict
from lumen.insight.replay.entries import JumpKind
from lumen.language.approvals import Autonomy
from lumen.language.causes import Cause
from lumen.language.commands import Command, GoTo, Move, Play, Posture, Rest, Start, Track, Wake, Walk
from lumen.language.events import CUE, RECORDED, Event
from lumen.language.gestures import NO_GESTURES, merged
from lumen.language.life import STILL_STYLE
from lumen.language.projects import Project
from lumen.motion.life import gestures_wanted, style_name
from lumen.ports import Bus, Clock, Live, Robot, RobotCommand
from lumen.run.cues import MotionCues
from lumen.run.inbox import Inbox
from lumen.run.performer import Performer
from lumen.run.questions import Questions
from lumen.run.regulation import Regulation
from lumen.run.resuming import Resumption
from lumen.run.runtime import Runtime
from lumen.run.shared_board import SharedBoard
from lumen.run.tracking import LocalTracking, TrackingService
from lumen.run.troubles import RunTrouble, trouble_of_answer, troubles_of_step
from lumen.run.wall_clock_watch import WallClockWatch
from lumen.statechart import Snapshot, Step, due
from lumen.statechart.offers import offers

REMIND_PERIOD = 5.0
"""How long after the last time the robot is told again [s]: one that was restarted meanwhile has forgotten it."""

_STILL = Live(STILL_STYLE)


class LifeDirector:
    """Watches where the behaviour stands. It takes no part in its steps, so that journals know nothing of it."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._told, self._wanted = _STILL, _STILL
        self._told_at = 0.0
        self._seen: tuple[object, object] = (None, None)

    def tick(self, project: Project, snapshot: Snapshot, now: float) -> None:
        """Tell the robot where that is something else, or a file has changed; and again now and then."""
        if self._seen[0] is not project or self._seen[1] != snapshot.configuration:
            self._seen = project, snapshot.configuration
            self._wanted = _wanted(project, snapshot)
        reminds = self._wanted is not _STILL and now >= self._told_at + REMIND_PERIOD
        if self._wanted != self._told or reminds:
            self._told, self._told_at = self._wanted, now
            self._robot.start("", self._wanted)


def _wanted(project: Project, snapshot: Snapshot) -> Live:
    style = project.life.get(style_name(project.machine, snapshot.configuration))
    if style is None:
        return _STILL
    speaks = gestures_wanted(project.machine, snapshot.configuration)
    return Live(style, merged(project.gestures) if speaks else NO_GESTURES)


_BY_PEOPLE = ("stop", "resume")
_FROM_THE_START = ("lost.command.", "brain.lost")
"""What is told where the behaviour was away, and goes on."""


def caused(event: Event) -> Event:
    """The event with its cause, which is left as it is where somebody has named one."""
    return event if event.cause else event._replace(cause=_cause(event))


def _cause(event: Event) -> Cause:
    _, separator, command = event.name.partition(".command.")
    if event.name.startswith(_FROM_THE_START):
        return Cause("start", command)
    if separator:
        return Cause("command", command)
    if event.name in _BY_PEOPLE:
        by = event.data.get("by", "") if isinstance(event.data, dict) else ""
        return Cause("person", sender=str(by))
    return Cause("robot")


TICK_PERIOD = 0.02
BRAIN_LOST_AFTER = 5.0
NOTHING_WAITS = "nothing is waiting for approval"
CAUSES = ("stop", "brain.lost", "robot.lost")
"""Events that the behaviour gets before the failures that they cause: a stop cancels what the robot does."""


class Observer:
    """Somebody who watches: called for everything as it happens, and changing nothing of it."""

    def stepped(self, step: Step) -> None:
        """The behaviour took a step."""

    def performing(self, command: Command, now: float) -> None:
        """A command is about to be performed."""

    def refused(self, command: Start, reason: str) -> None:
        """A command of the behaviour is not performed because a person keeps the robot still."""

    def answered(self, event: Event) -> None:
        """The robot answered a command, or noticed something; the behaviour has not heard of it yet."""

    def troubled(self, trouble: RunTrouble) -> None:
        """A trouble occurred: the run no longer counts as successful."""


class Rescuer(Protocol):
    """A handler of faults that may switch to another bundle."""

    def rescue(self, error: Exception) -> Sequence[Command] | None:
        """Switch to another bundle, and return the commands for that; None to let the fault end the run."""
        ...


class BehaviorLoop:
    """A project on a robot, a bus and a clock.

    At each tick: the clock waits, tracking lives, what happened becomes events, the behaviour steps, its commands are
    performed; `observers` are called. Where ticks stop for `patience` [s] of the clock the behaviour gets the event
    `brain.lost`. If a tick fails for a fault of the bundle or of ours, one of the `rescuers` may switch to
    another bundle.
    `tracking` lets controllers follow what is seen; without one that is done here. `refuse` returns the reason why the
    robot may not begin a command, empty if it may. `rests` is whether the behaviour has
    let the robot rest. `wall_clock` says where the time of day has become another. `step` is the number of the step
    whose commands are being performed (`Runtime.steps`).
    """

    def __init__(
        self,
        project: Project,
        robot: Robot,
        bus: Bus,
        clock: Clock,
        tracking: TrackingService | None = None,
        refuse: Callable[[RobotCommand], str] = lambda _: "",
    ) -> None:
        self.robot, self.bus, self.clock = robot, bus, clock
        self.observers: list[Observer] = []
        self.rescuers: list[Rescuer] = []
        self.wall_clock: WallClockWatch | None = None
        self.runtime = Runtime(project, self._stepped, self._rescued, self._dropped)
        self.inbox, self.board = Inbox(bus), SharedBoard(bus)
        self.tracking: TrackingService = tracking or LocalTracking(project, robot, bus)
        self.regulation = Regulation(project, bus)
        questions = Questions(bus, self._today, lambda: offers(self.project.machine, self.runtime.snapshot))
        self.performer = Performer(robot, bus, self._track, refuse, questions)
        self._cues = MotionCues()
        self._life = LifeDirector(robot)
        self._events: list[Event] = []
        self._last = clock.now()
        self.patience = BRAIN_LOST_AFTER
        self.rests = False
        self.step = 0
        self._lost_at = -inf

    @property
    def project(self) -> Project:
        return self.runtime.project

    def start(
        self,
        *,
        language: str = "",
        epoch: float = 0.0,
        timezone: str = "",
        context: Mapping[str, Any] | None = None,
    ) -> None:
        """Listen, and enter the initial states; `context` gives keys of the context other first values."""
        self._last = self.clock.now()
        self._listen(self.project)
        first = self.runtime.start(self._last, language=language, epoch=epoch, timezone=timezone, context=context)
        self._perform(first, self._last)

    def resume(self, resumption: Resumption) -> None:
        """Listen, and go on from where this project's behaviour stood before the engine was away."""
        self._last = self.clock.now()
        self._listen(self.project)
        self.runtime.apply(self.project, resumption.snapshot, "resume", resumption.commands)
        for name in resumption.tracking:
            self._track(Track(name))
        self._perform(resumption.commands, self._last)
        if resumption.away > BRAIN_LOST_AFTER:
            self._lose(resumption.away)
        self._events += resumption.answers(self._last)

    def happen(self, event: Event) -> None:
        """Let something happen at the next tick."""
        self._events.append(event)

    def approve(self, by: str, *, go: bool) -> str:
        """Decide what waits longest for a person; why that can't be, empty where it can."""
        return "" if self.runtime.approvals.decide("", by, go=go) else NOTHING_WAITS

    def set_autonomy(self, level: Autonomy, by: str) -> None:
        """Whether marked transitions wait for GO."""
        self.runtime.approvals.set(level, by)

    def press(self, label: str, by: str) -> str:
        """Let the event of a button happen at the next tick; why that can't be, empty where it can."""
        found = pressed(self.project.machine, self.runtime.snapshot, label, self.clock.now(), by)
        if isinstance(found, str):
            return found
        self.happen(found)
        return ""

    def tick(self, now: float | None = None) -> float:
        """Live through one tick at `now` [s], where nobody says so a period after the last; its time [s]."""
        if now is None:
            self.clock.wait(self._last + TICK_PERIOD)
            now = self.clock.now()
        if now - self._last > self.patience:
            self._lose(now - self._last)
        self._last = now
        try:
            self.tracking.tick(now)
            self._regulate(now)
        except Exception as error:
            self._recover(error, now)
        for emission in self.runtime.advance(now, self._gather(now)):
            self._perform(emission.commands, now, step=emission.step)
        self.board.tell(self.runtime.snapshot, now)
        self._life.tick(self.project, self.runtime.snapshot, now)
        return now

    @property
    def waiting(self) -> int:
        """How many events wait for the next tick."""
        return len(self._events) + len(self.performer.events) + len(self.inbox)

    def take(self, step: Step) -> None:
        """Go on with a step from where the behaviour stands, which nobody else made, and perform its commands."""
        self._perform(self.runtime.take(step), self._last)

    def quiet_until(self, now: float) -> float:
        """Until when nothing happens unless something comes from outside [s]; `now` where that is not known."""
        pending = self._events or self.performer.events or not (self.inbox.empty and self.performer.questions.empty)
        pending = pending or not self.board.empty
        if pending or self.tracking.on or self.performer.navigator.busy:
            return now
        event = due(self.runtime.snapshot)
        return max(now, min(event.at if event else inf, self.runtime.approvals.due, self.board.due))

    def leap(self, now: float) -> None:
        """It is `now` [s] after a time in which nothing happened."""
        self._last = now
        self.performer.navigator.leap(now)

    def plan(self, project: Project, *, now: bool = False, back: bool = False) -> MigrationVerdict:
        """How another bundle would go on from here, or why it can't; nothing changes."""
        return self.runtime.plan(project, self._last, now=now, back=back)

    def apply(self, project: Project, plan: MigrationPlan) -> None:
        """Go on with another bundle as planned for this moment, between two macrosteps; what that asks for is done."""
        old = self.project
        self.switch(project, plan)
        self.perform(plan, old)

    def switch(self, project: Project, plan: MigrationPlan, kind: JumpKind = "reload") -> None:
        """What `apply` does, but for what has to be performed.

        Raises BusError where the bus refuses its routes, and whatever a fault of ours raises; nothing has changed then.
        """
        old = self.project
        try:
            self._listen(project)
            self.tracking.reload(project)
            self.regulation.reload(project)
            self.performer.navigator.renew()
            self.runtime.apply(project, plan.snapshot, kind, plan.commands)
        except Exception:
            self._listen(old)
            self.tracking.reload(old)
            self.regulation.reload(old)
            raise

    def perform(self, plan: MigrationPlan, old: Project) -> None:
        """Do what a plan asks for that has been switched to: what is left is left by the old bundle."""
        self._perform(plan.leaving, self._last, old)
        self._perform(plan.entering, self._last)

    def _rescued(self, error: Exception) -> Sequence[Command] | None:
        found = (rescuer.rescue(error) for rescuer in self.rescuers)
        return next((commands for commands in found if commands is not None), None)

    def _listen(self, project: Project) -> None:
        self.inbox.listen(project)
        self.performer.questions.listen(project)
        self.board.listen(project)

    def _today(self) -> date:
        """The day on the exhibition's clock."""
        now = self.runtime.snapshot
        return local_time(moment(now.epoch, self.clock.now()), now.timezone).date()

    def _track(self, track: Track) -> None:
        """Switch a controller on or off: what moves joints where that is done, the rest here."""
        self.tracking.switch(track)
        self.regulation.switch(track)

    def _regulate(self, now: float) -> None:
        commands, events = self.regulation.tick(now, self.runtime.snapshot)
        self._events += events
        self._perform(commands, now)

    def _stepped(self, step: Step) -> None:
        self.performer.questions.stepped(step)
        for observer in self.observers:
            observer.stepped(step)
        for trouble in troubles_of_step(self.project.machine, step):
            self._trouble(trouble)

    def _dropped(self, what: str) -> None:
        self._trouble(RunTrouble("dropped", what))

    def _trouble(self, trouble: RunTrouble) -> None:
        for observer in self.observers:
            observer.troubled(trouble)

    def _gather(self, now: float) -> list[Event]:
        ended, self.performer.events = self.performer.events, []
        answers = self.performer.navigator.tick(
            self.project, self.runtime.snapshot.place, [*ended, *self.robot.poll()], now
        )
        for event in answers:
            if event in ended:
                continue
            for observer in self.observers:
                observer.answered(event)
            if trouble := trouble_of_answer(event):
                self._trouble(trouble)
            self._perform(self._cues.answered(event, self.project, self.runtime.snapshot.language), now)
        happened, self._events = self._events, []
        heard = [event for event in answers if _ours(event) and not self._known(event, now)]
        if self.wall_clock and (clock_set := self.wall_clock.tick(self.clock.now(), self.runtime.snapshot)):
            happened = [clock_set, *happened]
        happened = [*happened, *self.runtime.approvals.tick(now)]
        own = [caused(event) for event in (*heard, *(event._replace(at=now) for event in happened))]
        own.sort(key=lambda event: event.name not in CAUSES)
        heard_of = [*self.performer.questions.drain(now), *self.board.drain(self.runtime.snapshot, now)]
        return [*own, *heard_of, *self.inbox.drain(now)]

    def _perform(
        self, commands: Sequence[Command], now: float, project: Project | None = None, step: int | None = None
    ) -> None:
        self.step = self.runtime.steps if step is None else step
        for command in commands:
            self._tell_of(command, now)
            try:
                self.performer.perform(project or self.project, command, now, self.step)
            except Exception as error:
                self._recover(error, now)

    def _tell_of(self, command: Command, now: float) -> None:
        """Notify the observers of a command that is about to be performed, or of its refusal."""
        reason = self.performer.refusal(self.project, command)
        if reason and isinstance(command, Start):
            for observer in self.observers:
                observer.refused(command, reason)
            return
        for observer in self.observers:
            observer.performing(command, now)
        self._cues.performing(command)
        self._note_rest(command)

    def _lose(self, seconds: float) -> None:
        """We were away: the behaviour hears it, and not again when the robot says so, too."""
        self._lost_at = self.clock.now()
        self._events.append(Event("brain.lost", {"seconds": seconds}, self._lost_at))

    def _known(self, event: Event, now: float) -> bool:
        return event.name == "brain.lost" and now - self._lost_at < self.patience

    def _note_rest(self, command: Command) -> None:
        match command:
            case Start(_, Rest()):
                self.rests = True
            case Start(_, Wake() | Posture() | Walk() | Move() | GoTo() | Play()):
                self.rests = False

    def _recover(self, error: Exception, now: float) -> None:
        """Go on with another bundle after a fault; raises it where there is none."""
        commands = self._rescued(error)
        if commands is None:
            raise error
        self._perform(commands, now)


def _ours(event: Event) -> bool:
    """Whether it is for the behaviour: its own commands are c1, d2@quiz, …; others' answers are theirs alone.

    The words and sounds of a motion are for us, recordings for modules.
    """
    if event.name in (CUE, RECORDED):
        return False
    _, separator, id = event.name.partition(".command.")
    return not separator or (id[:1] in ("c", "d") and id[1:].partition("@")[0].isdecimal())
