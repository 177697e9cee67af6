"""Which states are active in the middle of a microstep, as `In()` asks it."""

from collections.abc import Mapping


class ActiveView:
    """What is active at one place of a way out or in, by name: `before` the way, and what was passed so far.

    It needs no set of its own: a way through a thousand regions has a thousand moments.
    """

    __slots__ = ("before", "inwards", "passed", "place")

    def __init__(self, before: frozenset[str], passed: Mapping[str, int], place: int, inwards: bool) -> None:
        self.before, self.passed, self.place, self.inwards = before, passed, place, inwards

    def __contains__(self, name: object) -> bool:
        place = self.passed.get(str(name))
        if place is None:
            return name in self.before
        return place <= self.place if self.inwards else place >= self.place
