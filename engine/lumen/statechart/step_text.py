"""The text of a generated step: its lines, the constants that they name, and the expressions in them."""

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
"""The greatest number of lines of one function; longer functions are not generated."""
MAX_DEPTH = 40
"""The greatest nesting depth of one function: Python's parser allows a hundred levels."""

VARIABLES = {name: name for name in Snapshot._fields} | {"configuration": "names", "at": "before"}
"""The variable of a generated step that holds each field of the snapshot before the step."""
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
    """Raised if a part of a step can't be written into its text."""


class Sight(NamedTuple):
    """The values that an expression reads besides the context."""

    event: str | None
    """The variable that holds the event; None if the expression does not read it."""
    node: StateNode | None = None
    """The state of the expression."""
    active: Container[str] | None = None
    """The names for which `In` is true."""


class StepText:
    """The text of one function that is being written."""

    def __init__(self, machine: MachineDefinition) -> None:
        self.machine = machine
        self.lines: list[str] = []
        self.constants: list[Any] = []
        self.depth = 2
        self.scope: Sight | None = None
        self.chosen: dict[tuple[object, ...], str] = {}
        self.sendid = "''"

    def text(self) -> str:
        """Return the text written so far, as a complete function."""
        names = "".join(f"c{number}, " for number in range(len(self.constants)))
        body = "\n".join(self.lines)
        head = (
            _HEAD.format(sendid=self.sendid)
            + f"    {names}= constants\n" * bool(names)
            + "    commands = ()\n" * ("commands" in body)
        )
        return f"{head}    try:\n{body}\n    except Exception:\n        return None\n"

    def function(self) -> WrittenStep:
        """Return the text as a function."""
        return partial(function_of(self.text()), tuple(self.constants))

    def line(self, text: str) -> None:
        """Append a line; raise NotPlainError if the function becomes too long."""
        if len(self.lines) >= MAX_LINES:
            raise NotPlainError
        self.lines.append(_INDENT * self.depth + text)

    def end(self) -> None:
        """Append the line that leaves the rest to the full algorithm."""
        self.lines.append(_INDENT * self.depth + "return None")

    @contextmanager
    def branch(self, condition: str) -> Iterator[None]:
        """Write the lines of the `with` block under a condition; raise NotPlainError if they are nested too deep."""
        if self.depth > MAX_DEPTH:
            raise NotPlainError
        self.line(f"if {condition}:")
        self.depth, scope, chosen = self.depth + 1, self.scope, self.chosen
        self.chosen = {**chosen}
        yield
        self.depth, self.scope, self.chosen = self.depth - 1, scope, chosen

    def constant(self, value: Any) -> str:
        """Return the name of a constant that holds the value."""
        for number, known in enumerate(self.constants):
            if known is value:
                return f"c{number}"
        self.constants.append(value)
        return f"c{len(self.constants) - 1}"

    def several(self, values: tuple[object, ...]) -> str:
        """Return the text for a tuple."""
        return self.constant(values) if values else "()"

    def expression(self, source: str, sight: Sight, *, guard: bool = False) -> str:
        """Return the text of an expression in brackets, after a line that makes the `scope` that it needs."""
        found = inlined(source, sight.event or "", guard)
        self.see(found.needs, sight)
        return f"({found.text})"

    def filled(self, template: str, sight: Sight) -> str:
        """Return the text that fills in a template."""
        needed = template_needs(template)
        self.see(needed, sight)
        return f"{self.constant(compile_template(template))}({'scope' if needed else 'None'})"

    def value(self, value: ComputedValue, sight: Sight) -> str:
        """Return the text that computes a value as `compile_value` does."""
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
        """Write a line that makes a `scope` with the needed parts, unless the current one already has them."""
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
    """Return the parts of a Scope that a template reads."""
    holes = [part for part in split_template(text) if not isinstance(part, str)]
    return frozenset[str]().union(*(scope_needs(hole.source) for hole in holes))
