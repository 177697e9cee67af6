"""The report that a robot sends its centre every 10 s as JSON data, without people's names, words or images."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.features.fleet.settings import FleetMeasure
from lumen.language.numbers import is_finite_number

MAX_TEXT = 300
MAX_MEASURES = 50
PROVED, PROBATION, WAITING, FETCHING, CHECKING, REFUSED, ROLLED_BACK, BROKEN = (
    "proved", "probation", "waiting", "fetching", "checking", "refused", "rolled back", "edited",
)  # fmt: skip
STATES = (PROVED, PROBATION, WAITING, FETCHING, CHECKING, REFUSED, ROLLED_BACK, BROKEN)
"""The states of a robot with the bundle that it should run; `edited` means that its files were changed locally."""

SAME, DIFFER = "same", "differ"
TRIED = (SAME, DIFFER, REFUSED)
"""The results of a trial: the last visits were unchanged, some visits differed, or the bundle was refused."""

HOURS = "hours"
"""The measure that is always counted: the time for which a bundle has run [h]."""


@dataclass(frozen=True, slots=True)
class RobotPresence:
    """A robot's report about itself."""

    robot: str
    """The robot, as `HOUSE/ROBOT`."""
    bundle: str = ""
    """The running bundle's hash."""
    state: str = PROVED
    """The robot's state with the bundle `about`."""
    about: str = ""
    """The hash of the bundle that the robot was ordered to run; without such an order, of the running bundle."""
    trouble: str = ""
    """The robot's present problem, such as the reason for no progress; empty for none."""
    wants: str = ""
    """The hash of a bundle that the robot should run or try but lacks; empty for none."""
    centre: str = ""
    """The id of the centre that the robot follows."""
    term: int = 0
    """The term of the robot's last accepted order."""
    version: int = 0
    """The version of the robot's last accepted order."""
    now: Mapping[str, float] = field(default_factory=dict)
    """Counts since `bundle` began to run."""
    before: Mapping[str, float] = field(default_factory=dict)
    """Counts of the bundle that ran before."""
    clock: float = 0.0
    """The robot's clock time [s since 1970]."""
    since: float = 0.0
    """The time at which `bundle` began to run [s since 1970]."""
    played: int = 0
    """The number of the robot's last visits that were replayed with the bundle."""
    same: int = 0
    """The number of replayed visits that were unchanged."""
    tried: Mapping[str, Any] = field(default_factory=dict)
    """The result of a trial; empty without a trial.

    Its keys are `bundle`, `verdict` (from `TRIED`), `played` and `same` (numbers of visits), and `why` (the reason
    for a refusal).
    """

    def to_json(self) -> dict[str, Any]:
        """Return the presence as JSON data, without the robot's name."""
        return {name: getattr(self, name) for name in self.__slots__ if name != "robot"}


def presence_from(robot: str, body: Any) -> RobotPresence | None:
    """Return the presence in a message's body; None if the body is invalid."""
    if not isinstance(body, Mapping):
        return None
    texts = {name: body.get(name, "") for name in ("bundle", "state", "about", "trouble", "wants", "centre")}
    counts = {name: body.get(name, 0) for name in ("term", "version", "played", "same")}
    times = {name: body.get(name, 0.0) for name in ("clock", "since")}
    measures = {name: body.get(name, {}) for name in ("now", "before")}
    sound = (
        all(isinstance(text, str) and len(text) <= MAX_TEXT for text in texts.values())
        and all(isinstance(count, int) and not isinstance(count, bool) and count >= 0 for count in counts.values())
        and all(is_finite_number(time) for time in times.values())
        and all(_measures(each) for each in measures.values())
        and texts["state"] in STATES
        and _tried(tried := body.get("tried", {}))
    )
    return RobotPresence(robot, **texts, **counts, **times, **measures, tried=dict(tried)) if sound else None


def _tried(data: Any) -> bool:
    match data:
        case {"bundle": str(bundle), "verdict": verdict, "played": int(played), "same": int(same), "why": str(why)}:
            return verdict in TRIED and max(len(bundle), len(why)) <= MAX_TEXT and 0 <= same <= played
    return bool(data == {})


def measures_from(data: Any) -> dict[str, float] | None:
    """Return the counts by measure in a message's data; None if the data is invalid."""
    return dict(data) if _measures(data) else None


def _measures(data: Any) -> bool:
    if not isinstance(data, Mapping) or len(data) > MAX_MEASURES + 1:
        return False
    return all(isinstance(name, str) and is_finite_number(count) and count >= 0 for name, count in data.items())


def rates(counts: Iterable[Mapping[str, float]], measures: Mapping[str, FleetMeasure]) -> dict[str, float]:
    """Return each measure over all these counts: per robot hour, or per count of another measure.

    A measure is left out if no counts with hours contain it, or if the other measure's sum is 0.
    """
    rows = list(counts)
    found = {}
    for name, measure in measures.items():
        known = [row for row in rows if row.get(HOURS, 0.0) > 0.0 and name in row]
        per = sum(row.get(measure.per or HOURS, 0.0) for row in known)
        if per > 0.0:
            found[name] = sum(row[name] for row in known) / per
    return found
