"""The robot's microphones, whose sound NAOqi sends to Lumen's service until the recording is complete."""

from collections.abc import Callable
from typing import Any

from lumen.errors import RobotFailedError, SenseError
from lumen.features.naoqi.call_sequence import CallSequence, CallSteps
from lumen.features.naoqi.session import NaoqiCall, NaoqiSession
from lumen.language.events import RECORDED, Event
from lumen.ports import Record
from lumen.robot.cues import EventSink
from lumen.robot.sense_codec import RECORDING_RATE, recording_body

AUDIO_DEVICE, MICROPHONE_SERVICE = "ALAudioDevice", "LumenMicrophones"
FRONT_MICROPHONE, INTERLEAVED = 3, 0
"""NAOqi's numbers for the front microphone and interleaved samples.

At 16 kHz, ALAudioDevice records only a single microphone; it records all four only at 48 kHz.
"""
RECORDING_GRACE = 3.0
"""The time after the recording's duration within which its sound must arrive [s]."""


class Microphones:
    """Records from ALAudioDevice, one recording at a time; `notice` receives an event for each complete recording."""

    def __init__(self, session: NaoqiSession, notice: EventSink, clock: Callable[[], float]) -> None:
        self._session, self._notice, self._clock = session, notice, clock
        self._heard, self._wanted = bytearray(), 0

    def begin(self, command: Record) -> CallSequence:
        """Return the activity of a recording. Raises SenseError if the robot has no ALAudioDevice."""
        if not self._session.has(AUDIO_DEVICE):
            raise SenseError(f"this robot has no {AUDIO_DEVICE}")
        return CallSequence(self._listen(command), self._hush)

    def _listen(self, command: Record) -> CallSteps:
        """Record for the command's duration, and give `notice` the event of the recording.

        NAOqi calls `processRemote` of Lumen's service with sound about six times a second; sound from before the
        recording is discarded. Raises RobotFailedError if sound is missing RECORDING_GRACE after the duration.
        """
        yield self._session.serve(MICROPHONE_SERVICE, self._service)
        yield self._session.post(
            AUDIO_DEVICE, "setClientPreferences", MICROPHONE_SERVICE, RECORDING_RATE, FRONT_MICROPHONE, INTERLEAVED
        )
        self._heard, self._wanted = bytearray(), 2 * round(command.duration * RECORDING_RATE)
        yield self._session.post(AUDIO_DEVICE, "subscribe", MICROPHONE_SERVICE)
        until = self._clock() + command.duration + RECORDING_GRACE
        while len(self._heard) < self._wanted:
            if self._clock() > until:
                self._hush()
                raise RobotFailedError(
                    f"{len(self._heard) / (2 * RECORDING_RATE):.1f} of {command.duration:g} s came from the "
                    "microphones: check that the robot can reach this machine and that no firewall is in between"
                )
            yield None
        yield from self._hush()
        self._notice(Event(RECORDED, recording_body(command.name, bytes(self._heard[: self._wanted])), self._clock()))

    def _hush(self) -> list[NaoqiCall]:
        return [self._session.post(AUDIO_DEVICE, "unsubscribe", MICROPHONE_SERVICE)]

    def _service(self, qi: Any) -> object:
        """Return the service that NAOqi calls on qi's thread, one call at a time."""
        microphones = self

        class Listener:
            @qi.bind(paramsType=(qi.Int32, qi.Int32, qi.Dynamic, _Raw()), returnType=qi.Void)  # type: ignore[untyped-decorator]
            def processRemote(self, channels: int, samples: int, stamp: Any, buffer: Any) -> None:  # noqa: N802
                microphones.hear(bytes(buffer))

        return Listener()

    def hear(self, samples: bytes) -> None:
        """Add 16-bit little-endian samples while the recording is incomplete."""
        if len(self._heard) < self._wanted:
            self._heard += samples


class _Raw:
    """qi's signature for bytes; without it, bytes arrive as text."""

    def __str__(self) -> str:
        return "r"
