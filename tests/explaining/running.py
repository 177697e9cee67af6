"""Runs random machines with events at given times, timers, and a robot that answers."""

from contextlib import suppress
from typing import Any, NamedTuple

from hypothesis import strategies as st

from lumen.errors import LumenError
from lumen.insight.explaining import RecordedStep
from lumen.language.commands import Log, Play, Start
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.language.nanoseconds import to_the_nanosecond
from lumen.statechart import due, initial, step
from tests.statechart.oracle.generating import EVENTS

ANSWERED_AFTER = 0.17
"""The time that the robot needs for each command [s]."""

inputs: st.SearchStrategy[list[tuple[str, Any]]] = st.lists(
    st.tuples(st.sampled_from(EVENTS), st.sampled_from([None, {"k": 1}, {"k": 3}, {"k": "text"}])),
    min_size=2,
    max_size=10,
)


def timed(happenings: list[tuple[str, Any]]) -> list[Event]:
    """Return an event for each happening, at times 61 or 413 ms apart."""
    at, events = 0.0, []
    for number, (name, data) in enumerate(happenings):
        at = to_the_nanosecond(at + (0.061 if number % 3 else 0.413))
        events.append(Event(name, data, at))
    return events


def live(machine: MachineDefinition, events: list[Event], end: float) -> list[RecordedStep]:
    """Return the steps until `end` [s], or until the machine fails to come to rest."""
    steps, answers, left = list[RecordedStep](), list[Event](), list(events)
    with suppress(LumenError):
        steps.append(RecordedStep(machine, None, initial(machine)))
        while len(steps) < 60:
            snapshot = steps[-1].step.snapshot
            answers += _answers(steps[-1])
            coming = [event for event in (due(snapshot), *answers[:1], *left[:1]) if event]
            if not coming or (event := min(coming, key=lambda e: e.at)).at > end:
                break
            answers, left = [a for a in answers if a is not event], [e for e in left if e is not event]
            steps.append(RecordedStep(machine, snapshot, step(machine, snapshot, event)))
    return steps


def _answers(one: RecordedStep) -> list[Event]:
    at = to_the_nanosecond(one.at + ANSWERED_AFTER)
    return [
        Event(f"{'error' if isinstance(c.command, Play) else 'done'}.command.{c.id}", None, at)
        for c in one.step.commands
        if isinstance(c, Start) and c.id.startswith("d")
    ]


class Outcome(NamedTuple):
    """A state that was entered, or an action that was done, at a time."""

    at: float
    what: str


def outcomes(one: RecordedStep) -> list[Outcome]:
    """Return the states entered and the commands of a step; for drawn commands only the kind counts."""
    done = [_kind(command) for command in one.step.commands]
    return [Outcome(one.at, what) for what in (*one.step.entered, *filter(None, done))]


def _kind(command: Any) -> str:
    match command:
        case Start(_, wanted):
            return type(wanted).__name__
        case Log(text):
            return f"logs {text.rpartition(' in ')[2]}"
    return ""
