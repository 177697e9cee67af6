"""Checks motions, begins them at the robot's present angles, and sends each to NAOqi as one call."""

from collections.abc import Callable, Collection, Mapping, Sequence

from lumen.errors import RobotRefusedError
from lumen.features.naoqi.call_sequence import CallSequence, CallSteps, WhileWaiting
from lumen.features.naoqi.curves import curves
from lumen.features.naoqi.lights import fades
from lumen.features.naoqi.session import NaoqiCall
from lumen.features.naoqi.walks import PostCall, grounded
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.motion.postures import UPRIGHT
from lumen.motion.trajectories import JointTrack, Trajectory
from lumen.robot.cues import CueNotifier, EventSink
from lumen.robot.joint_ways import APPROACH_TIME, RECOVERY_TIME, away, begun_from, home_angles, way_duration


class CuePlayer:
    """Plays a motion's cues at their times; `post` lights the LEDs, `notice` receives words and sounds."""

    def __init__(self, post: PostCall, motion: MotionDefinition, body: Body, notice: EventSink) -> None:
        self._post, self._body = post, body
        self._cues = sorted((cue for cue in motion.cues if cue.kind == "leds"), key=lambda cue: -cue.time)
        self._prompter = CueNotifier(motion, notice)
        self._begin = 0.0

    def begin(self, now: float) -> None:
        """Set the motion's start to `now` [s]; cue times are relative to it."""
        self._begin = now

    def __call__(self, now: float) -> None:
        self._prompter.advance(now - self._begin, now)
        while self._cues and self._cues[-1].time <= now - self._begin:
            for fade in fades(self._cues.pop().value, self._body):
                self._post("ALLeds", "fadeRGB", *fade)


START_POSTURE_TOLERANCE = 0.1
"""The distance from the starting posture above which the joints first move there [rad]."""


class MotionPlayer:
    """Begins motions.

    `post` calls NAOqi, `notice` receives a motion's words and sounds, and `clock` returns the time [s].
    """

    def __init__(self, post: PostCall, body: Body, notice: EventSink, clock: Callable[[], float]) -> None:
        self._post, self._body, self._notice, self._clock = post, body, notice, clock

    def begin(self, motion: MotionDefinition, owned: Collection[str]) -> CallSequence:
        """Return the activity of a motion.

        Joints of the parts `owned` move to the starting posture before the motion if necessary, and after cancelling.
        """
        shared = self._body.shared
        home = {name: angle for name, angle in home_angles(motion, self._body, owned).items() if name not in shared}
        joints = list(dict.fromkeys(shared.get(joint, joint) for joint in (*motion.tracks, *home)))

        def abort() -> list[NaoqiCall]:
            return [self._post("ALMotion", "killTasksUsingResources", joints)] if joints else []

        return CallSequence(self._perform(motion, home, joints), abort, lambda: self._recover(home))

    def _perform(self, motion: MotionDefinition, home: Mapping[str, float], joints: list[str]) -> CallSteps:
        yield from self._ready(motion)
        here = yield from self._stand(joints)
        if away(home, here, self._body, START_POSTURE_TOLERANCE):
            yield self._go(home, here, APPROACH_TIME)
            here = yield from self._stand(joints)
        start = self._inside(motion, here)
        motion = begun_from(motion, self._body, start)
        beside = CuePlayer(self._post, motion, self._body, self._notice)
        way = curves(self._driven(Trajectory(motion, start).tracks))
        begin = self._clock()
        beside.begin(begin)
        if way.names:
            yield WhileWaiting(self._post("ALMotion", "angleInterpolationBezier", *way), beside)
        while (now := self._clock()) < begin + motion.duration:
            beside(now)
            yield None
        beside(now)

    def _ready(self, motion: MotionDefinition) -> CallSteps:
        """Raise RobotRefusedError if the motors are off, or the motion begins upright but the robot is not upright."""
        if not (yield self._post("ALMotion", "robotIsWakeUp")):
            raise RobotRefusedError("the motors are off: `wake` first")
        if motion.start in UPRIGHT:
            family = yield self._post("ALRobotPosture", "getPostureFamily")
            if grounded(family):
                raise RobotRefusedError(
                    f"`{motion.name}` begins in {motion.start}; the robot is {family}: send it there first"
                )

    def _stand(self, joints: list[str]) -> CallSteps:
        """Return the commanded angles [rad] by joint, from which NAOqi begins each motion."""
        if not joints:
            return {}
        angles = yield self._post("ALMotion", "getAngles", joints, False)
        return dict(zip(joints, angles, strict=True))

    def _recover(self, home: Mapping[str, float]) -> CallSteps:
        """Move the joints back to the starting posture, because a killed motion stops midway."""
        if home:
            here = yield from self._stand(list(home))
            yield self._go(home, here, RECOVERY_TIME)

    def _go(self, goal: Mapping[str, float], here: Mapping[str, float], seconds: float) -> NaoqiCall:
        """Return the call that moves joints to `goal` in `seconds`, or in the time that the slowest joint needs."""
        way = {joint: angle - here[joint] for joint, angle in goal.items()}
        times = [[way_duration(way, self._body, seconds)]] * len(goal)
        return self._post("ALMotion", "angleInterpolation", list(goal), [[a] for a in goal.values()], times, True)

    def _inside(self, motion: MotionDefinition, here: Mapping[str, float]) -> dict[str, float]:
        """Return each joint's present angle [rad], limited to its range; joints that share a motor have its angle."""
        found = {}
        for joint in motion.tracks:
            limit = self._body.joints[joint]
            found[joint] = min(max(float(here[self._body.shared.get(joint, joint)]), limit.minimum), limit.maximum)
        return found

    def _driven(self, tracks: Sequence[JointTrack]) -> list[JointTrack]:
        """Return the tracks under their motors' names; of two tracks for a motor, use that of its own joint."""
        shared, moved = self._body.shared, {track.joint for track in tracks}
        return [t._replace(joint=shared.get(t.joint, t.joint)) for t in tracks if shared.get(t.joint) not in moved]
