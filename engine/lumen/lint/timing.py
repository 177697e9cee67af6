"""Estimates the duration of a `do`, and reports states that are left earlier."""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from math import hypot

from lumen.errors import BadCommandError
from lumen.expressions import split_template
from lumen.language.actions import If, Parallel, PlacedAction, SayText, Wait
from lumen.language.commands import Do, Play, Posture, Walk
from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition, State
from lumen.language.motions import MotionDefinition
from lumen.project.added_verbs import time_taken
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

CUT_SHORT = Code("cut-short", "statecharts", WARNING, "an `after` ends a state before its `do` can finish")


SECONDS_PER_TEXT, SECONDS_PER_CHARACTER, WALKING_SPEED = 0.4, 0.06, 0.1
"""The recording robot's times per text and per character [s], and its walking speed [m/s]."""


def check(draft: ProjectDraft) -> None:
    """Report an `after` that always ends the state before its `do` has finished."""
    for name, machine in draft.behaviors.items():
        for state in machine.states.values():
            if state.do and any(isinstance(t.delay, float) for t in state.transitions):
                _cut(machine, state, draft.report("behaviors", name), draft.motions)


def _cut(
    machine: MachineDefinition, state: State, report: DocumentReport, motions: Mapping[str, MotionDefinition]
) -> None:
    length = duration(state.do, motions)
    for transition in state.transitions:
        delay = transition.delay
        if not isinstance(delay, float) or transition.guard or not transition.targets or length <= delay + 0.05:
            continue
        texts = [step for step in state.do if isinstance(step.action, SayText) and duration((step,), motions) > delay]
        what = "saying this" if texts else "its `do`"
        message = f"`{state.name}` is left after {delay:g} s, but {what} takes about {length:.1f} s"
        hint = f"write at least {length + 1:.0f}s" + (", or shorten the text" if texts else "")
        key = transition.where if isinstance(transition.where[-1], str) else transition.where[:-1]
        first = texts[0].where if texts else (*state.where, "do")
        report(CUT_SHORT, key, message, hint, key=True, related=[(first, "this takes longer")])


def duration(block: Iterable[PlacedAction], motions: Mapping[str, MotionDefinition]) -> float:
    """Return the minimum duration of these actions in sequence [s]; among alternative texts, the longest counts.

    Unknown durations, such as those of an expression's text or of a walk's turn, count as 0.
    """
    return sum(_one(step, motions) for step in block)


def _one(step: PlacedAction, motions: Mapping[str, MotionDefinition]) -> float:
    match step.action:
        case SayText(texts):
            return SECONDS_PER_TEXT + SECONDS_PER_CHARACTER * max(
                _length(text.text) for said in texts.values() for text in said
            )
        case Play(name):
            return motions[name].duration if name in motions else 0.0
        case Posture():
            return 0.0  # the robot may be in that posture already
        case Walk(x, y):
            return hypot(x, y) / WALKING_SPEED
        case Wait(seconds):
            return seconds
        case Do() as done:
            return _taken(done)
        case If(then=then, otherwise=otherwise):
            return min(duration(then, motions), duration(otherwise, motions))
        case Parallel(branches):
            return max((_one(branch, motions) for branch in branches), default=0.0)
    return 0.0


def _taken(command: Do) -> float:
    with suppress(BadCommandError):  # only a running step can compute the argument
        return time_taken(command)
    return 0.0


def _length(text: str) -> int:
    """Return the number of characters of a text outside its expressions."""
    return len(text) if "{{" not in text else sum(len(part) for part in split_template(text) if isinstance(part, str))
