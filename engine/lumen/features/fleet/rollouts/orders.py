"""A centre's orders to its houses, and a robot's decision whether to accept an order."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

NOT = "!"
"""The prefix in `!HASH`: a robot that runs that bundle should return to its previous bundle."""


@dataclass(frozen=True, slots=True)
class DesiredState:
    """An order: the bundle that each robot of a house should run."""

    centre: str
    """The centre's id."""
    term: int
    """The number of the centre's term, which grows when a centre takes over from another."""
    version: int
    """The order's number in this term."""
    house: str
    robots: Mapping[str, str] = field(default_factory=dict)
    """A bundle's hash, or `!HASH`, for each robot's name."""
    trying: str = ""
    """The bundle that each robot should try without switching to it; empty for none."""

    def text(self) -> str:
        """Return the order as JSON text, which the centre signs."""
        data = {name: getattr(self, name) for name in self.__slots__}
        return json.dumps(data, sort_keys=True, separators=(",", ":"))


def desired_from(text: str) -> DesiredState | None:
    """Return the order in a JSON text; None if it is invalid."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return None
    match data:
        case {
            "centre": str(centre),
            "term": int(term),
            "version": int(version),
            "house": str(house),
            "robots": dict(robots),
        } if all(isinstance(want, str) for want in robots.values()):
            return DesiredState(centre, term, version, house, robots, str(data.get("trying", "")))
    return None


@dataclass(frozen=True, slots=True)
class FollowedOrder:
    """The last order that a robot accepted."""

    centre: str = ""
    term: int = 0
    version: int = 0
    wanted: str = ""
    """The bundle that the robot should run (a hash, or `!HASH`); empty if the robot can keep its files."""
    trying: str = ""
    """The bundle that the robot should try; empty for none."""

    def to_json(self) -> dict[str, Any]:
        """Return the order as JSON data."""
        return {name: getattr(self, name) for name in self.__slots__}


def heed(followed: FollowedOrder, desired: DesiredState, robot: str) -> tuple[FollowedOrder, str]:
    """Return the order that a robot follows after receiving `desired`, and the reason if it rejects `desired`.

    The reason is empty if `desired` is accepted, older in the same term, or repeated. Term and version decide which
    order is newer, regardless of clocks. The caller must have verified the signature.
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
