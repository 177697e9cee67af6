"""The services of a NAOqi, as documented: blocking calls, many threads, wrong names raise, buffers are buffers."""

from typing import Any

from lumen.features.naoqi.hardware import CHARGE, CHARGING, INERTIAL, PLUGGED, device
from tests.features.naoqi.body_services import ALMotion, ALRobotPosture
from tests.features.naoqi.library import qi
from tests.features.naoqi.times import Blocked
from tests.features.naoqi.world import World


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
        """Raise an event for its subscribers; return whether ALMemory knows it."""
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
        """Send a part of the sound; return whether the listener is still connected."""
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
