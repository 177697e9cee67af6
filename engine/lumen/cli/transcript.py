"""A run as it reads on a terminal: when, who, what, and why."""

import sys
from collections.abc import Callable
from typing import TextIO

from lumen.cli.terminal import coloured, paint
from lumen.interpreters.statechart import Step
from lumen.language.commands import (
    Command,
    Language,
    Log,
    Look,
    Play,
    Posture,
    Publish,
    Rest,
    Say,
    Start,
    Stop,
    Track,
    Wake,
    Walk,
)
from lumen.language.events import Event
from lumen.language.stories import Arrive, Deed, Happen, Leave, Send, Speak, Touch

WHO = {"visitor": "yellow", "robot": "cyan", "state": "green", "reload": "magenta", "trouble": "red"}


class Transcript:
    """Prints what happens, a line each, with simulated time; counts it for the summary."""

    def __init__(self, now: Callable[[], float], stream: TextIO | None = None) -> None:
        self._now = now
        self._stream = stream or sys.stdout
        self._colour = coloured(self._stream)
        self._running: dict[str, str] = {}
        self.states: list[str] = []
        self.said = 0
        self.played: list[str] = []
        self.errors = 0

    def line(self, who: str, text: str) -> None:
        """One line: the time, who it is about, and what."""
        minutes, seconds = divmod(self._now(), 60)
        time = paint(f"{int(minutes):2d}:{seconds:04.1f}", "dim", on=self._colour)
        print(
            f"{time}  {paint(f'{who:<8}', WHO.get(who, 'dim'), on=self._colour)} {text}", file=self._stream, flush=True
        )

    def observe(self, step: Step) -> None:
        """A step: the states it entered, and the event that made it."""
        for error in step.raised:
            if error.name.startswith("error."):
                self.errors += 1
                self.line("trouble", f"{error.name}: {error.data.get('reason', '')}")
        entered = [name for name in step.entered if name]
        if entered:
            self.states += entered
            names = " ".join(paint(name, "bold", on=self._colour) for name in entered)
            self.line("state", f"{names}  {paint(_why(step), 'dim', on=self._colour)}")

    def performing(self, command: Command, now: float) -> None:
        """A command is handed to the robot or the bus."""
        match command:
            case Start(id, Say(text)):
                self.said += 1
                self.line("robot", f"“{text}”")
            case Start(id, body_command):
                if words := _words(body_command):
                    self._running[id] = words
                    self.line("robot", words)
            case Publish(route):
                self.line("robot", f"publishes on {route}")
            case Log(text):
                self.line("log", text)

    def answered(self, event: Event) -> None:
        """The robot answered, or noticed something."""
        kind, _, id = event.name.partition(".command.")
        running = self._running.pop(id, "")
        if kind == "error":
            self.errors += 1
            self.line("trouble", f"could not {_base(running) or 'do that'}: {event.data['reason']}")
        elif kind == "done" and running.startswith("plays "):
            self.played.append(running.removeprefix("plays "))
        elif kind == "cancelled" and running:
            self.line("robot", f"ends early: {running}")
        elif not id:
            details = ", ".join(f"{k} {v}" for k, v in (event.data or {}).items())
            self.line("robot", f"notices {event.name}" + (f": {details}" if details else ""))

    def deed(self, deed: Deed) -> None:
        """The visitor does something."""
        match deed:
            case Arrive():
                self.line("visitor", "walks up")
            case Leave():
                self.line("visitor", "walks away")
            case Speak(text):
                self.line("visitor", f"“{text}”")
            case Touch(sensor, pressed):
                self.line("visitor", f"{'presses' if pressed else 'lets go of'} {sensor}")
            case Happen(name):
                self.line("story", f"lets `{name}` happen")
            case Send(route):
                self.line("story", f"a module sends `{route}`")


def _why(step: Step) -> str:
    event = step.event
    if event is None:
        return "at the start"
    text = event.data.get("result") if isinstance(event.data, dict) else None
    if event.name.startswith("after."):
        return "because time was up"
    if event.name.startswith(("done.", "error.")):
        return f"because {event.name}"
    return f"because `{event.name}`" + (f" “{text}”" if text else "")


def _words(command: object) -> str:
    match command:
        case Play(motion):
            return f"plays {motion}"
        case Posture(name):
            return f"takes the posture {name}"
        case Walk(x, y, theta):
            return f"walks {x:g} m, {y:g} m, {theta:.2f} rad"
        case Look():
            return "turns its head"
        case Track(controller, on):
            return f"{'follows the face with' if on else 'lets go of'} {controller}"
        case Stop(what):
            return f"stops {what}"
        case Rest():
            return "rests"
        case Wake():
            return "wakes"
        case Language(language):
            return f"speaks {language} from now on"
    return ""


def _base(words: str) -> str:
    verb, _, rest = words.partition(" ")
    return f"{verb.removesuffix('s')} {rest}".strip()
