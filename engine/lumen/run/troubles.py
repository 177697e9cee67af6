"""Troubles of a run: after one of them the run does not count as successful, even if it recovers."""

from collections.abc import Iterator
from typing import Literal, NamedTuple

from lumen.language.events import FALLEN, HELD, MISSED, Event
from lumen.language.machines import MachineDefinition
from lumen.statechart import Step
from lumen.statechart.nesting import flattened_steps

TroubleKind = Literal["fall", "dropped", "do", "joint"]

_ENDED = {"error.do.": "`do`", "error.invoke.": "`invoke`"}
"""The action that an error ended, by the prefix of the error's name."""


class RunTrouble(NamedTuple):
    """A fall, a dropped event or timer, an error of an action or `do`, or a joint that missed its goal."""

    kind: TroubleKind
    what: str
    """The trouble in words."""


def troubles_of_step(machine: MachineDefinition, step: Step) -> Iterator[RunTrouble]:
    """Yield the errors that ended a `do`, an `invoke` or other actions in this step, invoked behaviours included.

    Errors of a command that was cancelled, or refused because a person keeps the robot still, are left out as intended.
    """
    if not (step.raised or step.invoked):
        return
    for prefix, _, part in flattened_steps(machine, step):
        errors = [(event.name, _reason(event)) for event in part.raised if event.name.startswith("error.")]
        ended = [
            (f"an error ended the {what} of `{prefix}{name.removeprefix(begin)}`", reason)
            for name, reason in errors
            for begin, what in _ENDED.items()
            if name.startswith(begin)
        ]
        failed = [("an action failed", reason) for name, reason in errors if name == "error.execution"]
        for text, reason in ended or failed:  # an error in a `do` raises both
            if not wanted(reason):
                yield RunTrouble("do", text + (f": {reason}" if reason else ""))


def _reason(error: Event) -> str:
    reason = error.data.get("reason") if isinstance(error.data, dict) else None
    return "" if reason is None else str(reason)


def wanted(reason: str) -> bool:
    """Return whether a command failed because it was cancelled, or because a person keeps the robot still."""
    return reason == "cancelled" or reason.endswith(HELD)


def trouble_of_answer(event: Event) -> RunTrouble | None:
    """Return the trouble that an answer or an observation of the robot reports; None if it reports none."""
    if event.name == FALLEN:
        return RunTrouble("fall", "the robot fell")
    missed = event.data.get(MISSED) if isinstance(event.data, dict) else None
    return RunTrouble("joint", str(missed)) if missed else None
