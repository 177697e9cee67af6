"""One watched performance of a motion."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from math import degrees, hypot
from typing import Any, Self

from lumen.features.simulation.trials.cases import Case
from lumen.language.events import Event
from lumen.ports import Live, RobotCommand, Sole, Strain, Subject

POLL_INTERVAL = 0.02
"""The time between two samples of the robot's state [s]."""

STUCK_AFTER = 60.0
"""The time by which a command can exceed its motion before the command counts as stuck [s]."""

REST_BEFORE, REST_AFTER = 0.3, 0.5
"""The durations of the robot's rest before and after the motion [s]."""

RETRIED_AFTER = 1.5
"""The time by which a passage can exceed its motion before the passage counts as retried [s]."""

LEANING_TILT, FALLING_TILT = 15.0, 30.0
"""The tilts of the torso at which a fall begins, and beyond which problems are consequences of the fall [degrees]."""

DONE, FELL = "done", "fell"
MAX_FOOT_SLIDE = 0.01
"""The largest accepted slide of a foot under load [m]."""

BEARING_FORCE = 5.0
"""The force above which a foot bears load [N]."""

TimedAmount = tuple[float, float]
"""A time since the motion's beginning [s], and a duration or amount."""

_KINDS = ("collisions", "exhausted", "behind", "slid")


@dataclass
class Outcome:
    """The outcome of one performance."""

    answer: str = ""
    """`done`, `fell`, or the reason why the robot stopped; empty if it did not reach the motion's beginning."""
    at: float = 0.0
    """The time of the answer, or of the fall's beginning [s]."""
    tilt: float = 0.0
    """The maximum tilt of the torso [degrees]."""
    leaned: float = 0.0
    """The time of the maximum tilt [s]."""
    collisions: dict[str, TimedAmount] = field(default_factory=dict)
    """By `LINK and LINK`, the time of the first contact and the total duration of all contacts [s]."""
    exhausted: dict[str, TimedAmount] = field(default_factory=dict)
    """By joint, the time of the longest period at full torque without a pause, and its length [s]."""
    behind: dict[str, TimedAmount] = field(default_factory=dict)
    """By joint, the time and the size of the maximum distance behind the motion [rad]."""
    slid: dict[str, TimedAmount] = field(default_factory=dict)
    """By foot, the time and the size of the maximum slide while bearing load [m]."""

    def to_json(self) -> dict[str, Any]:
        """Return the outcome as JSON data."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Return the outcome from JSON data.

        Raises KeyError, TypeError, ValueError or AttributeError if the data is invalid.
        """
        moments = {kind: {str(k): (float(a), float(b)) for k, (a, b) in data[kind].items()} for kind in _KINDS}
        return cls(str(data["answer"]), float(data["at"]), float(data["tilt"]), float(data["leaned"]), **moments)


def attempt(case: Case, robot: Subject) -> Outcome:
    """Play the case and return its outcome; `answer` is empty if the robot did not reach the motion's beginning."""
    if any(_perform(robot, command) != DONE for command in case.before):
        return Outcome()
    robot.advance(REST_BEFORE)
    robot.poll()
    watch = _Watch(case.passage or case.living)
    watch.outcome.answer = _perform(robot, case.command, watch, case.motion.duration)
    return watch.closed(robot)


def _perform(robot: Subject, command: RobotCommand, watch: "_Watch | None" = None, duration: float = 0.0) -> str:
    """Perform a command to its end; return `done`, `fell`, or the reason why it failed."""
    robot.start("it", command)
    waited = 0.0
    lasts = duration if isinstance(command, Live) else duration + STUCK_AFTER
    while waited < lasts:
        robot.advance(POLL_INTERVAL)
        waited += POLL_INTERVAL
        if watch:
            watch.look(robot.strain(), waited)
        events = robot.poll()
        if any(event.name == "fallen" for event in events):
            return FELL
        for event in events:
            if event.name.endswith(".command.it"):
                return _answer(event)
    return DONE if isinstance(command, Live) else "it does not end"


def _answer(event: Event) -> str:
    return DONE if event.name.startswith("done.") else str((event.data or {}).get("reason", "it was cancelled"))


class _Watch:
    """Collects a performance's problems, sample by sample; for a passage or a style of life, only tilt and falls."""

    def __init__(self, passage: bool) -> None:
        self.outcome, self._passage = Outcome(), passage
        self._now = self._steady = 0.0
        self._stands: dict[str, Sole] = {}
        self._since: dict[str, float] = {}

    def look(self, strain: Strain, waited: float) -> None:
        """Record the robot's strain, `waited` [s] after the command."""
        self._now = waited if self._passage else strain.played
        tilt = degrees(strain.tilt)
        if tilt > self.outcome.tilt:
            self.outcome.tilt, self.outcome.leaned = tilt, round(self._now, 3)
        if tilt < LEANING_TILT:
            self._steady = self._now
        if not self._passage and tilt < FALLING_TILT and strain.played > 0.0:
            self._press(strain)
            self._exhaust(strain)
            self._delay(strain)
            self._slide(strain.soles)

    def closed(self, robot: Subject) -> Outcome:
        """Return the outcome after a short rest, in which the robot can still fall."""
        if self.outcome.answer == DONE:
            robot.advance(REST_AFTER)
            self.outcome.tilt = max(self.outcome.tilt, degrees(robot.strain().tilt))
            if any(event.name == "fallen" for event in robot.poll()):
                self.outcome.answer = FELL
        self.outcome.at = round(self._steady if self.outcome.answer == FELL else self._now, 3)
        self.outcome.tilt = round(self.outcome.tilt, 1)
        return self.outcome

    def _press(self, strain: Strain) -> None:
        for one, other in strain.touching:
            begin, lasted = self.outcome.collisions.get(f"{one} and {other}", (round(self._now, 3), 0.0))
            self.outcome.collisions[f"{one} and {other}"] = begin, round(lasted + POLL_INTERVAL, 3)

    def _exhaust(self, strain: Strain) -> None:
        """Record each motor's longest time at full torque without a pause."""
        self._since = {joint: self._since.get(joint, self._now) for joint in strain.exhausted}
        for joint, since in self._since.items():
            _most(self.outcome.exhausted, joint, since, self._now - since)

    def _delay(self, strain: Strain) -> None:
        for joint, angle in strain.behind.items():
            _most(self.outcome.behind, joint, self._now, angle)

    def _slide(self, soles: Mapping[str, Sole]) -> None:
        """Record the largest distance of each loaded foot from the place where its load began."""
        for side, sole in soles.items():
            if sole.load < BEARING_FORCE:
                self._stands.pop(side, None)
                continue
            stands = self._stands.setdefault(side, sole)
            far = hypot(sole.x - stands.x, sole.y - stands.y)
            since, most = self.outcome.slid.get(side, (0.0, 0.0))
            _most(self.outcome.slid, side, since if most >= MAX_FOOT_SLIDE else self._now, far)


def _most(found: dict[str, TimedAmount], what: str, at: float, value: float) -> None:
    """Keep the amount and its time if the amount exceeds the one kept before."""
    if value > found.get(what, (0.0, 0.0))[1]:
        found[what] = round(at, 3), round(value, 4)


@dataclass(frozen=True)
class CaseResult:
    """A case and its outcome on each robot; the first robot is the unchanged model."""

    case: Case
    outcomes: Sequence[Outcome]

    @property
    def tried(self) -> Sequence[Outcome]:
        """The outcomes of robots that reached the motion's beginning."""
        return [outcome for outcome in self.outcomes if outcome.answer]

    def succeeded(self, outcome: Outcome) -> bool:
        """Return True if the robot reached the motion's end; for a passage, at the first attempt."""
        late = self.case.passage and outcome.at > self.case.motion.duration + RETRIED_AFTER
        return outcome.answer == DONE and not late
