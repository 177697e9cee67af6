"""Where joints stood, by time, as far back as anybody asks."""

from bisect import bisect_left, bisect_right
from collections import deque
from collections.abc import Mapping

JointAngles = dict[str, float]


class JointHistory:
    """The angles [rad] of some joints at increasing times [s]; what is older than `memory` [s] is forgotten."""

    def __init__(self, memory: float) -> None:
        self.memory = memory
        self.known: deque[tuple[float, JointAngles]] = deque()

    def __bool__(self) -> bool:
        return bool(self.known)

    @property
    def last(self) -> float:
        """The time [s] of what is newest."""
        return self.known[-1][0]

    def add(self, time: float, angles: Mapping[str, float]) -> None:
        """Remember these; nothing where the time is not after all others."""
        if self.known and time <= self.last:
            return
        self.known.append((time, dict(angles)))
        while len(self.known) > 1 and self.known[1][0] < time - self.memory:
            self.known.popleft()

    def at(self, time: float) -> JointAngles:
        """Where the joints were, on the straight way from one known place to the next; the nearest outside them."""
        i = bisect_left(self.known, time, key=lambda entry: entry[0])
        if i == 0 or i == len(self.known):
            return dict(self.known[min(i, len(self.known) - 1)][1])
        (t0, before), (t1, after) = self.known[i - 1], self.known[i]
        w = (time - t0) / (t1 - t0)
        return {joint: angle + w * (after[joint] - angle) for joint, angle in before.items()}

    def steady(self, joint: str, start: float, end: float, within: float) -> bool:
        """Whether what is known of the joint from `start` to `end` [s], and just before, is `within` so much [rad]."""
        first = bisect_right(self.known, start, key=lambda entry: entry[0]) - 1
        after = bisect_right(self.known, end, key=lambda entry: entry[0])
        angles = [self.known[i][1][joint] for i in range(max(first, 0), after)]
        return first >= 0 and max(angles) - min(angles) <= within
