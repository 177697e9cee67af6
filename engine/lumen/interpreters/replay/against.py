"""A visit that was recorded, played again with other files: what would they have said and done?

The behaviour goes over to the other files where it was at home last, as in a reload. Then it hears what it heard then,
when it heard it. What the robot answered to a command then, it answers to the command of now that is in its place: the
same one, or the next of its kind. A command that has no counterpart takes as long as on the recording robot.
"""

import heapq
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.errors import LumenError
from lumen.interpreters.migration import MigrationPlan, plan
from lumen.interpreters.replay.command_data import command_data, started
from lumen.interpreters.replay.entries import JournalInput
from lumen.interpreters.replay.visits import RecordedVisit, home_of
from lumen.interpreters.statechart import Snapshot, deserialize, due, elapse, step
from lumen.interpreters.statechart.direct_entry import entered_directly
from lumen.language.commands import BodyCommand, Command, Start
from lumen.language.events import Event
from lumen.language.nanoseconds import HALF
from lumen.language.projects import Project

Duration = Callable[[Project, BodyCommand], float]
"""How long a command takes [s] where nobody knows how long it took."""

GRACE = 120.0
"""How much longer than then a visit may take to come home [s]."""


class VisitVerdict(NamedTuple):
    """What became of a visit: `same`, `says something else`, or `ends elsewhere`; what `was` said first, and is `now`.

    `at` is when that was, by the exhibition's clock [s]. `steps` were taken.
    """

    how: str
    steps: int
    at: float = 0.0
    was: str = ""
    now: str = ""


SAME, SAYS, ENDS = "same", "says something else", "ends elsewhere"


def played_against(old: Project, new: Project, visit: RecordedVisit, takes: Duration) -> VisitVerdict | None:
    """What becomes of a visit with other files; None where too little of it is in the journal to say."""
    home, entries = visit.home, visit.inputs
    if home is None or not entries or visit.redacted:
        return None
    try:
        before = deserialize(old.machine, home.snapshot or {})
        planned = plan(old, new, before, at=home.at, now=True)
    except LumenError as error:
        return VisitVerdict(ENDS, 0, home.at, "", str(error))
    if not isinstance(planned, MigrationPlan):
        return VisitVerdict(ENDS, 0, home.at, "", f"these files can't go on from there: {planned.reason}")
    play = _Play(new, planned.snapshot, takes)
    then = list[tuple[float, Any]]()
    try:
        for entry in entries:
            then += ((entry.event.at, command) for command in entry.commands)
            play.hear(entry)
        if visit.whole:
            play.come_home(home_of(new.machine), entries[-1].event.at)
    except LumenError as error:
        return VisitVerdict(ENDS, play.steps, play.snapshot.at, "", str(error))
    if not visit.whole:  # nobody knows how it would have gone on
        del play.done[len(then) :]
    return _verdict(play, then, home_of(new.machine) if visit.whole else "")


def _verdict(play: "_Play", then: list[tuple[float, Any]], home: str) -> VisitVerdict:
    """`home` is where it should have ended, empty for anywhere."""
    was, now = list(_told(then)), list(_told(play.done))
    elsewhere = bool(home) and home not in play.snapshot.configuration
    for place in range(max(len(was), len(now))):
        one, other = (row[place] if place < len(row) else (play.snapshot.at, "nothing") for row in (was, now))
        if one[1] != other[1]:
            return VisitVerdict(ENDS if elsewhere else SAYS, play.steps, min(one[0], other[0]), one[1], other[1])
    if elsewhere:
        return VisitVerdict(ENDS, play.steps, play.snapshot.at, home, ", ".join(sorted(play.snapshot.configuration)))
    return VisitVerdict(SAME, play.steps)


def _told(commands: list[tuple[float, Any]]) -> Iterator[tuple[float, str]]:
    """What others notice of commands: without their ids, and without what is only logged."""
    for at, command in commands:
        begun = started(command)
        if begun:
            _, kind, said = begun
            yield at, f"“{said['text']}” ({said['language']})" if kind == "Say" else f"{kind} {_words(said)}".rstrip()
        elif "Publish" in command:
            yield at, f"Publish {_words(command['Publish'])}"


def _words(said: Mapping[str, Any]) -> str:
    return ", ".join(str(value) for value in said.values())


class _Play:
    """The behaviour of the other files, and the robot that answers it; `done` is what it asked for, and when."""

    def __init__(self, project: Project, snapshot: Snapshot, takes: Duration) -> None:
        self._project, self._takes = project, takes
        self.snapshot, self.steps = snapshot, 0
        self.done: list[tuple[float, Any]] = []
        self._counterparts: dict[str, str] = {}
        self._begun: set[str] = set()
        self._then: list[tuple[str, str, Any]] = []
        self._now: list[tuple[str, str, Any]] = []
        self._answers: list[tuple[float, str]] = []

    def hear(self, entry: JournalInput) -> None:
        """What happened then, at its time. Raises LumenError."""
        at = entry.event.at
        self._pass(at, one=entry.how == "timer")
        if entry.how == "goto":
            state = str(entry.event.data.get("state")) if isinstance(entry.event.data, Mapping) else ""
            self._take(entered_directly(self._project.machine, self.snapshot, state, entry.event))
        elif entry.how == "heard" and (event := self._translated(entry.event)):
            self._take(step(self._project.machine, self.snapshot, event))
        for command in entry.commands:
            if begun := started(command):
                self._then.append(begun)
                self._begun.add(begun[0])
        self._pair()

    def come_home(self, home: str, since: float) -> None:
        """Let what is under way come to its end, where the visit has not ended by then."""
        while home not in self.snapshot.configuration:
            timer = due(self.snapshot)
            waiting = [self._answers[0][0]] if self._answers else []
            following = min([*waiting, *([timer.at] if timer else [])], default=since + GRACE + 1.0)
            if following > since + GRACE:
                return
            self._pass(following)

    def _pass(self, until: float, *, one: bool = False) -> None:
        """Timers and answers that come until then, in their order; of the timers of that very moment only `one`."""
        while self._answers and self._answers[0][0] <= until:
            at, id = heapq.heappop(self._answers)
            self._elapse(at)
            if any(id == waiting for waiting, *_ in self._now):
                self._now = [row for row in self._now if row[0] != id]
                self._take(step(self._project.machine, self.snapshot, Event(f"done.command.{id}", None, at)))
        self._elapse(until - 2 * HALF if one else until)
        if one and (timer := due(self.snapshot)) and timer.at < until + HALF:
            self._take(step(self._project.machine, self.snapshot, timer))

    def _elapse(self, until: float) -> None:
        for taken in elapse(self._project.machine, lambda: self.snapshot, until):
            self._take(taken)

    def _take(self, taken: Any) -> None:
        self.snapshot, self.steps = taken.snapshot, self.steps + 1
        for command in taken.commands:
            self._begin(command)

    def _begin(self, command: Command) -> None:
        data, at = command_data(command), self.snapshot.at
        self.done.append((at, data))
        if isinstance(command, Start) and (begun := started(data)):
            self._now.append(begun)
            heapq.heappush(self._answers, (at + self._takes(self._project, command.command), begun[0]))

    def _pair(self) -> None:
        """Find for each command of then its counterpart of now."""
        for parts in (slice(1, 3), slice(1, 2)):  # the same command, then the same kind of command
            for one in list(self._then):
                other = next((row for row in self._now if one[parts] == row[parts]), None)
                if other:
                    self._then.remove(one)
                    self._now.remove(other)
                    self._counterparts[one[0]] = other[0]

    def _translated(self, event: Event) -> Event | None:
        """An event as it is now: an answer has the id of the command of now; None where there is none."""
        kind, separator, id = event.name.partition(".command.")
        if not separator or id not in self._begun:  # of before the visit it is as it was
            return event
        self._then = [row for row in self._then if row[0] != id]
        counterpart = self._counterparts.pop(id, None)
        return event._replace(name=f"{kind}.command.{counterpart}") if counterpart else None
