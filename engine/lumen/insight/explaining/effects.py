"""What a question is about: the last time that something was said, played, done or entered."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.insight.explaining.history import StepHistory
from lumen.insight.explaining.names import KnownNames, same_text, state_named
from lumen.insight.explaining.words import of_command
from lumen.language.commands import Command, Publish, Say, Start, Tell
from lumen.statechart.nesting import entered_names


class Effect(NamedTuple):
    """Something that happened in the step of that number: a command, or a state that was entered."""

    number: int
    what: str
    command: Command | None = None
    state: str = ""


def effect(history: StepHistory, what: str) -> Effect:
    """The last time that `what` happened; empty for the last thing that happened at all.

    Raises UsageError, saying what to do, where it did not happen as far as is kept.
    """
    if not history.steps:
        raise UsageError("the journal has no entries from that time: choose another time with `--at`")
    found = next(_effects(history, what), None)
    if found is None:
        raise UsageError(_unknown(history, what))
    return found


def _effects(history: StepHistory, what: str) -> Iterator[Effect]:
    """The newest first."""
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
    """Whether a command is what somebody asks about: by its id, by part of its text, or by a name in it."""
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
    """What to do about a question that has no answer."""
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
