"""The outputs of a controller that do not move joints: a volume, messages, context keys, events.

An output is sent when it is first known, and again when it has changed by its binding's step since it was last sent
(send-on-delta sampling: Miskowicz, Sensors 2006). So a visitor who does not move causes no messages.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import groupby
from math import floor, inf, log10
from typing import Any, NamedTuple

from lumen.errors import LumenError
from lumen.fuzzy.evaluator import Evaluator
from lumen.language.commands import Publish
from lumen.language.controllers import (
    CONTROLLER_EVENT,
    ContextBinding,
    ContextInput,
    ControllerDefinition,
    InputBinding,
    MessageBinding,
    SignalBinding,
    ThresholdBinding,
    VolumeBinding,
)
from lumen.language.events import Event
from lumen.language.message_numbers import number, number_at

RouteField = tuple[str, ...]
"""A route, and the path of a field of its messages."""


class Signals(NamedTuple):
    """The signals to send now."""

    volume: float | None = None
    """From 0 to 1; None if it has not changed."""
    messages: tuple[Publish, ...] = ()
    events: tuple[Event, ...] = ()
    """Events for the behaviour."""


NOTHING = Signals()

ROUNDING = 1e-9
"""The greatest difference between float sums that count as equal."""


class Regulator:
    """The part of an active controller that moves no joint; it reads no clock and sends nothing; times are in [s].

    Pass it messages (`take`) and the contexts of the behaviour and of its invoked ones (`know`); `signals` returns what
    should be sent. Message fields in `whole` are rounded to integers.
    """

    def __init__(self, controller: ControllerDefinition, whole: Collection[RouteField] = ()) -> None:
        self.controller = controller
        self.routes = frozenset(binding.route for binding in controller.input_bindings)
        self._whole = whole
        self._evaluator = Evaluator(controller)
        self._inputs: dict[str, float] = {}
        self._outputs: dict[str, float] = {}
        self._told: dict[str, float] = {}
        self._beyond: set[str] = set()
        self._changed, self._told_at = False, -inf

    def succeed(self, before: "Regulator") -> None:
        """Continue from the state of another version: its inputs, and the last values sent for unchanged bindings."""
        mine, theirs = _sources(self.controller), _sources(before.controller)
        same = {name for name in mine if mine[name] == theirs.get(name)}
        self._inputs = {name: value for name, value in before._inputs.items() if name in same}
        kept = {signal.variable for signal in self.controller.signals if signal in before.controller.signals}
        self._told = {name: value for name, value in before._told.items() if name in kept}
        self._beyond = {name for name in before._beyond if name in kept}
        self._changed = True

    def take(self, route: str, body: object) -> None:
        """Update the inputs bound to a message's route; fields that are not numbers are ignored."""
        for binding in self.controller.input_bindings:
            if binding.route == route:
                self._set(binding.variable, number_at(body, binding.path))

    def know(self, contexts: Sequence[Mapping[str, Any]]) -> None:
        """Update the inputs bound to context keys, from the first of these contexts that has the key."""
        for source in self.controller.context_inputs:
            found = next((context[source.key] for context in contexts if source.key in context), None)
            self._set(source.variable, number(found))

    def signals(self, now: float) -> Signals:
        """Return the signals to send at `now`: those of the outputs that have changed enough since they were last sent.

        There are none if no input has changed, before `every` has passed since the last evaluation, while an input is
        missing, or if an output has no value: no rule fires for it, and it has neither a default nor a value to keep.
        """
        if not self._changed or now - self._told_at < self.controller.tracking.every - ROUNDING:
            return NOTHING
        if self._inputs.keys() != self.controller.inputs.keys():
            return NOTHING
        self._changed, self._told_at = False, now
        try:
            self._outputs = self._evaluator.evaluate(self._inputs, self._outputs)
        except LumenError:
            return NOTHING
        changed = [signal for signal in self.controller.signals if self._news(signal)]
        volume = next((self._told[s.variable] for s in changed if isinstance(s, VolumeBinding)), None)
        return Signals(volume, tuple(self._messages(changed)), tuple(self._events(changed, now)))

    def _set(self, variable: str, value: float | None) -> None:
        if value is not None and self._inputs.get(variable) != value:
            self._inputs[variable] = value
            self._changed = True

    def _news(self, signal: SignalBinding) -> bool:
        """Return True if a signal must be sent, and record its value as sent."""
        value = self._outputs[signal.variable]
        if isinstance(signal, ThresholdBinding):
            return self._crossed(signal, value)
        if isinstance(signal, VolumeBinding):
            value = min(max(value, 0.0), 1.0)
        before = self._told.get(signal.variable)
        if before is not None and (value == before or abs(value - before) < signal.step):
            return False
        self._told[signal.variable] = _rounded(value, signal.step)
        return True

    def _crossed(self, signal: ThresholdBinding, value: float) -> bool:
        """Return True if the output has passed the threshold, for the first time since it fell below the hysteresis.

        With a falling signal, both directions are reversed.
        """
        way = 1.0 if signal.rising else -1.0
        beyond = way * (value - signal.threshold)
        if signal.variable in self._beyond:
            if beyond <= -signal.hysteresis:
                self._beyond.remove(signal.variable)
            return False
        if beyond > ROUNDING:
            self._beyond.add(signal.variable)
        return beyond > ROUNDING

    def _messages(self, changed: Sequence[SignalBinding]) -> Iterator[Publish]:
        """Yield a message for each route with a changed field; it has all bound fields of the route."""
        routes = {signal.route for signal in changed if isinstance(signal, MessageBinding)}
        bound = [s for s in self.controller.signals if isinstance(s, MessageBinding) and s.route in routes]
        for route, fields in groupby(sorted(bound, key=lambda s: s.route), key=lambda s: s.route):
            body: dict[str, Any] = {}
            for signal in fields:
                value = self._told[signal.variable]
                whole = (route, *signal.path) in self._whole
                body = _merged(_merged(body, signal.body), _at(signal.path, round(value) if whole else value))
            yield Publish(route, body)

    def _events(self, changed: Sequence[SignalBinding], now: float) -> Iterator[Event]:
        given = {s.key: self._told[s.variable] for s in changed if isinstance(s, ContextBinding)}
        if given:
            yield Event(f"{CONTROLLER_EVENT}{self.controller.name}", given, now)
        for signal in changed:
            if isinstance(signal, ThresholdBinding):
                yield Event(signal.event, {"value": self._outputs[signal.variable]}, now)


def _sources(controller: ControllerDefinition) -> dict[str, InputBinding | ContextInput]:
    """Return the binding of each input."""
    found: dict[str, InputBinding | ContextInput] = {b.variable: b for b in controller.input_bindings}
    return {**found, **{source.variable: source for source in controller.context_inputs}}


def _rounded(value: float, step: float) -> float:
    """Return the value rounded to a tenth of its step or finer, because more digits are useless."""
    return round(value, 1 - floor(log10(step))) if step > 0.0 else value


def _at(path: Sequence[str], value: Any) -> dict[str, Any]:
    """Return a body with that value in the field at `path`."""
    for step in reversed(path):
        value = {step: value}
    found: dict[str, Any] = value
    return found


def _merged(one: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """Return a body with the fields of both; a common field has the value of `other`, and common maps are merged."""
    both = {**one, **other}
    for key in one.keys() & other.keys():
        if isinstance(one[key], Mapping) and isinstance(other[key], Mapping):
            both[key] = _merged(one[key], other[key])
    return both
