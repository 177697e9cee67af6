"""Decides from faces and touches when the ears are open."""

import threading
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

ALWAYS, FACE, TOUCH, SPEAKS, NOBODY = "always", "face", "touch", "speaks", "nobody"
"""The reasons to listen or not to listen, as published on the route `listening`."""
AFTER_FACE, AFTER_TOUCH = 3.0, 10.0
"""The default times for which the ears stay open after a face and after a touch [s]: people look away while they
think, and need time to walk up.
"""
LEAD = 1.0
"""The time before a face or touch for which the ears count as open [s]: people nearby speak before they look."""
MAX_SPANS = 100
"""The maximum number of open spans that are kept; a sound lasts at most two minutes."""
NO_DISTANCE = "faces come without a `distance`, so `within` has no effect: delete it, or use Lumen's own eyes"
Span = tuple[float, float]


class Addressing:
    """Opens the ears for some seconds after a touch, or after a near face looks at the robot.

    Without settings, the ears are always open. `said` is `listens` of the module's settings; `tell` receives the reason
    if one of these has no effect. Messages can arrive on any thread, in chronological order.
    """

    def __init__(self, said: Mapping[str, Any], tell: Callable[[str], None]) -> None:
        self.always = not said
        self._said, self._tell, self._lock = said, tell, threading.Lock()
        self._until = {FACE: float("-inf"), TOUCH: float("-inf")}
        self._spans: deque[Span] = deque(maxlen=MAX_SPANS)

    def routes(self) -> Mapping[str, Callable[[Any, float], None]]:
        """Return the configured routes that open the ears, each with a function of a body and its arrival time [s]."""
        return {
            route: take
            for key, route, take in (("face", "face", self.face), ("touch", "tactile", self.touch))
            if key in self._said
        }

    def face(self, body: Any, at: float) -> None:
        """Open the ears if a face is near enough and looks at the robot.

        If a module does not report whether faces look, all of its faces count as looking.
        """
        said = self._said.get("face", {})
        match body:
            case {"looks": False}:
                return
            case {"distance": float() | int() as distance}:
                near = distance <= said.get("within", float("inf"))
            case dict():
                near = "within" not in said
                if not near:
                    self._tell(NO_DISTANCE)
            case _:
                return
        if near:
            self._open(FACE, at, said.get("after", AFTER_FACE))

    def touch(self, body: Any, at: float) -> None:
        """Open the ears if one of the configured sensors is pressed."""
        said = self._said.get("touch", {})
        match body:
            case {"name": list(names), "value": list(values)}:
                pressed = {name for name, value in zip(names, values, strict=False) if value and isinstance(name, str)}
                if pressed & set(said.get("sensors", pressed)):
                    self._open(TOUCH, at, said.get("after", AFTER_TOUCH))

    def closed(self, begin: float, end: float) -> list[Span]:
        """Return the spans between two times [s] in which the robot was not addressed, the earliest first."""
        if self.always:
            return []
        with self._lock:
            spans = [span for span in self._spans if span[0] < end and span[1] > begin]
        edges = [begin, *(edge for span in spans for edge in span), end]
        return [(b, e) for b, e in zip(edges[::2], edges[1::2], strict=True) if b < e]

    def state(self, now: float) -> tuple[str, float]:
        """Return the reason why the ears are open or closed, and when that ends [s], infinity if unknown."""
        if self.always:
            return ALWAYS, float("inf")
        with self._lock:
            because = max((TOUCH, FACE), key=lambda why: self._until[why])
            return (because, self._until[because]) if self._until[because] > now else (NOBODY, float("inf"))

    def _open(self, because: str, at: float, after: float) -> None:
        with self._lock:
            self._until[because] = at + after
            begin, end = at - LEAD, at + after
            if self._spans and self._spans[-1][1] >= begin:
                earlier = self._spans.pop()
                begin, end = min(begin, earlier[0]), max(end, earlier[1])
            self._spans.append((begin, end))
