"""When the ears are open, by whom the robot sees and feels."""

import threading
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

ALWAYS, FACE, TOUCH, SPEAKS, NOBODY = "always", "face", "touch", "speaks", "nobody"
"""Why they listen, or why they do not: as the route `listening` has it."""
AFTER_FACE, AFTER_TOUCH = 3.0, 10.0
"""For how long they stay open [s], where `lumen.yaml` does not say: people look away as they think, and walk up."""
LEAD = 1.0
"""So long before the face or the touch counts too [s]: who is near begins to speak, and then looks."""
MAX_SPANS = 100
"""Stretches that are remembered; a sound lasts two minutes at most."""
NO_DISTANCE = "faces come without a `distance`, so `within` has no effect: delete it, or use Lumen's own eyes"
Span = tuple[float, float]


class Addressing:
    """Open for some seconds from each face that is near and looks, and from each touch; always where nothing is said.

    `said` is `listens` of the module's settings; `tell` hears what makes it useless. Messages may come on any thread,
    at times that do not fall.
    """

    def __init__(self, said: Mapping[str, Any], tell: Callable[[str], None]) -> None:
        self.always = not said
        self._said, self._tell, self._lock = said, tell, threading.Lock()
        self._until = {FACE: float("-inf"), TOUCH: float("-inf")}
        self._spans: deque[Span] = deque(maxlen=MAX_SPANS)

    def routes(self) -> Mapping[str, Callable[[Any, float], None]]:
        """What it goes by: the routes, and what it does with a body that came at a time [s]."""
        return {route: take for key, route, take in (("face", "face", self.face), ("touch", "tactile", self.touch))
                if key in self._said}  # fmt: skip

    def face(self, body: Any, at: float) -> None:
        """A face in the image. Whose module does not say whether it looks is taken to find those only who do."""
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
        """Which sensors are pressed."""
        said = self._said.get("touch", {})
        match body:
            case {"name": list(names), "value": list(values)}:
                pressed = {name for name, value in zip(names, values, strict=False) if value and isinstance(name, str)}
                if pressed & set(said.get("sensors", pressed)):
                    self._open(TOUCH, at, said.get("after", AFTER_TOUCH))

    def closed(self, begin: float, end: float) -> list[Span]:
        """The stretches between these times [s] in which nobody meant the robot, the earliest first."""
        if self.always:
            return []
        with self._lock:
            spans = [span for span in self._spans if span[0] < end and span[1] > begin]
        edges = [begin, *(edge for span in spans for edge in span), end]
        return [(b, e) for b, e in zip(edges[::2], edges[1::2], strict=True) if b < e]

    def state(self, now: float) -> tuple[str, float]:
        """Why they are open, else `nobody`; and until when that is so [s], if nothing comes."""
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
