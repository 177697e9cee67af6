"""Compiles the text of a step to a function: the names that it may use, and helpers shared with the full algorithm."""

from collections.abc import Callable, Mapping
from functools import cache, lru_cache
from typing import Any, TypeAlias

from lumen.expressions import Scope
from lumen.expressions.compiler import code_names
from lumen.expressions.scope import no_draw
from lumen.language.commands import Command, GoTo, Log, Publish, Say, Start
from lumen.language.events import Event
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.activities import placed
from lumen.statechart.advancing import cancelled, resumption_of
from lumen.statechart.chart import StateNode
from lumen.statechart.drawing import draw
from lumen.statechart.nested_values import with_value
from lumen.statechart.values import (
    Awaiting,
    Counters,
    Fork,
    Halted,
    Position,
    Snapshot,
    Step,
    Timer,
    Within,
    awaited,
)

Positions: TypeAlias = Mapping[str, Within]
WrittenStep: TypeAlias = Callable[[Snapshot, Event], Step | None]
"""A function that makes a step; it returns None if it does not cover the case."""


def leave(
    node: StateNode,
    at: float,
    timers: tuple[Timer, ...],
    commands: tuple[Command, ...],
    doing: Positions,
    halted: Mapping[str, Halted],
) -> tuple[tuple[Timer, ...], tuple[Command, ...], Positions, Mapping[str, Halted]]:
    """End the `do` of a state that is left; if the state has a `resume`, store the position.

    Return the timers, commands, positions and stored positions afterwards.
    """
    position = doing[node.path]
    if resumption_of(node):
        halted = {**halted, node.path: Halted(position, at)}
    timers, cancels = cancelled(timers, list(awaited(position)))
    return timers, commands + cancels, placed(doing, node.path, None), halted


def settled(position: Position | None, branch: int) -> Any:
    """Return the position after the branch with the index `branch` of a `parallel` has ended."""
    if isinstance(position, Within):
        return position._replace(inner=settled(position.inner, branch))
    assert isinstance(position, Fork)  # only a Fork has branches
    return Fork((*position.branches[:branch], None, *position.branches[branch + 1 :]))


def without_deadline(timers: tuple[Timer, ...], position: Position | None) -> tuple[Timer, ...]:
    """Return the timers without the deadline of the awaited `ask`; raise LookupError if there is no such timer."""
    while isinstance(position, Within):
        position = position.inner
    assert isinstance(position, Fork)  # the position of every question is a Fork
    kept, cancels = cancelled(timers, list(awaited(position.branches[1])))
    if cancels:
        raise LookupError(cancels)
    return kept


def without_ended(timers: tuple[Timer, ...], event: Event) -> tuple[Timer, ...]:
    """Return the timers without the `after` that an event ended.

    Raises LookupError if no timer matches, and ValueError if several timers have the event's id.
    """
    (number,) = [i for i, timer in enumerate(timers) if timer[0] == event[3]] or [-1]
    if number < 0 or timers[number][6] != "after" or timers[number][3] != event[0]:
        raise LookupError(event[0])
    return timers[:number] + timers[number + 1 :]


def without(mapping: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """Return the mapping without that key."""
    return {other: value for other, value in mapping.items() if other != key}


@cache
def _names() -> dict[str, Any]:
    """Return the names that the text of a step may use; it has no others."""
    return code_names() | {
        "Awaiting": Awaiting, "Counters": Counters, "Event": Event, "Fork": Fork, "GoTo": GoTo, "Log": Log,
        "Publish": Publish, "Say": Say, "Scope": Scope, "Snapshot": Snapshot, "Start": Start, "Step": Step,
        "Timer": Timer, "Within": Within, "draw": draw, "leave": leave, "nanoseconds": nanoseconds,
        "new": tuple.__new__, "no_draw": no_draw, "len": len, "placed": placed, "settled": settled,
        "with_value": with_value, "without": without, "without_deadline": without_deadline,
        "without_ended": without_ended,
        **{kind.__name__: kind for kind in (bool, int, float, str, list, tuple, dict, type(None), Exception)},
    }  # fmt: skip


@lru_cache(maxsize=1024)
def function_of(text: str) -> Callable[[tuple[Any, ...], Snapshot, Event], Step | None]:
    """Return the function `play` that the text defines; equal texts share one function."""
    names = dict(_names())
    exec(compile(text, "<step>", "exec", dont_inherit=True), names)
    play: Callable[[tuple[Any, ...], Snapshot, Event], Step | None] = names["play"]
    return play
