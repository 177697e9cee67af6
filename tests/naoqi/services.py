"""The services of a NAOqi, as documented: blocking calls, many threads, wrong names raise, buffers are buffers."""

from itertools import pairwise
from math import cos, hypot, sin
from typing import Any

import qi

from lumen.robots.naoqi.hardware import CHARGE, CHARGING, INERTIAL, PLUGGED, device, hardware_of
from tests.naoqi.joints import Joints, bezier
from tests.naoqi.times import Blocked, Times

FAMILIES = {
    "Stand": "Standing", "Crouch": "Crouching", "Sit": "Sitting", "LyingBack": "LyingBack", "LyingBelly": "LyingBelly",
}  # fmt: skip


class World:
    """What the services share: time, joints, what was called, and what a test may break."""

    def __init__(self, body: Any) -> None:
        self.times = Times()
        self.joints = Joints(body, self.times)
        self.body, self.hardware = body, hardware_of(body)
        self.asked: set[str] = set()
        self.calls: list[tuple[float, str, tuple[Any, ...]]] = []
        self.awake, self.family, self.stiffness = True, "Standing", 1.0
        self.position = [0.0, 0.0, 0.0]
        self.obstacle = self.deaf = self.astray = False
        self.version = "2.8.6.23"
        self.pressed: set[str] = set()
        self.sonar = (2.55, 2.55)
        self.charge, self.plugged, self.charging = 1.0, False, False
        self.temperatures: dict[str, float] = {}
        self.size = (320, 240)
        self.voices = ["English", "French"]
        self.sounds: set[str] = set()
        self.life = "solitary"
        self.sound = bytes(range(256)) * 400
        self.listens = True
        self.lacks: set[str] = set()
        self.silent: set[str] = set()

    def note(self, method: str, *arguments: Any) -> None:
        self.calls.append((self.times.now, method, arguments))

    def called(self, method: str) -> list[tuple[Any, ...]]:
        """The arguments of each call of that method."""
        return [arguments for _, name, arguments in self.calls if name == method]


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


class Event:
    def __init__(self) -> None:
        self.signal = qi.Signal("(m)")


@qi.multiThreaded()
class ALMemory:
    def __init__(self, world: World) -> None:
        self._world = world
        self.events: dict[str, Event] = {}

    def subscriber(self, name: str) -> Event:
        return self.events.setdefault(name, Event())

    def getListData(self, keys: list[str]) -> list[Any]:
        if self._world.silent & set(keys):
            raise RuntimeError("ALMemory::getListData\n\tno such key")
        self._world.asked |= set(keys)
        return [self._value(key) for key in keys]

    def raised(self, name: str, value: Any) -> bool:
        """Tell who listens; whether anybody could."""
        if name in self.events:
            self.events[name].signal(value)
        return name in self.events

    def _value(self, key: str) -> Any:
        world, hardware = self._world, self._world.hardware
        known: dict[str, Any] = {
            **{device(name): heard for name, heard in zip(hardware.sonars, world.sonar, strict=True)},
            CHARGE: world.charge,
            PLUGGED: world.plugged,
            CHARGING: world.charging,
            **{device(f"{joint}/Temperature"): world.temperatures.get(joint, 40.0) for joint in world.body.joints},
            **{device(f"{hardware.inertial}/{name}"): 9.81 if name == "AccelerometerZ" else 0.0 for name in INERTIAL},
            **{device(name): 2.7 if name.endswith("TotalWeight") else 0.675 for name in hardware.force},
            **{device(d): float(name in world.pressed) for name, devices in hardware.touch.items() for d in devices},
        }
        return known.get(key) if key not in world.lacks else None


@qi.multiThreaded()
class ALTextToSpeech:
    def __init__(self, world: World) -> None:
        self._world = world
        self._saying: Blocked | None = None

    def setLanguage(self, language: str) -> None:
        self._world.note("setLanguage", language)

    def setVolume(self, volume: float) -> None:
        self._world.note("setVolume", volume)

    def getAvailableLanguages(self) -> list[str]:
        return self._world.voices

    def say(self, text: str) -> Any:
        return self._say(text, "")

    @qi.bind(methodName="say", paramsType=(qi.String, qi.String), returnType=qi.Dynamic)
    def say_in(self, text: str, language: str) -> Any:
        if language not in self._world.voices:
            raise RuntimeError(f"ALTextToSpeech::say\n\tThe language {language} is not installed")
        return self._say(text, language)

    def stopAll(self) -> None:
        self._world.note("ALTextToSpeech.stopAll")
        if self._saying:
            self._saying.end()

    def _say(self, text: str, language: str) -> Any:
        self._world.note("say", text, language)
        self._saying = self._world.times.block(0.4 + 0.06 * len(text))
        return self._saying.future


class _ImageType:
    def __str__(self) -> str:
        return "(iiiiiiriffff)"


@qi.multiThreaded()
class ALVideoDevice:
    def __init__(self, world: World) -> None:
        self._world = world
        self.handles: list[str] = ["lumen_7", "other_0"]
        self._resolution = 1

    def getSubscribers(self) -> list[str]:
        return self.handles

    def subscribeCamera(self, name: str, camera: int, resolution: int, space: int, fps: int) -> str:
        self._world.note("subscribeCamera", name, camera, resolution, space, fps)
        if resolution != self._resolution:
            self._resolution, self._world.size = resolution, (160 * 2**resolution, 120 * 2**resolution)
        self.handles.append(f"{name}_{len(self.handles)}")
        return self.handles[-1]

    def unsubscribe(self, handle: str) -> bool:
        self.handles = [h for h in self.handles if h != handle]
        return True

    @qi.bind(returnType=_ImageType())
    def getImageRemote(self, handle: str) -> Any:
        if handle not in self.handles:
            raise RuntimeError(f"ALVideoDevice::getImageRemote\n\t{handle} is not subscribed")
        width, height = self._world.size
        now = self._world.times.now + 1e6
        pixels = bytearray((0, 128, 255)) * (width * height)
        return (width, height, 3, 11, int(now), int(now % 1 * 1e6), pixels, 0, 0.5, 0.4, -0.5, -0.4)

    def releaseImage(self, handle: str) -> bool:
        return handle in self.handles


@qi.multiThreaded()
class ALSonar:
    def subscribe(self, name: str) -> None: ...

    def unsubscribe(self, name: str) -> None: ...


@qi.multiThreaded()
class ALLeds:
    def __init__(self, world: World) -> None:
        self._world = world

    def fadeRGB(self, group: str, colour: int, seconds: float) -> None:
        if group not in self._world.hardware.lights.values():
            raise RuntimeError(f"ALLeds::fadeRGB\n\t{group} is no group")
        self._world.note("fadeRGB", group, colour, seconds)


@qi.multiThreaded()
class ALAudioPlayer:
    def __init__(self, world: World) -> None:
        self._world = world
        self._playing: Blocked | None = None

    def playFile(self, file: str) -> Any:
        self._world.note("playFile", file)
        if file not in self._world.sounds:
            raise RuntimeError(f"ALAudioPlayer::playFile\n\tCan't open file {file}")
        self._playing = self._world.times.block(5.0)
        return self._playing.future

    def stopAll(self) -> None:
        self._world.note("ALAudioPlayer.stopAll")
        if self._playing:
            self._playing.end()


@qi.multiThreaded()
class ALAudioDevice:
    """Hands each subscriber's service what the microphones hear, 170 ms at a time; `session` finds it."""

    BLOCK, SECONDS = 2 * 2720, 0.17

    def __init__(self, world: World, session: Any) -> None:
        self._world, self._session = world, session
        self._preferences: dict[str, tuple[int, int, int]] = {}
        self.subscribers: dict[str, Any] = {}

    def setClientPreferences(self, name: str, rate: int, channels: int, deinterleaved: int) -> None:
        self._world.note("setClientPreferences", name, rate, channels, deinterleaved)
        if (rate, channels) not in ((48_000, 0), *((16_000, one) for one in (1, 2, 3, 4))):
            raise RuntimeError(f"ALAudioDevice::setClientPreferences\n\tno {channels} at {rate} Hz")
        self._preferences[name] = (rate, channels, deinterleaved)

    def subscribe(self, name: str) -> None:
        self._world.note("ALAudioDevice.subscribe", name)
        listener = self.subscribers[name] = self._session.service(name)
        self._feed(listener, name, 0)

    def unsubscribe(self, name: str) -> None:
        self._world.note("ALAudioDevice.unsubscribe", name)
        self.subscribers.pop(name, None)

    def _feed(self, listener: Any, name: str, begin: int) -> None:
        def feed() -> None:
            if self.subscribers.get(name) is listener:
                part = self._world.sound[begin : begin + self.BLOCK].ljust(self.BLOCK, b"\0")
                if not self._world.listens or self._heard(listener, part):
                    self._feed(listener, name, begin + self.BLOCK)

        self._world.times.at(self._world.times.now + self.SECONDS, feed)

    def _heard(self, listener: Any, part: bytes) -> bool:
        """Whether the listener is still there."""
        try:
            listener.processRemote(1, len(part) // 2, [0, 0], part)
        except RuntimeError:
            return False
        return True


@qi.multiThreaded()
class ALAutonomousLife:
    def __init__(self, world: World) -> None:
        self._world = world

    def getState(self) -> str:
        return self._world.life

    def setState(self, state: str) -> None:
        self._world.note("setState", state)
        self._world.life = state


@qi.multiThreaded()
class ALAnimatedSpeech:
    def __init__(self, world: World) -> None:
        self._world = world

    def say(self, text: str, configuration: dict[str, str]) -> Any:
        self._world.note("ALAnimatedSpeech.say", text, configuration)
        return self._world.times.block(0.4 + 0.06 * len(text)).future


@qi.multiThreaded()
class ALAutonomousBlinking:
    def __init__(self, world: World) -> None:
        self._world = world

    def setEnabled(self, enabled: bool) -> None:
        self._world.note("ALAutonomousBlinking.setEnabled", enabled)


@qi.multiThreaded()
class ALSoundLocalization:
    def __init__(self, world: World) -> None:
        self._world = world

    def subscribe(self, name: str) -> None:
        self._world.note("ALSoundLocalization.subscribe", name)


@qi.multiThreaded()
class ALSystem:
    def __init__(self, world: World) -> None:
        self._world = world

    def systemVersion(self) -> str:
        return self._world.version


SERVICES = (
    ALMotion, ALRobotPosture, ALMemory, ALTextToSpeech, ALVideoDevice, ALLeds, ALAudioPlayer, ALAutonomousLife,
    ALAnimatedSpeech, ALAutonomousBlinking, ALSoundLocalization, ALSystem,
)  # fmt: skip
