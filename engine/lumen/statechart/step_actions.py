"""Writes actions into the text of a generated step, and tracks the facts on which later parts of the text rely."""

from collections.abc import Callable, Container
from copy import copy
from dataclasses import dataclass
from functools import partial
from math import isfinite
from typing import TypeAlias

from lumen.expressions.inlining import scope_needs
from lumen.language.actions import (
    Action,
    AskQuestion,
    Assign,
    CancelSend,
    ComputedValue,
    If,
    LogText,
    Parallel,
    PlacedAction,
    PublishBody,
    Raise,
    SayText,
    Send,
    Wait,
)
from lumen.language.added_verbs import is_template
from lumen.language.commands import Do, GoTo, Language
from lumen.language.machines import Transition
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.asking import compile_question
from lumen.statechart.blocks import alternatives
from lumen.statechart.chart import Chart, StateNode
from lumen.statechart.plans import Configuration
from lumen.statechart.step_text import VARIABLES, NotPlainError, Sight, StepText, template_needs
from lumen.statechart.values import MAX_TIMERS

Op: TypeAlias = Callable[["Certain"], None]


@dataclass(slots=True, eq=False)
class Certain:
    """The facts that are certain at the current point of the text; they differ between its branches."""

    configuration: Configuration
    """The active states."""
    agenda: tuple[Op, ...]
    """The operations that the algorithm executes next."""
    event: str = "event"
    """The variable that holds the event being processed."""
    queue: tuple[tuple[str, str], ...] = ()
    """The internal queue: the variable and the name of each event."""
    beginnings: tuple[StateNode, ...] = ()
    """The states that were entered and whose `do` has not begun."""
    exited: tuple[str, ...] = ()
    entered: tuple[str, ...] = ()
    transitions: tuple[Transition, ...] = ()
    raised: tuple[str, ...] = ()
    """The variables of all internal events raised so far."""
    started: int = 0
    """The number of ids given to commands that are not awaited (`c…`)."""
    awaited: int = 0
    """The number of ids given to awaited commands (`d…`)."""
    timed: int = 0
    """The number of ids given to timers."""
    commanded: bool = False
    """True if there may be commands."""
    settled: bool = False
    """True while no eventless transition can be enabled."""
    ended: bool = False
    """True once this branch of the text returns."""

    def first(self, *ops: Op) -> None:
        """Put operations before the rest of the agenda."""
        self.agenda = (*ops, *self.agenda)


class ActionText(StepText):
    """A step being written, with the actions that it executes and the Step that it returns.

    Methods raise NotPlainError for anything that is not supported, or if the text becomes too long.
    """

    def __init__(self, chart: Chart, start: Configuration) -> None:
        super().__init__(chart.definition)
        self.chart, self.start = chart, start

    def run(self, known: Certain) -> None:
        """Write everything that follows."""
        raise NotImplementedError

    def either(self, condition: str, known: Certain, *ops: Op) -> None:
        """Write all that follows if a condition is true; the text written next is for the case that it is false."""
        with self.branch(condition):
            other = copy(known)
            other.first(*ops)
            self.run(other)

    def block(self, actions: tuple[PlacedAction, ...], node: StateNode, active: Container[str], known: Certain) -> None:
        """Put actions that end at once at the front of the agenda (`_execute`)."""
        known.first(*(partial(self.act, placed.action, node, active) for placed in actions))

    def act(self, action: Action, node: StateNode, active: Container[str], known: Certain) -> None:
        """Write one action (`compile_action`); raise NotPlainError if it is not supported."""
        sight = Sight(known.event, node, active)
        match action:
            case Assign(values):
                for way, value in values.items():
                    self.assign(way, value, sight)
            case Raise(event, data):
                self.raises(event, self.value(data, sight), known)
            case PublishBody(route, body):
                self.emit(f"Publish({route!r}, {self.value(body, sight)})", known)
            case LogText(template):
                self.emit(f"Log({self.filled(template.text, sight)})", known)
            case If(guard, then, otherwise):
                condition = self.expression(guard.source, sight, guard=True)
                self.either(condition, known, partial(self.block, then, node, active))
                known.first(partial(self.block, otherwise, node, active))
            case Send(event, data, float() as delay, id, "") if isfinite(delay):
                self.line(f"if len(timers) >= {MAX_TIMERS}: return None")
                own = repr(id) if id else self.timer_id("s", known)
                self.timer(own, nanoseconds(delay), repr(event), self.value(data, sight), "''", "send")
            case CancelSend(id):
                self.line(f"timers = tuple([t for t in timers if t[6] != 'send' or t[0] != {id!r}])")
            case Send() | Wait() | Parallel() | AskQuestion():
                raise NotPlainError
            case _:
                command = self.command(action, sight)
                known.started += 1
                self.emit(f"Start(f'c{{counters[0] + {known.started}}}', {command})", known)

    def assign(self, way: str, value: ComputedValue, sight: Sight) -> None:
        """Write the assignment of a context key; the step gives up on an unexpected type (`compile_assignment`)."""
        self.line(f"value = {self.value(value, sight)}")
        key, *within = way.split(".")
        if within:
            self.line(f"value = with_value(context[{key!r}], {key!r}, {within!r}, value)")
        if check := self.chart.checks.get(key):
            unlike = [f"type(value) is not {kind}" for kind in sorted(kind.__name__ for kind in check.quick)]
            self.line(f"if {' and '.join(unlike) or True}: return None")
        self.line(f"context = {{**context, {key!r}: value}}")
        self.scope = None

    def command(self, action: Action, sight: Sight) -> str:
        """Return the text for the command of a robot verb (`compile_command`)."""
        match action:
            case SayText(texts, gestures):
                spoken = [template.text for templates in texts.values() for template in templates]
                needed = frozenset[str]().union(*map(template_needs, spoken))
                self.see(needed, sight)
                self.line(f"said, templates = {self.constant(alternatives(texts))}(language)")
                self.line("drawn, generator = draw(generator, len(templates))")
                return f"Say(templates[drawn]({'scope' if needed else 'None'}), said, {gestures!r})"
            case Language(language):
                self.line(f"language = {language!r}")
                self.scope = None
            case GoTo(to) if "{{" in to:
                return f"GoTo({self.filled(to, sight)})"
            case Do() if is_template(action):
                raise NotPlainError
        return self.constant(action)

    def begin(self, action: Action, node: StateNode, known: Certain) -> str:
        """Write the start of an action of a `do` (`Advance.begin`).

        Return the text of its position, `None` if it has ended. Raises NotPlainError if the action is not supported.
        """
        sight = Sight(known.event, node, known.configuration.known)
        match action:
            case Assign() | Raise() | Send() | CancelSend() | PublishBody() | LogText():
                self.act(action, node, known.configuration.known, known)
                return "None"
            case Parallel(branches):
                begun = [self.begin(branch.action, node, known) for branch in branches]
                return f"new(Fork, (({', '.join(begun)},),))" if set(begun) != {"None"} else "None"
            case Wait(seconds):
                return self.wait(seconds, node, known)
            case AskQuestion(question, within):
                self.see(scope_needs(question.source) | {"context", "state"}, sight)
                asked = self.awaits(f"{self.constant(compile_question(action))}(scope)", known)
                return f"new(Fork, (({asked}, {self.wait(within, node, known)}, None),))"
            case If():
                raise NotPlainError
        return self.awaits(self.command(action, sight), known)

    def awaits(self, command: str, known: Certain) -> str:
        """Write the start of an awaited command; return the text of the position that awaits it."""
        known.awaited += 1
        variable = f"d{known.awaited}"
        self.line(f"{variable} = f'd{{counters[1] + {known.awaited}}}'")
        self.emit(f"Start({variable}, {command})", known)
        return f"new(Awaiting, ({variable}, at))"

    def wait(self, seconds: float, node: StateNode, known: Certain) -> str:
        """Write the timer of a `wait` of `seconds` [s]; return the text of the position that awaits it."""
        id = self.timer_id("w", known)
        self.timer(id, nanoseconds(seconds), f"'wait.' + {id}", "None", self.constant(node.path), "wait")
        return f"new(Awaiting, ({id}, at))"

    def timer_id(self, letter: str, known: Certain) -> str:
        """Write the id of a new timer; return its variable."""
        known.timed += 1
        variable = f"t{known.timed}"
        self.line(f"{variable} = f'{letter}{{counters[2] + {known.timed}}}'")
        return variable

    def timer(self, id: str, delay: int, event: str, data: str, path: str, kind: str) -> None:
        """Write a new timer that ends `delay` [ns] from now; the other arguments are texts."""
        length = self.constant(delay)
        timer = f"({id}, nanoseconds(at) + {length}, {length}, {event}, {data}, {path}, {kind!r}, '')"
        self.line(f"timers += (new(Timer, {timer}),)")

    def emit(self, command: str, known: Certain) -> None:
        """Write a command that is appended to those of the step."""
        self.line(f"commands += ({command},)")
        known.commanded = True

    def raises(self, name: str, data: str, known: Certain) -> None:
        """Write an internal event of that name; `data` is the text of its data."""
        variable = f"r{len(known.raised)}"
        self.line(f"{variable} = new(Event, ({self.constant(name)}, {data}, at, '', None))")
        known.raised += (variable,)
        known.queue += ((variable, name),)

    def result(self, known: Certain) -> None:
        """Write the return of the Step, from everything that is certain."""
        given = (known.started, known.awaited, known.timed)
        counted = ", ".join(f"counters[{number}] + {count}" for number, count in enumerate(given))
        counters = f"new(Counters, ({counted}))" if any(given) else "counters"
        target = "names" if known.configuration is self.start else self.constant(known.configuration.names)
        after = VARIABLES | {"configuration": target, "at": "at", "counters": counters}
        exited, entered, taken = map(self.several, (known.exited, known.entered, known.transitions))
        commands = "commands" if known.commanded else "()"
        raised = "".join(f"{variable}, " for variable in known.raised)
        self.line(f"after = new(Snapshot, ({', '.join(after.values())}))")
        self.line(f"return new(Step, (event, {exited}, {entered}, {commands}, after, {taken}, ({raised}), ()))")
        known.ended = True
