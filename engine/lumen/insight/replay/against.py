"""A recorded visit played again with other files, to find the differences in speech and actions.

The behaviour changes to the other files at the moment when it was last at home, as in a reload. Then it receives the
recorded events at their times. A recorded answer goes to its command's counterpart: the same command, or the next
command of its kind. A command without a counterpart takes as long as on the recording robot.
"""

import heapq
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.errors import JournalError, LumenError
from lumen.insight.explaining.history import RecordedStep
from lumen.insight.explaining.tracing import retaken
from lumen.insight.migration import MigrationPlan, plan
from lumen.insight.replay.entries import JournalInput, JournalJump
from lumen.insight.replay.visits import RecordedVisit, waiting_state
from lumen.language.added_verbs import usual_result
from lumen.language.command_data import command_data, started
from lumen.language.commands import BodyCommand, Command, Start
from lumen.language.diagnostics import Place
from lumen.language.events import Event
from lumen.language.nanoseconds import HALF
from lumen.language.projects import Project
from lumen.statechart import Snapshot, Step, deserialize, due, elapse, step
from lumen.statechart.direct_entry import entered_directly

Duration = Callable[[Project, BodyCommand], float]
"""A function that returns the duration of a command [s] for which the journal has none."""

GRACE = 120.0
"""The additional time, beyond the recorded time, in which a visit can return home [s]."""
MORE_STEPS, MOST_TIMES = 20_000, 10
"""The maximum numbers of additional steps of a visit, and of steps per recorded input: other files may never rest."""


class VisitVerdict(NamedTuple):
    """The result of a visit with other files."""

    how: str
    """`same`, `says something else`, or `ends elsewhere`."""
    steps: int
    """The number of steps that were taken."""
    at: float = 0.0
    """The time of the first difference, by the exhibition's clock [s]."""
    was: str = ""
    """The recorded speech or action at the first difference."""
    now: str = ""
    """The new speech or action at the first difference."""
    place: Place | None = None
    """The place in the other files of the new speech or action; None if it is unknown."""


SAME, SAYS, ENDS = "same", "says something else", "ends elsewhere"
"""The values of `VisitVerdict.how`."""


def played_against(
    old: Project,
    new: Project,
    visit: RecordedVisit,
    takes: Duration,
    *,
    beside: Project | None = None,
    hurry: Callable[[], None] = lambda: None,
) -> VisitVerdict | None:
    """Return the result of a visit with other files; None if the journal has too little of the visit.

    The result is compared with the record, or with the result of the files `beside`. `takes` gives durations that were
    not recorded. `hurry` is called at each step and can raise an exception to end the play.
    """
    home = visit.home
    if home is None or not visit.inputs or visit.redacted:
        return None
    play = OtherPlay(new, takes)
    play.attend(old, home, visit, hurry)
    if beside is None:
        then = [(entry.event.at, command) for entry in visit.inputs for command in entry.commands]
        if not visit.whole:  # the rest of the visit was not recorded
            del play.done[len(then) :]
        return _verdict(play, then, "", waiting_state(old.machine) if visit.whole else "")
    other = OtherPlay(beside, takes)
    other.attend(old, home, visit, hurry)
    return _verdict(play, other.done, other.trouble, other.home if visit.whole and other.is_home else "")


def _verdict(play: "OtherPlay", then: list[tuple[float, Any]], trouble: str, home: str) -> VisitVerdict:
    """Return the verdict on a play compared with another course, `then`.

    `home` is the state in which the other course ended (empty for any state), and `trouble` is its error.
    """
    if play.trouble != trouble:
        return VisitVerdict(ENDS, play.steps, play.at, trouble, play.trouble or "no such error")
    was, now = list(noticed(then)), list(noticed(play.done))
    elsewhere = bool(home) and not play.is_home
    for place in range(max(len(was), len(now))):
        one, other = (row[place] if place < len(row) else (play.at, "nothing", -1) for row in (was, now))
        if one[1] != other[1]:
            how, at = ENDS if elsewhere else SAYS, min(one[0], other[0])
            return VisitVerdict(how, play.steps, at, one[1], other[1], play.place(other[2]))
    if elsewhere:
        active = ", ".join(sorted(play.snapshot.configuration)) if play.snapshot else ""
        return VisitVerdict(ENDS, play.steps, play.at, home, active)
    return VisitVerdict(SAME, play.steps)


def noticed(commands: list[tuple[float, Any]]) -> Iterator[tuple[float, str, int]]:
    """Yield the time, the words and the index of each command that people or other modules notice, without its id."""
    for number, (at, command) in enumerate(commands):
        begun = started(command)
        if begun:
            _, kind, said = begun
            told = f"“{said['text']}” ({said['language']})" if kind == "Say" else f"{kind} {_words(said)}".rstrip()
            yield at, told, number
        elif "Publish" in command:
            yield at, f"Publish {_words(command['Publish'])}", number
        elif "Tell" in command:
            yield at, f"Tell {_words(command['Tell'])}", number


def _words(said: Mapping[str, Any]) -> str:
    return ", ".join(str(value) for value in said.values())


class OtherPlay:
    """Plays a visit with the other files and a simulated robot."""

    def __init__(self, project: Project, takes: Duration) -> None:
        self._project, self._takes = project, takes
        self.home, self.steps, self.trouble = waiting_state(project.machine), 0, ""
        self.done: list[tuple[float, Any]] = []
        """The issued commands as JSON data, with their times [s]."""
        self._asked: list[tuple[Snapshot, Event | None, Command]] = []
        self._counterparts: dict[str, str] = {}
        self._begun: set[str] = set()
        self._then: list[tuple[str, str, Any]] = []
        self._now: list[tuple[str, str, Any]] = []
        self._answers: list[tuple[float, str, Mapping[str, Any] | None]] = []
        self._began = 0.0
        self._stands: Snapshot | None = None
        self._most = MORE_STEPS
        self._hurry: Callable[[], None] = lambda: None

    @property
    def snapshot(self) -> Snapshot:
        """The current snapshot; it exists only after the change to the other files."""
        assert self._stands is not None
        return self._stands

    @property
    def at(self) -> float:
        """The time that the play has reached, by the exhibition's clock [s]."""
        return self._stands.at if self._stands else self._began

    @property
    def is_home(self) -> bool:
        """Whether the behaviour is in its home state."""
        return self._stands is not None and self.home in self._stands.configuration

    def attend(self, old: Project, home: JournalJump, visit: RecordedVisit, hurry: Callable[[], None]) -> None:
        """Change to these files when the behaviour was at home, and play the visit; set `trouble` on an error."""
        self._began, self._hurry = home.at, hurry
        self._most = MORE_STEPS + MOST_TIMES * len(visit.inputs)
        try:
            planned = plan(old, self._project, deserialize(old.machine, home.snapshot or {}), at=home.at, now=True)
            if not isinstance(planned, MigrationPlan):
                self.trouble = f"these files can't continue from there: {planned.reason}"
                return
            self._stands = planned.snapshot
            for entry in visit.inputs:
                self.hear(entry)
            if visit.whole:
                self.come_home(visit.inputs[-1].event.at)
        except LumenError as error:
            self.trouble = str(error)

    def place(self, number: int) -> Place | None:
        """Return the place of the action that issued the command of that index in `done`; None if it is unknown."""
        if number < 0:
            return None
        before, event, command = self._asked[number]
        taken = RecordedStep(self._project.machine, before, Step(event, (), (), (), before), self._project)
        if event is None or not taken.is_decided:
            return None
        deeds = retaken(self._project.machine, before, event).deeds
        return next((taken.place(deed.machine, deed.where) for deed in deeds if deed.what == command), None)

    def hear(self, entry: JournalInput) -> None:
        """Process a recorded event at its time. Raises LumenError if a step fails."""
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

    def come_home(self, since: float) -> None:
        """Continue until the behaviour is at home; stop `GRACE` after `since` [s]."""
        while not self.is_home:
            timer = due(self.snapshot)
            waiting = [self._answers[0][0]] if self._answers else []
            following = min([*waiting, *([timer.at] if timer else [])], default=since + GRACE + 1.0)
            if following > since + GRACE:
                return
            self._pass(following)

    def _pass(self, until: float, *, one: bool = False) -> None:
        """Process timers and answers up to a time [s], in order; with `one`, only one of the timers due then."""
        while self._answers and self._answers[0][0] <= until:
            at, id, data = heapq.heappop(self._answers)
            self._elapse(at)
            if any(id == waiting for waiting, *_ in self._now):
                self._now = [row for row in self._now if row[0] != id]
                self._take(step(self._project.machine, self.snapshot, Event(f"done.command.{id}", data, at)))
        self._elapse(until - 2 * HALF if one else until)
        if one and (timer := due(self.snapshot)) and timer.at < until + HALF:
            self._take(step(self._project.machine, self.snapshot, timer))

    def _elapse(self, until: float) -> None:
        for taken in elapse(self._project.machine, lambda: self.snapshot, until):
            self._take(taken)

    def _take(self, taken: Any) -> None:
        before, self._stands, self.steps = self.snapshot, taken.snapshot, self.steps + 1
        self._hurry()
        if self.steps > self._most:
            raise JournalError(f"with these files, one visit takes more than {self._most:,} steps")
        for command in taken.commands:
            self._asked.append((before, taken.event, command))
            self._begin(command)

    def _begin(self, command: Command) -> None:
        data, at = command_data(command), self.snapshot.at
        self.done.append((at, data))
        if isinstance(command, Start) and (begun := started(data)):
            self._now.append(begun)
            ends = at + self._takes(self._project, command.command)
            heapq.heappush(self._answers, (ends, begun[0], usual_result(command.command)))

    def _pair(self) -> None:
        """Find each recorded command's counterpart among the new commands."""
        for parts in (slice(1, 3), slice(1, 2)):  # the same command, then the same kind of command
            for one in list(self._then):
                other = next((row for row in self._now if one[parts] == row[parts]), None)
                if other:
                    self._then.remove(one)
                    self._now.remove(other)
                    self._counterparts[one[0]] = other[0]

    def _translated(self, event: Event) -> Event | None:
        """Return an event with the id of the new command that it answers; None if there is no such command."""
        kind, separator, id = event.name.partition(".command.")
        if not separator or id not in self._begun:  # a command from before the visit kept its id
            return event
        self._then = [row for row in self._then if row[0] != id]
        counterpart = self._counterparts.pop(id, None)
        return event._replace(name=f"{kind}.command.{counterpart}") if counterpart else None
