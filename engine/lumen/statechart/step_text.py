"""The text of a step being written: its lines, the constants that they name, and expressions within them."""

from collections.abc import Container, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache, partial
from math import isfinite
from typing import Any, NamedTuple

from lumen.expressions import compile_template, split_template
from lumen.expressions.inlining import inlined, scope_needs
from lumen.language.actions import ComputedValue, Expression
from lumen.language.machines import MachineDefinition
from lumen.statechart.chart import StateNode
from lumen.statechart.step_code import WrittenStep, function_of
from lumen.statechart.values import Snapshot

MAX_LINES = 200
"""Of one function; what would be longer is not written."""
MAX_DEPTH = 40
"""Levels of one function: Python reads no more than a hundred."""

VARIABLES = {name: name for name in Snapshot._fields} | {"configuration": "names", "at": "before"}
"""The variable of a written step that holds each field of the snapshot before it."""
_HEAD = f"""\
def play(constants, snapshot, event):
    {", ".join(VARIABLES.values())} = snapshot
    at = event[2]
    if event[3] != {{sendid}} or invoked:
        return None
    if not at >= before:
        at = before
"""
_INDENT = "    "


class NotPlainError(Exception):
    """There is something that is not written."""


class Sight(NamedTuple):
    """What an expression sees besides the context: the event, by its variable, its state, and what is active."""

    event: str | None
    node: StateNode | None = None
    active: Container[str] | None = None


class StepText:
    """One function being written; `scope` is what the variable of that name shows now, None where there is none.

    It is for events of that `sendid`, by how it is written; most have none. `chosen` are the variables that hold which
    row of `hears` of a state is taken.
    """

    def __init__(self, machine: MachineDefinition) -> None:
        self.machine = machine
        self.lines: list[str] = []
        self.constants: list[Any] = []
        self.depth = 2
        self.scope: Sight | None = None
        self.chosen: dict[tuple[object, ...], str] = {}
        self.sendid = "''"

    def text(self) -> str:
        """What was written."""
        names = "".join(f"c{number}, " for number in range(len(self.constants)))
        body = "\n".join(self.lines)
        head = (
            _HEAD.format(sendid=self.sendid)
            + f"    {names}= constants\n" * bool(names)
            + "    commands = ()\n" * ("commands" in body)
        )
        return f"{head}    try:\n{body}\n    except Exception:\n        return None\n"

    def function(self) -> WrittenStep:
        """It as a function."""
        return partial(function_of(self.text()), tuple(self.constants))

    def line(self, text: str) -> None:
        """Raises NotPlainError where it becomes too long."""
        if len(self.lines) >= MAX_LINES:
            raise NotPlainError
        self.lines.append(_INDENT * self.depth + text)

    def end(self) -> None:
        """Leave it to the whole algorithm from here on."""
        self.lines.append(_INDENT * self.depth + "return None")

    @contextmanager
    def branch(self, condition: str) -> Iterator[None]:
        """Lines for where the condition holds; raises NotPlainError where they stand too deep."""
        if self.depth > MAX_DEPTH:
            raise NotPlainError
        self.line(f"if {condition}:")
        self.depth, scope, chosen = self.depth + 1, self.scope, self.chosen
        self.chosen = {**chosen}
        yield
        self.depth, self.scope, self.chosen = self.depth - 1, scope, chosen

    def constant(self, value: Any) -> str:
        """What stands for a value that the text does not spell out."""
        for number, known in enumerate(self.constants):
            if known is value:
                return f"c{number}"
        self.constants.append(value)
        return f"c{len(self.constants) - 1}"

    def several(self, values: tuple[object, ...]) -> str:
        """What stands for a tuple."""
        return self.constant(values) if values else "()"

    def expression(self, source: str, sight: Sight, *, guard: bool = False) -> str:
        """An expression, between brackets; before it the line that makes the `scope` it needs."""
        found = inlined(source, sight.event or "", guard)
        self.see(found.needs, sight)
        return f"({found.text})"

    def filled(self, template: str, sight: Sight) -> str:
        """A template filled in."""
        needed = template_needs(template)
        self.see(needed, sight)
        return f"{self.constant(compile_template(template))}({'scope' if needed else 'None'})"

    def value(self, value: ComputedValue, sight: Sight) -> str:
        """A value that is computed, as `compile_value` does it."""
        match value:
            case Expression(source):
                return self.expression(source, sight)
            case tuple():
                return f"[{', '.join(self.value(item, sight) for item in value)}]"
            case Mapping():
                return f"{{{', '.join(f'{key!r}: {self.value(item, sight)}' for key, item in value.items())}}}"
            case None | bool() | int():
                return repr(value)
            case float() if isfinite(value):
                return repr(value)
        return self.constant(value)

    def see(self, needed: frozenset[str], sight: Sight) -> None:
        """Let `scope` show what is needed."""
        if not needed:
            return
        wanted = Sight(
            sight.event if needed & {"event", "heard"} else None,
            sight.node if "state" in needed else None,
            sight.active if "In" in needed else None,
        )
        if self.scope and all(seen is None or seen is shown for seen, shown in zip(wanted, self.scope, strict=True)):
            return
        event = f"{{'name': {wanted.event}[0], 'data': {wanted.event}[1]}}" if wanted.event else "None"
        view = f"{self.constant(wanted.node.view)}(language, place)" if wanted.node else "None"
        active = f"{self.constant(wanted.active)}.__contains__" if wanted.active is not None else "None"
        machine = self.machine
        phrases, answers, lists = map(self.constant, (machine.phrases, machine.answers, machine.lists))
        self.line(
            f"scope = new(Scope, (context, {event}, {view}, {active}, at, language, {phrases}, {answers}, epoch,"
            f" timezone, {lists}, no_draw, {self.constant(machine)}))"
        )
        self.scope = wanted


@lru_cache(maxsize=8192)
def template_needs(text: str) -> frozenset[str]:
    """What a template needs a Scope for."""
    holes = [part for part in split_template(text) if not isinstance(part, str)]
    return frozenset[str]().union(*(scope_needs(hole.source) for hole in holes))
