"""The transcript of an exhibition: who does what, and why, in words."""

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from lumen.language.commands import Ask, BodyCommand, Command, Log, Publish, Say, Start, Tell
from lumen.language.counts import counted
from lumen.language.events import CUE, HELD, RECORDED, Event
from lumen.language.machines import MachineDefinition
from lumen.language.stories import (
    AnswerQuestion,
    Approve,
    Arrive,
    Happen,
    Leave,
    Press,
    SendMessage,
    SetAutonomy,
    SetSkills,
    Speak,
    TouchSensor,
    VisitorAction,
)
from lumen.language.verbs import verb_of
from lumen.run.entry_causes import innermost, reason_of, why
from lumen.run.ignoring import IgnoredEvents
from lumen.run.loop import Observer
from lumen.run.performer import LEFT_OUT
from lumen.run.troubles import RunTrouble, wanted
from lumen.statechart import Step, finished
from lumen.statechart.nesting import flattened_steps

MAX_TROUBLES = 100
"""The number of troubles of a run that are kept for its end; later ones are dropped."""


class VisitorWatcher(Protocol):
    """An observer of the visitor."""

    def visitor_action(self, action: VisitorAction) -> None:
        """Called when the visitor acts."""
        ...


class Narrator(Observer):
    """An observer that counts the events of a run, and describes them line by line.

    Subclasses that show the lines override `line` and `note`. `now` returns the time [s], `machine` the running
    machine.
    """

    explains = False
    """Whether the narrator also reports events that changed nothing, and why."""

    def __init__(self, now: Callable[[], float], machine: Callable[[], MachineDefinition]) -> None:
        self._now, self._machine = now, machine
        self._running: dict[str, str] = {}
        self.states: set[str] = set()
        self.said = 0
        """The number of texts said."""
        self.played: dict[str, int] = {}
        """The number of finished performances of each motion."""
        self._ignored = IgnoredEvents()
        self.troubles: list[str] = []
        self.watchers: list[VisitorWatcher] = []
        """Notified of each action of the visitor."""

    def line(self, who: str, text: str) -> None:
        """Show a line about `who`, at the present time."""

    def note(self, text: str) -> None:
        """Show a text about the run itself, without a time."""

    def counted(self) -> str:
        """Return a summary of the states, texts and motions so far."""
        counts = f"{counted(len(self.states), 'state')}, {counted(self.said, 'text')}"
        return f"{counts}, motions: {', '.join(self.played) or 'none'}"

    def stepped(self, step: Step) -> None:
        for prefix, machine, part in flattened_steps(self._machine(), step):
            for error in part.raised:
                if error.name.startswith("error.") and not wanted(reason_of(error)):
                    self.line("trouble", f"{error.name}: {reason_of(error)}".rstrip(": "))
            entered = [prefix + name for name in innermost(machine, part.entered)]
            if entered:
                self.states.update(entered)
                self.line("state", f"{', '.join(entered)}  ({why(part)})")
        if step.entered and finished(self._machine(), step.snapshot):
            output = step.snapshot.output
            self.line("state", "the behaviour is over" + ("" if output is None else f", with the output {output}"))
        if self.explains and (ignored := self._ignored.line(self._machine(), step)):
            self.line("ignored", ignored)

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Start(id, wanted):
                self._started(id, wanted)
            case Publish(route):
                self.line("robot", f"publishes on {route}")
            case Tell(robot, event):
                self.line("robot", f"tells {robot} `{event}`")
            case Log(text):
                self.line("log", text)

    def _started(self, id: str, command: BodyCommand) -> None:
        if isinstance(command, Say):
            self.said += 1
            self.line("robot", f"“{command.text}”")
            return
        if isinstance(command, Ask):
            self.line("robot", f"asks “{command.question}”")
            return
        verb = verb_of(command)
        words = verb.transcript(command)
        self.line("robot", words)
        if not verb.instant:
            self._running[id] = words

    def refused(self, command: Start, reason: str) -> None:
        wanted = command.command
        if not isinstance(wanted, Say | Ask):  # speech is never refused
            self.line("refused", f"{_base(verb_of(wanted).transcript(wanted))}: {reason}")

    def answered(self, event: Event) -> None:
        kind, _, id = event.name.partition(".command.")
        running = self._running.pop(id, "")
        if kind == "error" and running and reason_of(event).endswith(HELD):
            self.line("refused", f"{_base(running)}: {reason_of(event)}")
        elif kind == "error":
            self.line("trouble", f"could not {_base(running) or 'do that'}: {reason_of(event)}")
        elif kind == "done" and event.data and LEFT_OUT in event.data:
            self.line("robot", f"leaves this action out: {event.data[LEFT_OUT]}")
        elif kind == "done" and running.startswith("plays "):
            motion = running.removeprefix("plays ")
            self.played[motion] = self.played.get(motion, 0) + 1
        elif kind == "cancelled" and running:
            self.line("robot", f"ends early: {running}")
        elif event.name == CUE:
            return  # its commands are reported when they are performed
        elif event.name == RECORDED:
            self.line("robot", "has recorded what it heard")
        elif not id:
            details = ", ".join(f"{k} {v}" for k, v in (event.data or {}).items())
            self.line("robot", f"notices {event.name}" + (f": {details}" if details else ""))

    def troubled(self, trouble: RunTrouble) -> None:
        """Keep a trouble for the end of the run.

        Only a missed joint goal needs a line here, because other troubles already had one.
        """
        if trouble.kind == "joint":
            self.line("trouble", trouble.what)
        if len(self.troubles) < MAX_TROUBLES:
            self.troubles.append(trouble.what)

    def visitor_action(self, action: VisitorAction) -> None:
        """Notify the watchers of a visitor's action, and show its line."""
        for watcher in self.watchers:
            watcher.visitor_action(action)
        match action:
            case Arrive():
                self.line("visitor", "walks up")
            case Leave():
                self.line("visitor", "walks away")
            case Speak(text):
                self.line("visitor", f"“{text}”")
            case TouchSensor(sensor, pressed):
                self.line("visitor", f"{'presses' if pressed else 'lets go of'} {sensor}")
            case Happen(name):
                self.line("story", f"lets `{name}` happen")
            case Approve(go):
                self.line("operator", "says GO" if go else "lets it stay")
            case SetAutonomy(level):
                self.line("operator", f"sets autonomy: {level}")
            case Press(label):
                self.line("operator", f"presses “{label}”")
            case SendMessage(route):
                self.line("story", f"a module sends `{route}`")
            case SetSkills(ends):
                self.line("story", "; ".join(_skill_end(name, end) for name, end in ends.items()))
            case AnswerQuestion(text, event):
                self.line(
                    "story", f"the module `answers` says “{text}”" if text else f"the module `answers` raises `{event}`"
                )


def _skill_end(name: str, end: Mapping[str, Any] | str) -> str:
    said = end if isinstance(end, str) else f"returns {', '.join(f'{key} {value}' for key, value in end.items())}"
    return f"`{name}` {said} from now on"


def _base(words: str) -> str:
    verb, _, rest = words.partition(" ")
    return f"{verb.removesuffix('es' if verb.endswith('oes') else 's')} {rest}".strip()
