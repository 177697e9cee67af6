"""What a centre wants its houses to run, and which of that a robot heeds."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

NOT = "!"
"""`!HASH` wants anything but that bundle: what the robot ran before it."""


@dataclass(frozen=True, slots=True)
class DesiredState:
    """What each robot of a house is to run, by its name: a hash, or `!HASH`.

    A `centre` counts its orders by `version`. Whoever takes over from another centre begins a higher `term`. `trying`
    is a bundle that each robot is to try and not to take, empty where there is none.
    """

    centre: str
    term: int
    version: int
    house: str
    robots: Mapping[str, str] = field(default_factory=dict)
    trying: str = ""

    def text(self) -> str:
        """As JSON text, which is what is signed."""
        data = {name: getattr(self, name) for name in self.__slots__}
        return json.dumps(data, sort_keys=True, separators=(",", ":"))


def desired_from(text: str) -> DesiredState | None:
    """The order that a text is, None for what is none."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return None
    match data:
        case {
            "centre": str(centre), "term": int(term), "version": int(version), "house": str(house),
            "robots": dict(robots),
        } if all(isinstance(want, str) for want in robots.values()):  # fmt: skip
            return DesiredState(centre, term, version, house, robots, str(data.get("trying", "")))
    return None


@dataclass(frozen=True, slots=True)
class FollowedOrder:
    """The last order that a robot heeded; `wanted` is what it is to run, empty where it may run what it does.

    `trying` is the bundle that it is to try.
    """

    centre: str = ""
    term: int = 0
    version: int = 0
    wanted: str = ""
    trying: str = ""

    def to_json(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in self.__slots__}


def heed(followed: FollowedOrder, desired: DesiredState, robot: str) -> tuple[FollowedOrder, str]:
    """What a robot follows once it has heard an order, and why it does not heed this one: empty where it does.

    No clock is asked: an order is newer by its term and version, however late it comes. Signatures were checked.
    """
    wanted = desired.robots.get(robot, "")
    newer = replace(followed, centre=desired.centre, term=desired.term, version=desired.version, wanted=wanted)
    newer = replace(newer, trying=desired.trying)
    if not followed.centre or desired.term > followed.term:
        return newer, ""
    if desired.term < followed.term:
        return followed, f"centre {desired.centre[:8]} was replaced: its term {desired.term} is over"
    if desired.centre != followed.centre:
        other, own = desired.centre[:8], followed.centre[:8]
        return followed, f"there are two centres: {other} sent an order, but this robot follows {own}"
    if desired.version > followed.version:
        return newer, ""
    if desired.version == followed.version and wanted != followed.wanted:
        return followed, f"order {desired.version} differs from the one that arrived first"
    return followed, ""
