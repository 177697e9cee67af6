"""A toy bear: it says texts and performs nothing else."""

from collections.abc import Sequence

from lumen.language.commands import Say
from lumen.language.events import Event
from lumen.language.stories import Visitor
from lumen.ports import Reading, RobotCommand, Sense
from lumen.run.setup import RobotRequest, Setup, set_up_with
from lumen.run.voices import RobotVoice
from lumen_stranger.honey import Honey

TIME_TO_SAY = 0.5
"""[s]."""


class Teddy:
    """A bear with a voice; it is its own hall."""

    def __init__(self, voice: str) -> None:
        self.said: list[str] = []
        self._voice = voice
        self._time = 0.0
        self._playback: RobotVoice | None = None
        self._ends: dict[str, float] = {}
        self._answers: list[Event] = []
        self._visitor: Visitor | None = None

    def advance(self, dt: float) -> None:
        self._time += dt
        for id in [id for id, end in self._ends.items() if end <= self._time]:
            del self._ends[id]
            self._answers.append(Event(f"done.command.{id}", None, self._time))

    def start(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Say):
            self.said.append(f"{self._voice}: {command.text}")
        if isinstance(command, Say) and self._playback:
            self._ends[id] = self._time + self._playback.begin(command.text, command.language, 1.0, self._time)
        else:
            self._ends[id] = self._time + TIME_TO_SAY

    def speak_with(self, voice: RobotVoice) -> None:
        self._playback = voice

    def cancel(self, id: str) -> None:
        if self._ends.pop(id, None) is not None:
            self._answers.append(Event(f"cancelled.command.{id}", None, self._time))

    def poll(self) -> Sequence[Event]:
        answers, self._answers = self._answers, []
        return answers

    def begun(self) -> Sequence[str]:
        return ()

    def read(self, sense: Sense) -> Reading | None:
        return None

    def read_other(self, sense: str) -> Honey | None:
        return Honey(self._time, max(0, 3 - len(self.said))) if sense == "honey" else None

    def close(self) -> None:
        pass

    def place(self, visitor: Visitor | None) -> None:
        self._visitor = visitor

    def face(self) -> tuple[float, float] | None:
        return (160.0, 120.0) if self._visitor else None

    def touch(self, sensor: str, pressed: bool) -> None:
        pass

    def sound(self) -> None:
        pass

    def plug(self, plugged: bool) -> None:
        pass


def set_up(request: RobotRequest) -> Setup:
    """Return a bear in simulated time."""
    return set_up_with(Teddy(request.options.get("voice", "deep")), pace=request.pace)
