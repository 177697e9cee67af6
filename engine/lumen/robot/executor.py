"""Execution of commands, which wait until the parts of the body that they need are free.

Head, arms, legs, voice, LEDs and ears each have one owner at a time. `Rest` and `Stop` cancel what runs and come before
everything. Of the others, those of the behaviour come before those of other modules; in each group they wait by rank,
then in the order they came. A body supplies the activities; this module handles the order, the ownership and the
answers, in the same way for every robot that executes commands itself.
"""

from collections import deque
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from lumen.errors import RobotError, RobotRefusedError
from lumen.language.added_verbs import added_verbs
from lumen.language.commands import Do, Move, Posture, Rest, Stop, Wake
from lumen.language.events import MISSED, RESULT, Event
from lumen.ports import NativeCommand, RobotCommand
from lumen.robot.command_checks import check_arguments
from lumen.robot.command_table import row_of

FOREIGN = "m"
"""The prefix of the ids of commands that are not from the behaviour."""
MAX_UNREAD_STARTS = 1_000
"""The number of starts of commands that are kept while `begun` is not called."""


class Activity(Protocol):
    """A command under way."""

    def advance(self, now: float) -> bool:
        """Continue until `now` [s]; return True once finished. Raises RobotError if it failed."""
        ...

    def cancel(self) -> None:
        """End early: `advance` returns True as soon as the body is balanced, at most 1 s later."""
        ...


@runtime_checkable
class Misses(Protocol):
    """An activity that may end before all joints have reached their goals."""

    @property
    def missed(self) -> str:
        """The joints that missed their goals, in words; empty if none did."""
        ...


@runtime_checkable
class Yields(Protocol):
    """An activity that ends with a result."""

    @property
    def result(self) -> Mapping[str, Any]:
        """The result as JSON data; empty if there is nothing to report."""
        ...


class ExecutingRobot:
    """The methods of every robot whose commands run in an executor."""

    _executor: "Executor"

    @property
    def verbs(self) -> Collection[str]:
        return added_verbs()

    def cancel(self, id: str) -> None:
        self._executor.cancel(id)

    def begun(self) -> Sequence[str]:
        return self._executor.begun()


@dataclass(eq=False)
class _Task:
    id: str
    command: RobotCommand
    parts: frozenset[str]
    activity: Activity | None = None
    cancelled: bool = False
    displaced: bool = False

    @property
    def going(self) -> bool:
        """True while the command is under way and not cancelled."""
        return self.activity is not None and not self.cancelled

    @property
    def turn(self) -> tuple[bool, bool, int]:
        """The sort key of waiting tasks: the task with the least key begins first."""
        rank = row_of(self.command).rank
        return rank > 0, self.id.startswith(FOREIGN) and self.id[1:].isdecimal(), rank


class _Ended:
    """The activity of `Stop`, which waits until these tasks have ended."""

    def __init__(self, tasks: Iterable[_Task], alive: list[_Task]) -> None:
        self.tasks, self.alive = tuple(tasks), alive

    def advance(self, now: float) -> bool:
        return not any(task in self.alive for task in self.tasks)

    def cancel(self) -> None:
        """Do nothing, because a stop can't be cancelled."""


class Executor:
    """Starts, queues, cancels and answers commands.

    `begin` returns the activity of a command at a time [s], or raises RobotError; `skill` does the same for the verbs
    of features, which every robot performs in the same way. `parts` returns the parts of the body that a command owns.
    """

    def __init__(
        self,
        begin: Callable[[NativeCommand, float], Activity],
        parts: Callable[[RobotCommand], frozenset[str]],
        skill: Callable[[Do, float], Activity],
    ) -> None:
        self._begin, self._parts, self._skill = begin, parts, skill
        self._rests = False
        self._tasks: list[_Task] = []
        self._answers: list[tuple[str, _Task, Mapping[str, Any] | None]] = []
        self._begun: deque[str] = deque(maxlen=MAX_UNREAD_STARTS)

    def start(self, id: str, command: RobotCommand) -> None:
        """Queue a command; it begins at the next `advance` for which its parts are free.

        A `Stop` or `Rest` cancels other commands at once.
        """
        task = _Task(id, command, self._parts(command))
        if isinstance(command, Stop):
            what = command.what
            meant = [t for t in self._tasks if what in ("all", row_of(t.command).channel)]
            ended = [t for t in meant if not isinstance(t.command, Stop | Rest)]
            task.activity = _Ended(ended, self._tasks)
            self._begun.append(id)
            self._cancel(ended)
        elif isinstance(command, Rest):
            self._cancel([t for t in self._tasks if not isinstance(t.command, Stop | Rest)])
        self._displace(task)
        self._tasks.append(task)
        self._tasks.sort(key=lambda t: t.turn)

    def cancel(self, id: str) -> None:
        """End a command early; do nothing if the id is unknown or the command is over."""
        self._cancel([t for t in self._tasks if t.id == id])

    def fail(self, reason: str, *, fallen: bool = False) -> None:
        """Make all commands that run or wait fail at once.

        If the robot has `fallen`, verbs of features that move it are refused until it wakes.
        """
        self._rests = self._rests or fallen
        for task in self._tasks[:]:
            if isinstance(task.command, Do) and task.activity:
                task.activity.cancel()
            self._end("error", task, {"reason": reason})

    def owner(self, part: str) -> str:
        """Return the id of the command that moves this part now; empty if the part is free."""
        return next((t.id for t in self._tasks if t.activity and part in t.parts), "")

    def begun(self) -> list[str]:
        """Return the ids of the commands that began since the last call, at most MAX_UNREAD_STARTS."""
        begun = list(self._begun)
        self._begun.clear()
        return begun

    @property
    def busy(self) -> bool:
        return bool(self._tasks)

    @property
    def idle(self) -> bool:
        """True if no command is under way, and no answer or start is unread."""
        return not (self._tasks or self._answers or self._begun)

    def advance(self, now: float) -> list[Event]:
        """Run until `now` [s]; return the answers of the commands that ended, in that order."""
        self._run(now)
        self._admit(now)
        answers = [Event(f"{kind}.command.{task.id}", data, now) for kind, task, data in self._answers]
        self._answers.clear()
        return answers

    def _run(self, now: float) -> None:
        for task in self._tasks[:]:
            if task.activity is None:
                continue
            try:
                finished = task.activity.advance(now)
            except RobotError as error:
                self._end("error", task, {"reason": str(error)})
            else:
                if finished:
                    ended_early = task.cancelled and not task.displaced
                    kind, data = ("cancelled", None) if ended_early else ("done", _news(task.activity))
                    self._end(kind, task, data)

    def _admit(self, now: float) -> None:
        """Begin the commands whose parts are free; a waiting command reserves its parts against those behind it."""
        taken: set[str] = set().union(*(t.parts for t in self._tasks if t.activity))
        for task in self._tasks[:]:
            if task.activity is None:
                before = self._before(task)
                if before or taken.isdisjoint(task.parts):
                    try:
                        task.activity = self._begun_activity(task.command, now)
                    except RobotError as error:
                        self._end("error", task, {"reason": str(error)})
                        continue
                    self._begun.append(task.id)
                    if before:
                        self._end("done", before)
                taken |= task.parts

    def _begun_activity(self, command: RobotCommand, now: float) -> Activity:
        if not isinstance(command, Do):
            activity = self._begin(command, now)
            self._rests = isinstance(command, Rest) or (self._rests and not isinstance(command, Wake | Posture))
            return activity
        if command.row is None:  # the thread of a project's own verb checks them: ten new schemas cost a tick
            check_arguments(command)
        if self._rests and row_of(command).moves:
            raise RobotRefusedError("the robot rests or has fallen: `wake` it first")
        return self._skill(command, now)

    def _before(self, task: _Task) -> _Task | None:
        """Return the `Move` under way that a new `Move` replaces without a stop in between; None for other commands."""
        moving = isinstance(task.command, Move)
        return next((t for t in self._tasks if moving and isinstance(t.command, Move) and t.going), None)

    def _displace(self, task: _Task) -> None:
        """End each `Move` that blocks this command.

        A `Move` has no end of its own, so the command would wait for ever.
        """
        if not isinstance(task.command, Move):
            endless = (t for t in self._tasks if isinstance(t.command, Move) and not t.parts.isdisjoint(task.parts))
            for move in list(endless):
                if move.going:
                    move.displaced = True
                    self._cancel([move])
                elif move.activity is None:
                    self._end("cancelled", move)

    def _cancel(self, tasks: Iterable[_Task]) -> None:
        for task in tasks:
            if task.activity is None:
                self._end("cancelled", task)
            elif not task.cancelled:
                task.cancelled = True
                task.activity.cancel()

    def _end(self, kind: str, task: _Task, data: Mapping[str, Any] | None = None) -> None:
        self._tasks.remove(task)
        self._answers.append((kind, task, data))


def _news(activity: Activity) -> Mapping[str, Any] | None:
    """Return the data of `done.command.ID` for an activity that has finished; None without data."""
    if isinstance(activity, Misses) and activity.missed:
        return {MISSED: activity.missed}
    if isinstance(activity, Yields) and activity.result:
        return {RESULT: dict(activity.result)}
    return None
