"""The activities of playing a motion and of speaking."""

from collections.abc import Mapping

from lumen.features.simulation.joint_transition import JointTransition
from lumen.features.simulation.lights import Lights
from lumen.features.simulation.motors import Motors
from lumen.features.simulation.sound_playback import SpeechPlayback
from lumen.language.commands import Say
from lumen.language.motions import Cue, MotionDefinition
from lumen.motion.trajectories import Trajectory
from lumen.robot.cues import CueNotifier, EventSink
from lumen.robot.joint_ways import APPROACH_TIME, RECOVERY_TIME, away, begun_from

_START_POSTURE_TOLERANCE = 0.05

LATE, BLOCKED, BLOCKED_ON_THE_WAY = 0.05, 0.2, 0.4
"""The tolerated errors of joints [rad; hands 0..1].

The first is between a key and the angle sent to the joint. The others are between the angle sent and the joint's
angle: at the motion's end, and at earlier keys.
"""


class MotionPlayback:
    """Plays a motion: first to its starting posture if necessary, then along its keys, with its cues.

    `home` has the starting posture's angles [rad] for the joints that the motion owns. `notice` receives the events of
    cues for words, sounds and skills. A joint that misses its keys does not end the motion; see `missed`.
    """

    def __init__(
        self,
        motors: Motors,
        lights: Lights,
        motion: MotionDefinition,
        home: Mapping[str, float],
        now: float,
        notice: EventSink = lambda _: None,
    ) -> None:
        self._motors, self._lights, self._motion, self._home = motors, lights, motion, home
        self._begin = self._now = now
        self._notice = notice
        self._cues: list[Cue] = []
        self._prompter = CueNotifier(motion, notice)
        self._trajectory: Trajectory | None = None
        far = away(home, motors.wanted(home), motors.body, _START_POSTURE_TOLERANCE)
        self._approach = JointTransition(motors, home, now, APPROACH_TIME) if far else None
        self._recovery: JointTransition | None = None
        self._keys: list[tuple[float, str]] = []
        self._missed: dict[str, tuple[float, float]] = {}

    @property
    def missed(self) -> str:
        """A message about joints that missed their keys, with the largest errors and their times; empty for none."""
        far = sorted(self._missed.items(), key=lambda item: -item[1][0])
        parts = (f"`{joint}` was {by:.2g} {self._motors.unit(joint)}off at {at:.2f} s" for joint, (by, at) in far)
        return f"in `{self._motion.name}` a joint missed its goal: {', '.join(parts)}" if far else ""

    @property
    def reached(self) -> float:
        """The time in the motion [s]; 0 on the way to the motion's beginning."""
        return self._now - self._begin if self._trajectory else 0.0

    def advance(self, now: float) -> bool:
        """Continue until `now` [s]; return True at the end.

        Raises BadCommandError if the motion can't be slowed down enough for the joints.
        """
        self._now = now
        if self._recovery:
            return self._recovery.advance(now)
        if self._approach:
            if not self._approach.advance(now):
                return False
            self._approach = None
        if self._trajectory is None:
            self._trajectory = self._begun(now)
        return self._play(self._trajectory, now - self._begin)

    def cancel(self) -> None:
        """Restore the motion's lights, empty the hand, and return to the starting posture within `RECOVERY_TIME`."""
        for cue in self._motion.cues:
            if cue.kind == "leds" and isinstance(cue.value, Mapping):
                self._lights.restore(cue.value)
        self._lights.hold(())
        self._recovery = JointTransition(self._motors, self._home, self._now, RECOVERY_TIME)

    def _begun(self, now: float) -> Trajectory:
        """Return the trajectory from the present angles. Raises BadCommandError if no delay suffices for the joints."""
        here = self._motors.wanted(self._motion.tracks)
        self._motion, self._begin = begun_from(self._motion, self._motors.body, here), now
        self._cues = sorted(self._motion.cues, key=lambda cue: cue.time)
        self._prompter = CueNotifier(self._motion, self._notice)
        self._keys = sorted((key.time, joint) for joint, keys in self._motion.tracks.items() for key in keys)
        return Trajectory(self._motion, here)

    def _play(self, trajectory: Trajectory, t: float) -> bool:
        while self._cues and self._cues[0].time <= t:
            self._cue(self._cues.pop(0))
        self._prompter.advance(t, self._now)
        self._note_keys(t)
        self._motors.aim(trajectory.sample(t))
        if t < self._motion.duration:
            return False
        for joint in self._motion.tracks:
            self._note(joint, self._motors.held_back(joint), BLOCKED, t)
        self._lights.hold(())
        return True

    def _note_keys(self, t: float) -> None:
        """Record the joints that miss a key due by `t` [s], because they are too slow or blocked."""
        while self._keys and self._keys[0][0] <= t:
            _, joint = self._keys.pop(0)
            self._note(joint, self._motors.lag(joint), LATE, t)
            self._note(joint, self._motors.held_back(joint), BLOCKED_ON_THE_WAY, t)

    def _note(self, joint: str, away: float, most: float, t: float) -> None:
        if away > max(most, self._missed.get(joint, (0.0, 0.0))[0]):
            self._missed[joint] = away, t

    def _cue(self, cue: Cue) -> None:
        if cue.kind == "leds" and isinstance(cue.value, Mapping):
            self._lights.show(cue.value)
        elif cue.kind == "hold":
            self._lights.hold((str(cue.value),))


class SpeechActivity:
    """Speaks a text for `duration` [s] while the robot's ears glow; `words` has the words' times, if known."""

    def __init__(self, lights: Lights, voice: SpeechPlayback, said: Say, volume: float, now: float) -> None:
        self._lights, self._voice, self._now = lights, voice, now
        self.duration = voice.begin(said.text, said.language, volume, now)
        self.words = voice.words
        self._until = now + self.duration
        lights.speak(True)

    def advance(self, now: float) -> bool:
        """Return True, and restore the ears, if the text has been spoken by `now` [s]."""
        self._now = now
        if now < self._until:
            return False
        self._voice.end(now)
        self._lights.speak(False)
        return True

    def cancel(self) -> None:
        """Stop the voice; the next `advance` ends the activity."""
        self._until = 0.0
        self._voice.end(self._now)
