"""The subject of a question: the last time that something was said, played, done or entered."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.insight.explaining.history import StepHistory
from lumen.insight.explaining.names import KnownNames, same_text, state_named
from lumen.insight.explaining.words import of_command
from lumen.language.commands import Command, Publish, Say, Start, Tell
from lumen.statechart.nesting import entered_names


class Effect(NamedTuple):
    """Something that happened in a step: a command, or the entry of a state."""

    number: int
    """The number of the step."""
    what: str
    """The effect in words."""
    command: Command | None = None
    """The command; None if the effect is a state."""
    state: str = ""
    """The outside name of the state that was entered; empty if the effect is a command."""


def effect(history: StepHistory, what: str) -> Effect:
    """Return the last time that `what` happened; if `what` is empty, the last thing that happened.

    Raises UsageError, with a hint, if the history does not contain it.
    """
    if not history.steps:
        raise UsageError("the journal has no entries from that time: choose another time with `--at`")
    found = next(_effects(history, what), None)
    if found is None:
        raise UsageError(_unknown(history, what))
    return found


def _effects(history: StepHistory, what: str) -> Iterator[Effect]:
    """Yield the matching effects, newest first."""
    state = state_named(history.steps[-1].machine, what) if what else ""
    for number in reversed(range(len(history.steps))):
        step = history.steps[number].step
        if state and state in entered_names(step):
            yield Effect(number, f"in {state}", state=state)
        for command in reversed(step.commands):
            if is_meant(command, what):
                yield Effect(number, of_command(command), command)
        if not what and not step.commands and (entered := list(entered_names(step))):
            yield Effect(number, f"in {entered[-1]}", state=entered[-1])


def is_meant(command: Command, what: str) -> bool:
    """Return whether `what` means a command: by its id, by part of its text, or by a name in it. Empty means any."""
    match command:
        case Start(id, wanted):
            if not what or what == id:
                return True
            if isinstance(wanted, Say):
                return same_text(what, wanted.text)
            return what in (getattr(wanted, name) for name in wanted.__dataclass_fields__)
        case Publish(route):
            return what in ("", route)
        case Tell(_, event):
            return what in ("", event)
    return False


def _unknown(history: StepHistory, what: str) -> str:
    """Return the message for a question that has no answer, with a hint."""
    known = KnownNames(history.steps[-1])
    first = history.steps[0]
    kept = f"in the {history.steps[-1].at - first.at:.0f} s that the journal covers"
    if not what:
        return f"nothing happened {kept}"
    if known.has(what):
        return f"`{what}` did not happen {kept}: run `lumen why-not {what}`, or choose another time with `--at`"
    said = [of_command(c) for one in history.steps for c in one.step.commands if isinstance(c, Start)]
    hint = known.near(what)
    return f"nothing named `{what}` happened {kept}, and no text contains these words" + (
        f": {hint}" if hint else f"; the robot's last action: it {said[-1]}" if said else ""
    )
