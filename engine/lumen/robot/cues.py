"""The words, sounds and skills of a motion, raised as events at their times."""

from collections.abc import Callable

from lumen.language.events import CUE, Event
from lumen.language.motions import SKILL_CUE, Cue, MotionDefinition

NOTIFIED_KINDS = ("say", "sound", SKILL_CUE)
"""The kinds of cues that a robot raises as events; it performs the others itself."""

EventSink = Callable[[Event], None]


def cue_event(motion: MotionDefinition, cue: Cue, now: float) -> Event:
    """Return the event which reports that a cue of a motion is due."""
    return Event(CUE, {"motion": motion.name, "kind": cue.kind, "value": cue.value}, now)


class CueNotifier:
    """Passes a motion's cues to `notice` as events, each at its time."""

    def __init__(self, motion: MotionDefinition, notice: EventSink) -> None:
        self._motion, self._notice = motion, notice
        self._left = sorted(
            (cue for cue in motion.cues if cue.kind in NOTIFIED_KINDS), key=lambda cue: cue.time, reverse=True
        )

    def advance(self, t: float, now: float) -> None:
        """Raise the cues until `t` [s] after the motion's beginning; that moment is `now` on the robot's clock."""
        while self._left and self._left[-1].time <= t:
            self._notice(cue_event(self._motion, self._left.pop(), now))
