"""Describes the parts of steps in words."""

import json
from collections.abc import Mapping
from typing import Any

from lumen.language.commands import Ask, BodyCommand, Cancel, Command, Log, Publish, Say, Start, Tell
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, Transition
from lumen.language.verbs import verb_of

MAX_VALUE_CHARACTERS = 80
"""The maximum number of characters of a value that are shown; a longer value is cut."""


def prefix_of(owner: str) -> str:
    """Return the prefix of the names of a behaviour's states: `quiz/hint/` for `hint@quiz`."""
    return "".join(f"{id}/" for id in reversed(owner.split("@"))) if owner else ""


def of_command(command: Command) -> str:
    """Return a command in words: `says “Hello!”`, `plays dance`, `publishes on `show``."""
    match command:
        case Start(_, wanted):
            return of_deed(wanted)
        case Publish(route):
            return f"publishes on `{route}`"
        case Tell(robot, event):
            return f"tells {robot} `{event}`"
        case Log(text):
            return f"logs “{text}”"
        case Cancel(id):
            return f"cancels {id}"


def of_deed(command: BodyCommand) -> str:
    """Return a command to the robot in words: `says “Hello!”`, `plays dance`, `asks “how tall are you”`."""
    match command:
        case Say(text):
            return f"says “{text}”"
        case Ask(question):
            return f"asks “{question}”"
        case _:
            return verb_of(command).transcript(command)


def of_transition(machine: MachineDefinition, transition: Transition, owner: str = "") -> str:
    """Return a transition in words: `ask_name → how_are_you, on heard, as GUARD`."""
    prefix = prefix_of(owner)
    source = prefix + (machine.states[transition.source].name or machine.id)
    targets = ", ".join(prefix + (machine.states[path].name or machine.id) for path in transition.targets)
    guard = f", as {transition.guard.shown}" if transition.guard else ""
    return f"{source} → {targets or '(stays)'}, {awaited(transition)}{guard}"


def awaited(transition: Transition) -> str:
    """Return the event, time or phrase that a transition waits for, in words."""
    if transition.hears:
        return transition.hears.title
    if transition.timed:
        return transition.awaited_time
    if transition.exact:
        return "when it is done" if transition.event.startswith("done.") else "when it fails"
    return f"on {transition.event}" if transition.event else "as soon as possible"


def of_event(event: Event) -> str:
    """Return an event in words: `heard {"result": "my name is Budi"}`."""
    return event.name if event.data is None else f"{event.name} {shown(event.data)}"


def shown(value: Any) -> str:
    """Return a value as JSON, cut to `MAX_VALUE_CHARACTERS`."""
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= MAX_VALUE_CHARACTERS else f"{text[: MAX_VALUE_CHARACTERS - 1]}…"


def brought(event: Event) -> dict[str, Any]:
    """Return an event's data by their names in expressions; empty without data."""
    if isinstance(event.data, Mapping):
        return {f"event.data.{key}": value for key, value in event.data.items()}
    return {} if event.data is None else {"event.data": event.data}


def ordinal(number: int) -> str:
    """Return an ordinal number: `1st`, `2nd`, `11th`."""
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"
