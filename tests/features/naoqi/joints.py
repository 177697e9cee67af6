"""The fake's joints: ALMotion's tasks, each with its joints, a way through time, and the call that waits for it."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from lumen.language.robots import Body
from tests.features.naoqi.times import Blocked, Times

Way = Callable[[float], Mapping[str, float]]


@dataclass(eq=False)
class Task:
    """Moves `names` along `way`, from `begin` to `end` [s]."""

    names: Sequence[str]
    begin: float
    end: float
    way: Way
    call: Blocked | None = None


def straight(start: Mapping[str, float], goal: Mapping[str, float], seconds: float) -> Way:
    def way(t: float) -> Mapping[str, float]:
        u = min(1.0, t / seconds) if seconds > 0 else 1.0
        return {name: start[name] + u * (goal[name] - start[name]) for name in goal}

    return way


def bezier(start: float, times: Sequence[float], controls: Sequence[Any]) -> Callable[[float], float]:
    """Return a joint's angle by time, as ALMotion documents it. Raises RuntimeError for a bad control point."""
    keys = [(0.0, start, (0.0, 0.0), (0.0, 0.0))]
    for time, (angle, (kind_in, *into), (kind_out, *out)) in zip(times, controls, strict=True):
        if kind_in != 3 or kind_out != 3 or into[0] > 0 or out[0] < 0:
            raise RuntimeError("ALMotion::angleInterpolationBezier\n\tBad control point")
        keys.append((time, angle, tuple(into), tuple(out)))

    def way(t: float) -> float:
        for (t0, a0, _, out), (t1, a1, into, _) in pairwise(keys):
            if t <= t1:
                xs = (t0, t0 + out[0], t1 + into[0], t1)
                low, high = 0.0, 1.0
                for _ in range(40):
                    u = (low + high) / 2
                    low, high = (u, high) if _cubic(u, *xs) < t else (low, u)
                return _cubic((low + high) / 2, a0, a0 + out[1], a1 + into[1], a1)
        return float(keys[-1][1])

    return way


def _cubic(u: float, a: float, b: float, c: float, d: float) -> float:
    v = 1 - u
    return v * v * v * a + 3 * v * v * u * b + 3 * v * u * u * c + u * u * u * d


class Joints:
    """The angles of the joints [rad], and the tasks that move them."""

    def __init__(self, body: Body, times: Times) -> None:
        self.body, self._times = body, times
        self._angles = dict(body.postures["Stand"])
        self._tasks: list[Task] = []

    def known(self, names: Any, method: str) -> list[str]:
        """Return the names as a list; raise ALMotion's error for an unknown joint."""
        listed = [names] if isinstance(names, str) else list(names)
        for name in listed:
            if name not in self.body.joints:
                raise RuntimeError(f"ALMotion::{method}\n\tInvalid joint name: {name}")
        return listed

    def angles(self) -> dict[str, float]:
        """Return the present angle of each joint [rad]."""
        now = self._times.now
        for task in self._tasks[:]:
            self._angles.update(task.way(min(now, task.end) - task.begin))
            if now >= task.end:
                self._remove(task)
        for follower, leader in self.body.shared.items():
            self._angles[follower] = self._angles[leader]
        return dict(self._angles)

    def move(self, goal: Mapping[str, float], seconds: float, *, blocking: bool = True) -> Any:
        """Move straight to `goal` [rad] in so many seconds; return the result of the call."""
        start = self.angles()
        return self.follow(list(goal), straight(start, dict(goal), seconds), seconds, blocking=blocking)

    def follow(self, names: Sequence[str], way: Way, seconds: float, *, blocking: bool = True) -> Any:
        self.kill(names)
        now = self._times.now
        task = Task(names, now, now + seconds, way)
        self._tasks.append(task)
        if blocking:
            task.call = self._times.block(seconds, lambda: self.angles() and None)
            return task.call.future
        return None

    def _remove(self, task: Task) -> None:
        with suppress(ValueError):  # another thread has removed it meanwhile
            self._tasks.remove(task)

    def kill(self, names: Sequence[str]) -> None:
        """End the tasks that use one of these joints, which keep their present angles."""
        self.angles()
        for task in [t for t in self._tasks if not set(names).isdisjoint(t.names)]:
            self._remove(task)
            if task.call:
                task.call.end()
