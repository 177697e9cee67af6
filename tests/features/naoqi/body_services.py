"""The services of a NAOqi that move its body, as documented: joints, walks, postures."""

from itertools import pairwise
from math import cos, hypot, sin
from typing import Any

from tests.features.naoqi.joints import bezier
from tests.features.naoqi.library import qi
from tests.features.naoqi.times import Blocked
from tests.features.naoqi.world import World

FAMILIES = {
    "Stand": "Standing", "Crouch": "Crouching", "Sit": "Sitting", "LyingBack": "LyingBack", "LyingBelly": "LyingBelly",
}  # fmt: skip


@qi.multiThreaded()
class ALMotion:
    def __init__(self, world: World) -> None:
        self._world, self._joints, self._times = world, world.joints, world.times
        self._walk: Blocked | None = None
        self._velocity = (0.0, 0.0, 0.0)
        self._since = 0.0

    def getBodyNames(self, name: str) -> list[str]:
        wheels = ["WheelFL", "WheelFR", "WheelB"] if self._world.body.roles.base.kind == "wheels" else []
        return [*self._world.body.joints, *wheels]

    def getAngles(self, names: Any, sensors: bool) -> list[float]:
        with self._times.lock:
            listed = self._joints.known(names, "getAngles")
            angles = self._joints.angles()
            return [angles[name] for name in listed]

    def setBreathEnabled(self, chain: str, enabled: bool) -> None:
        legs = ("Legs",) if self._world.body.roles.legs else ()
        if chain not in ("Body", *legs, "Arms", "LArm", "RArm", "Head"):
            raise RuntimeError(f"ALMotion::setBreathEnabled\n\t{chain} is no chain")
        self._world.note("setBreathEnabled", chain, enabled)

    def getStiffnesses(self, names: Any) -> list[float]:
        return [self._world.stiffness for _ in self._joints.known(names, "getStiffnesses")]

    def setStiffnesses(self, names: Any, value: float) -> None:
        self._world.note("setStiffnesses", names, value)
        self._world.stiffness, self._world.awake = value, value > 0

    def setAngles(self, names: Any, angles: Any, speed: float) -> None:
        with self._times.lock:
            self._world.note("setAngles", names, angles, speed)
            here, listed = self._joints.angles(), self._joints.known(names, "setAngles")
            for name, angle in zip(listed, angles, strict=True):
                joint = self._world.body.joints[name]
                goal = min(max(angle, joint.minimum), joint.maximum)
                seconds = abs(goal - here[name]) / (speed * joint.speed)
                self._joints.move({name: goal}, seconds, blocking=False)

    def angleInterpolation(self, names: Any, angles: Any, times: Any, absolute: bool) -> Any:
        with self._times.lock:
            self._world.note("angleInterpolation", names, angles, times)
            listed = self._joints.known(names, "angleInterpolation")
            goal = {name: way[-1] for name, way in zip(listed, angles, strict=True)}
            return self._joints.move(goal, max(way[-1] for way in times))

    def angleInterpolationBezier(self, names: Any, times: Any, controls: Any) -> Any:
        with self._times.lock:
            self._world.note("angleInterpolationBezier", names, times, controls)
            listed, here = self._joints.known(names, "angleInterpolationBezier"), self._joints.angles()
            for name, when in zip(listed, times, strict=True):
                if not when or when[0] <= 0 or any(b <= a for a, b in pairwise(when)):
                    raise RuntimeError(f"ALMotion::angleInterpolationBezier\n\tTimes of {name} do not increase")
            ways = {n: bezier(here[n], t, c) for n, t, c in zip(listed, times, controls, strict=True)}
            longest = max(when[-1] for when in times)
            return self._joints.follow(listed, lambda t: {n: way(t) for n, way in ways.items()}, longest)

    def killTasksUsingResources(self, names: Any) -> None:
        with self._times.lock:
            self._world.note("killTasksUsingResources", names)
            self._joints.kill(self._joints.known(names, "killTasksUsingResources"))

    def moveTo(self, x: float, y: float, theta: float) -> Any:
        with self._times.lock:
            self._world.note("moveTo", x, y, theta)
            seconds = max(0.4, hypot(x, y) / 0.1 + abs(theta) / 0.25)
            part = 0.5 if self._world.obstacle else 1.0
            begin, start = self._times.now, list(self._world.position)

            def go(part: float) -> None:
                c, s = cos(start[2]), sin(start[2])
                went = x * c - y * s, x * s + y * c, theta
                self._world.position = [a + part * b for a, b in zip(start, went, strict=True)]

            def arrive() -> bool | None:
                go(part)
                self._walk = None
                return None if self._world.version.startswith("2.1") else not self._world.obstacle

            self._walk = self._times.block(seconds * part, arrive)
            self._walking = lambda: go(min(1.0, (self._times.now - begin) / seconds))
            return self._walk.future

    def move(self, x: float, y: float, theta: float) -> None:
        with self._times.lock:
            self._world.note("move", x, y, theta)
            self._live()
            self._velocity = (x, y, theta)

    def stopMove(self) -> Any:
        with self._times.lock:
            self._world.note("stopMove")
            if self._world.deaf:
                return self._times.block(1e6).future
            return self._times.block(0.4, self._stopped).future

    def _stopped(self) -> None:
        self._live()
        self._velocity = (0.0, 0.0, 0.0)
        walk, self._walk = self._walk, None
        if walk and not walk.over:
            self._walking()
            walk.end(False)

    def _live(self) -> None:
        dt, self._since = self._times.now - self._since, self._times.now
        self._world.position = [p + v * dt for p, v in zip(self._world.position, self._velocity, strict=True)]

    def getRobotPosition(self, sensors: bool) -> list[float]:
        if self._world.astray:
            raise RuntimeError("ALMotion::getRobotPosition\n\tno odometry")
        with self._times.lock:
            if self._walk and not self._walk.over:
                self._walking()
            self._live()
            return list(self._world.position)

    def robotIsWakeUp(self) -> bool:
        return self._world.awake

    def wakeUp(self) -> Any:
        self._world.note("wakeUp")
        self._world.awake, self._world.stiffness = True, 1.0
        return self._times.block(1.0).future

    def rest(self) -> Any:
        self._world.note("rest")

        def limp() -> None:
            self._world.awake, self._world.stiffness, self._world.family = False, 0.0, "Crouching"

        with self._times.lock:
            self._joints.move(self._world.body.postures["Crouch"], 2.0, blocking=False)
            return self._times.block(2.0, limp).future

    def setFallManagerEnabled(self, on: bool) -> None:
        self._world.note("setFallManagerEnabled", on)

    def setExternalCollisionProtectionEnabled(self, what: str, on: bool) -> None:
        self._world.note("setExternalCollisionProtectionEnabled", what, on)

    def setSmartStiffnessEnabled(self, on: bool) -> None:
        self._world.note("setSmartStiffnessEnabled", on)


@qi.multiThreaded()
class ALRobotPosture:
    def __init__(self, world: World) -> None:
        self._world, self._going = world, None

    def goToPosture(self, name: str, speed: float) -> Any:
        world = self._world
        world.note("goToPosture", name, speed)
        if name not in world.body.postures or not world.awake:
            return False
        with world.times.lock:
            world.joints.move(world.body.postures[name], 2.0, blocking=False)

            def arrive() -> bool:
                world.family = next((f for start, f in FAMILIES.items() if name.startswith(start)), "Standing")
                return True

            self._going: Any = world.times.block(2.0, arrive)
            return self._going.future

    def getPostureFamily(self) -> str:
        return self._world.family

    def stopMove(self) -> None:
        self._world.note("ALRobotPosture.stopMove")
        with self._world.times.lock:
            self._world.joints.kill(list(self._world.body.joints))
        if self._going:
            self._going.end(False)
