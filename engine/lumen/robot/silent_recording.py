"""Recordings of silence, for a simulated hall, in which visitors' words are typed."""

from lumen.language.events import RECORDED, Event
from lumen.ports import Record
from lumen.robot.cues import EventSink
from lumen.robot.sense_codec import RECORDING_RATE, recording_body


class SilentRecording:
    """Passes silence of the command's duration to `notice` at `until` [s]; if cancelled, passes nothing."""

    def __init__(self, command: Record, until: float, notice: EventSink) -> None:
        self._command, self._until, self._notice = command, until, notice
        self._cancelled = False

    def advance(self, now: float) -> bool:
        if self._cancelled or now < self._until:
            return self._cancelled
        silence = bytes(2 * round(self._command.duration * RECORDING_RATE))
        self._notice(Event(RECORDED, recording_body(self._command.name, silence), now))
        return True

    def cancel(self) -> None:
        self._cancelled = True
