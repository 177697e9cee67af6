"""The loop of a running behaviour, fifty times a second."""

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
"""The time after which the robot is sent its style again [s], in case it was restarted and lost the style."""

_STILL = Live(STILL_STYLE)


class LifeDirector:
    """Sends the robot the style of life of the active states.

    It has no influence on the steps, so journals do not contain it.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._told, self._wanted = _STILL, _STILL
        self._told_at = 0.0
        self._seen: tuple[object, object] = (None, None)

    def tick(self, project: Project, snapshot: Snapshot, now: float) -> None:
        """Send the robot its style when it changes; a style that is not still is sent again every REMIND_PERIOD."""
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
"""The prefixes of the events that a behaviour receives when it resumes after the engine was away."""


def caused(event: Event) -> Event:
    """Return the event with a cause; an event that already has a cause is returned unchanged."""
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
"""The time between two ticks [s]."""
BRAIN_LOST_AFTER = 5.0
"""The gap between ticks from which the behaviour receives `brain.lost` [s]."""
NOTHING_WAITS = "nothing is waiting for approval"
CAUSES = ("stop", "brain.lost", "robot.lost")
"""Events that the behaviour receives before the failures that they cause: a stop cancels the robot's commands."""


class Observer:
    """The base class of observers, which are notified of the events of a run and must not change it."""

    def stepped(self, step: Step) -> None:
        """Called after each step of the behaviour."""

    def performing(self, command: Command, now: float) -> None:
        """Called before a command is performed."""

    def refused(self, command: Start, reason: str) -> None:
        """Called if the robot refuses a command of the behaviour, because a person keeps it still."""

    def answered(self, event: Event) -> None:
        """Called when the robot answered a command or noticed something, before the behaviour receives the event."""

    def troubled(self, trouble: RunTrouble) -> None:
        """Called when a problem occurs, such as a fall; unless a story expects it, the run then counts as failed."""


class Rescuer(Protocol):
    """A handler of faults that may switch to another bundle."""

    def rescue(self, error: Exception) -> Sequence[Command] | None:
        """Switch to another bundle; return the commands of the switch.

        Return None if no switch is possible. If no rescuer can switch, the event or timer with the fault is dropped; a
        fault outside of them ends the run.
        """
        ...


class BehaviorLoop:
    """A project on a robot, a bus and a clock.

    At each tick the clock waits, tracking runs, inputs become events, the behaviour steps, its commands are performed,
    and `observers` are called. If a tick fails because of the bundle or an internal error, one of the `rescuers` may
    switch to another bundle. `tracking` lets controllers follow sightings; if it is None, the loop does so itself.
    `refuse` returns why the robot may not begin a command; empty if it may. `wall_clock` detects changes of the time of
    day; if it is None, they are ignored. A gap between ticks of `patience` [s] on the clock raises `brain.lost`.
    """

    def __init__(
        self,
        project: Project,
        robot: Robot,
        bus: Bus,
        clock: Clock,
        tracking: TrackingService | None = None,
        refuse: Callable[[RobotCommand], str] = lambda _: "",
        wall_clock: WallClockWatch | None = None,
        patience: float = BRAIN_LOST_AFTER,
    ) -> None:
        self.robot, self.bus, self.clock = robot, bus, clock
        self.observers: list[Observer] = []
        self.rescuers: list[Rescuer] = []
        self._wall_clock, self._patience = wall_clock, patience
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
        self.rests = False
        """Whether the behaviour has made the robot rest."""
        self.step = 0
        """The number of the step whose commands are being performed (`Runtime.steps`)."""
        self._lost_at = -inf

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self.runtime.project

    def start(
        self,
        *,
        language: str = "",
        epoch: float = 0.0,
        timezone: str = "",
        context: Mapping[str, Any] | None = None,
    ) -> None:
        """Subscribe, and enter the initial states; the options are those of `Runtime.start`."""
        self._last = self.clock.now()
        self._listen(self.project)
        first = self.runtime.start(self._last, language=language, epoch=epoch, timezone=timezone, context=context)
        self._perform(first, self._last)

    def resume(self, resumption: Resumption) -> None:
        """Subscribe, and continue from the behaviour's state before the engine was away."""
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
        """Raise an event at the next tick."""
        self._events.append(event)

    def approve(self, by: str, *, go: bool) -> str:
        """Release the event that has waited longest if `go`, or else drop it.

        Return why that is impossible, or an empty string.
        """
        return "" if self.runtime.approvals.decide("", by, go=go) else NOTHING_WAITS

    def set_autonomy(self, level: Autonomy, by: str) -> None:
        """Set whether marked transitions wait for GO."""
        self.runtime.approvals.set(level, by)

    def press(self, label: str, by: str) -> str:
        """Raise the event of a button at the next tick; return why that is impossible, or an empty string."""
        found = pressed(self.project.machine, self.runtime.snapshot, label, self.clock.now(), by)
        if isinstance(found, str):
            return found
        self.happen(found)
        return ""

    def tick(self, now: float | None = None) -> float:
        """Run one tick at `now` [s]; return the tick's time [s].

        If `now` is None, wait until one period after the last tick.
        """
        if now is None:
            self.clock.wait(self._last + TICK_PERIOD)
            now = self.clock.now()
        if now - self._last > self._patience:
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
        """The number of events that wait for the next tick."""
        return len(self._events) + len(self.performer.events) + len(self.inbox)

    def take(self, step: Step) -> None:
        """Continue with a step that was made elsewhere from the current snapshot, and perform its commands."""
        self._perform(self.runtime.take(step), self._last)

    def quiet_until(self, now: float) -> float:
        """Return the time until which nothing happens without an outside input [s].

        Return `now` if something may happen at once.
        """
        pending = self._events or self.performer.events or not (self.inbox.empty and self.performer.questions.empty)
        pending = pending or not self.board.empty
        if pending or self.tracking.on or self.performer.navigator.busy:
            return now
        event = due(self.runtime.snapshot)
        return max(now, min(event.at if event else inf, self.runtime.approvals.due, self.board.due))

    def leap(self, now: float) -> None:
        """Set the time to `now` [s] after an interval in which nothing happened."""
        self._last = now
        self.performer.navigator.leap(now)

    def plan(self, project: Project, *, now: bool = False, back: bool = False) -> MigrationVerdict:
        """Return how another bundle would continue from here, or why it can't (`Runtime.plan`); nothing changes."""
        return self.runtime.plan(project, self._last, now=now, back=back)

    def apply(self, project: Project, plan: MigrationPlan) -> None:
        """Switch to another bundle as planned, between two macrosteps, and perform the plan's commands."""
        old = self.project
        self.switch(project, plan)
        self.perform(plan, old)

    def switch(self, project: Project, plan: MigrationPlan, kind: JumpKind = "reload") -> None:
        """Switch to another bundle without performing the plan's commands.

        Raises BusError if the bus refuses its routes, and any internal error; then nothing has changed.
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
        """Perform the commands of a plan after its switch; the old bundle performs those that leave states."""
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
        """Return the date on the exhibition's clock."""
        now = self.runtime.snapshot
        return local_time(moment(now.epoch, self.clock.now()), now.timezone).date()

    def _track(self, track: Track) -> None:
        """Switch a controller on or off, in the tracking service (joints) and in `regulation` (other outputs)."""
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
        if self._wall_clock and (clock_set := self._wall_clock.tick(self.clock.now, self.runtime.snapshot)):
            happened = [clock_set, *happened]
        happened = [*happened, *self.runtime.approvals.tick(now)]
        own = [caused(event) for event in (*heard, *(event._replace(at=now) for event in happened))]
        # a stable sort: only the causes move, to the front
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
        """Raise `brain.lost`, and remember the time, so that the robot's own report of the same gap is ignored."""
        self._lost_at = self.clock.now()
        self._events.append(Event("brain.lost", {"seconds": seconds}, self._lost_at))

    def _known(self, event: Event, now: float) -> bool:
        return event.name == "brain.lost" and now - self._lost_at < self._patience

    def _note_rest(self, command: Command) -> None:
        match command:
            case Start(_, Rest()):
                self.rests = True
            case Start(_, Wake() | Posture() | Walk() | Move() | GoTo() | Play()):
                self.rests = False

    def _recover(self, error: Exception, now: float) -> None:
        """Let a rescuer switch the bundle after a fault, and perform the switch's commands; else raise the fault."""
        commands = self._rescued(error)
        if commands is None:
            raise error
        self._perform(commands, now)


def _ours(event: Event) -> bool:
    """Return whether an event is for the behaviour.

    An answer is for the behaviour if it belongs to one of the behaviour's commands (c1, d2@quiz, …). Cues of a motion
    are for the loop, and recordings for modules.
    """
    if event.name in (CUE, RECORDED):
        return False
    _, separator, id = event.name.partition(".command.")
    return not separator or (id[:1] in ("c", "d") and id[1:].partition("@")[0].isdecimal())
