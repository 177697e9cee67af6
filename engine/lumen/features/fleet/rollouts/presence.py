"""What a robot tells its centre of itself every ten seconds, as JSON data: no names, no words, no images."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.language.numbers import is_finite_number

MAX_TEXT = 300
MAX_MEASURES = 50
PROVED, PROBATION, WAITING, FETCHING, CHECKING, REFUSED, ROLLED_BACK, BROKEN = (
    "proved", "probation", "waiting", "fetching", "checking", "refused", "rolled back", "edited",
)  # fmt: skip
STATES = (PROVED, PROBATION, WAITING, FETCHING, CHECKING, REFUSED, ROLLED_BACK, BROKEN)
"""How far a robot is with the bundle that it is to have; `edited`: somebody changed its files by hand."""

SAME, DIFFER = "same", "differ"
TRIED = (SAME, DIFFER, REFUSED)
"""What comes of a bundle that a robot tries: its last visits come out as they were, some do not, or it is refused."""

HOURS = "hours"
"""The measure that is always counted: how long a bundle has run [h]."""


@dataclass(frozen=True, slots=True)
class RobotPresence:
    """`bundle` runs; with the bundle `about` the robot is as far as `state` says, `trouble` says why no farther.

    `centre`, `term` and `version` are of the order that it follows. `wants` is the hash of a bundle that it lacks.
    `tried` is what came of a bundle that was tried and not taken, empty where none was: `bundle`, `verdict` (one of
    `TRIED`), how many visits were `played` and how many came out the `same`, and `why` it is refused.
    `played` of its last visits were played with the bundle, and `same` of them came out as they were.
    `now` and `before` are counts since `bundle` runs, and of the bundle before. `clock` is what its clock says [s since
    1970].
    """

    robot: str
    bundle: str = ""
    state: str = PROVED
    about: str = ""
    trouble: str = ""
    wants: str = ""
    centre: str = ""
    term: int = 0
    version: int = 0
    now: Mapping[str, float] = field(default_factory=dict)
    before: Mapping[str, float] = field(default_factory=dict)
    clock: float = 0.0
    since: float = 0.0
    played: int = 0
    same: int = 0
    tried: Mapping[str, Any] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in self.__slots__ if name != "robot"}


def presence_from(robot: str, body: Any) -> RobotPresence | None:
    """The presence that a message tells, None for one that is none."""
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
    """Counts by their name, None for what is none."""
    return dict(data) if _measures(data) else None


def _measures(data: Any) -> bool:
    if not isinstance(data, Mapping) or len(data) > MAX_MEASURES + 1:
        return False
    return all(isinstance(name, str) and is_finite_number(count) and count >= 0 for name, count in data.items())
