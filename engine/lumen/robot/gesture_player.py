"""The gestures that accompany what the robot says: planned when a text begins, and played beneath all commands."""

from collections import deque
from collections.abc import Collection, Sequence

from lumen.language.body_parts import part_of
from lumen.language.commands import Say
from lumen.language.gestures import NO_GESTURES, GestureLibrary, WordTime
from lumen.language.robots import Body
from lumen.motion.gestures import GESTURE_SHARE, PlannedGesture, gesture_offsets, plan_gestures
from lumen.robot.joint_offsets import approach

TEXTS_APART = 2
"""The number of texts between two with the same gesture."""

SETTLING = 0.06
"""The time constant with which joints follow a gesture that begins or ends abruptly [s]."""


class GesturePlayer:
    """The offsets that gestures add to each joint [rad; hands 0..1].

    Its state is the text under way, the gestures of the last texts, the number of texts so far, and the present
    offsets of the joints.
    """

    def __init__(self, body: Body, seed: int = 0) -> None:
        self.library: GestureLibrary = NO_GESTURES
        self._seed, self._part = seed, part_of(body)
        self._speeds = {joint.name: GESTURE_SHARE * joint.speed for joint in body.joints.values()}
        self._plan: tuple[PlannedGesture, ...] = ()
        self._begin = 0.0
        self._texts = 0
        self._recent: deque[frozenset[str]] = deque(maxlen=TEXTS_APART)
        self._offsets: dict[str, float] = {}

    def say(self, said: Say, duration: float, now: float, words: Sequence[WordTime] = ()) -> tuple[str, ...]:
        """Plan the gestures of a text of `duration` [s] that begins at `now` [s]; return their names.

        `words` has the time at which each word begins; without it, the times follow from the words' places in the text.
        """
        library = NO_GESTURES if said.gestures == "none" else self.library
        self._texts += 1
        self._begin = now
        recent = frozenset[str]().union(*self._recent)
        self._plan = plan_gestures(said.text, said.language, library, duration, recent, self._seed + self._texts, words)
        names = tuple(planned.gesture.name for planned in self._plan)
        self._recent.append(frozenset(names))
        return names

    def hush(self, now: float) -> None:
        """Drop the gestures that have not begun, because the speech has ended."""
        self._plan = tuple(planned for planned in self._plan if self._begin + planned.at < now)

    def still(self) -> None:
        """Drop all gestures and offsets, because the motors are off."""
        self._offsets.clear()
        self._plan = ()

    def wanted(self, now: float, free: Collection[str]) -> dict[str, float]:
        """Return the offsets at `now` [s] of joints in the parts that are `free`."""
        found: dict[str, float] = {}
        for planned in self._plan:
            since = now - self._begin - planned.at
            offsets = gesture_offsets(planned.gesture, since, other_side=planned.other_side)
            found |= {joint: angle for joint, angle in offsets.items() if self._part.get(joint) in free}
        return found

    def advance(self, now: float, dt: float, free: Collection[str]) -> dict[str, float]:
        """Return the offsets at `now` [s], `dt` [s] after the last ones."""
        goals = self.wanted(now, free) if self._plan else {}
        approach(self._offsets, goals, self._speeds, dt, SETTLING)
        return self._offsets
