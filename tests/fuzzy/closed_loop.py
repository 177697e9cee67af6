"""A head, a camera and a face, without physics: joints that move at limited speed, images that arrive late."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from math import copysign, inf, radians

from lumen.language.controllers import ControllerDefinition
from lumen.language.robots import Camera
from lumen.motion.projection import Vector3, centring, seen
from lumen.motion.tracking import Tracker
from tests.fuzzy.nao import HEAD, TOP

STEP = 1 / 300
"""The step of the joints' motion [s]."""

Pose = tuple[float, float]


@dataclass
class Run:
    """The head's yaw and pitch [rad] by time [s], and the face's position in each image [px]."""

    poses: list[tuple[float, float, float]]
    pixels: list[tuple[float, float] | None]

    def settled(self, axis: int, goal: float, within: float = radians(0.5)) -> float:
        """Return the time [s] after which the axis (0 yaw, 1 pitch) stays within `within` [rad] of the goal."""
        return next((pose[0] for pose in reversed(self.poses) if abs(pose[1 + axis] - goal) > within), 0.0)

    def stray(self, axis: int, since: float) -> float:
        """Return the range [rad] of the axis' positions from the time `since` [s] on."""
        late = [pose[1 + axis] for pose in self.poses if pose[0] >= since]
        return max(late) - min(late)

    def farthest(self, camera: Camera = TOP) -> float:
        """Return the face's greatest distance from the image's middle, as a part of half the image; inf if lost."""
        across, down = camera.width / 2, camera.height / 2
        return max(max(abs(p[0] / across - 1), abs(p[1] / down - 1)) if p else inf for p in self.pixels)

    def overshoot(self, axis: int, goal: float) -> float:
        """Return the axis' overshoot beyond the goal, as a part of the way to it."""
        way = self.poses[0][1 + axis] - goal
        return max(0.0, *(-(pose[1 + axis] - goal) * copysign(1.0, way) for pose in self.poses)) / abs(way)


def run(
    controller: ControllerDefinition,
    face: Callable[[float], Vector3],
    start: Pose,
    *,
    latency: float = 0.0,
    tick: float = 0.033,
    duration: float = 4.0,
    error: float = 0.0,
    sag: Pose = (0.0, 0.0),
) -> Run:
    """Let the controller follow a face (its place in the torso frame [m] by time) for `duration` [s].

    `error` [s] is added to the times at which images say they were taken; `sag` [rad] is the
    distance from their goals at which the joints come to rest, because of their weight.
    """
    tracker = Tracker(controller, HEAD)
    head, target = list(start), list(start)
    arriving: deque[tuple[float, tuple[float, float], float]] = deque()
    result, ticks = Run([], []), 0
    speeds = [HEAD.joints[joint].speed * controller.tracking.speed for joint in ("HeadYaw", "HeadPitch")]
    for now in (k * STEP for k in range(round(duration / STEP))):
        if now >= ticks * tick - 1e-9:
            ticks += 1
            tracker.pose(now, {"HeadYaw": head[0], "HeadPitch": head[1]})
            pixel = seen(face(now), TOP, head[0], head[1])
            result.pixels.append(pixel)
            if pixel:
                arriving.append((now + latency, pixel, now))
            while arriving and arriving[0][0] <= now + 1e-9:
                _, (u, v), captured_at = arriving.popleft()
                if aim := tracker.see({"x": round(u), "y": round(v)}, captured_at + error):
                    target = [aim["HeadYaw"], aim["HeadPitch"]]
        for i, speed in enumerate(speeds):
            head[i] += max(-speed * STEP, min(speed * STEP, target[i] + sag[i] - head[i]))
        result.poses.append((now, head[0], head[1]))
    return result


def off_by(face: Vector3, yaw: float, pitch: float) -> Pose:
    """Return the head's pose [rad] with this offset [deg] from the pose that centres the face."""
    goal = centring(face, TOP)
    return goal[0] + radians(yaw), goal[1] + radians(pitch)
