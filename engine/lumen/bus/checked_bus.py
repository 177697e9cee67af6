"""A bus of an installed package: its faults, and values of a wrong type, are errors that name the package."""

from collections.abc import Callable, Mapping
from functools import partial
from threading import Event as Signal
from typing import Any

from lumen.errors import LumenError
from lumen.language.routes import Route
from lumen.ports import (
    Ability,
    BlockableBus,
    Bus,
    CountsDrops,
    EndsWithExhibition,
    Message,
    MessageHandler,
    Outgoing,
    SignsMessages,
    UsesBroker,
)
from lumen.project.broken_features import faults_named, shown

_VALUES: tuple[tuple[type[Any], str, Callable[[Any], object], type], ...] = (
    (CountsDrops, "dropped", lambda bus: bus.dropped, Mapping),
    (SignsMessages, "sender", lambda bus: bus.sender, str),
    (BlockableBus, "blocked", lambda bus: bus.blocked, str),
    (UsesBroker, "host", lambda bus: bus.host, str),
    (UsesBroker, "away", lambda bus: bus.away, bool),
    (EndsWithExhibition, "gone", lambda bus: bus.gone, Signal),
)
"""The values of each ability, with their types."""


class CheckedBus(Bus):
    """A wrapper that passes everything on to `bus`; `fault` makes an error of words such as "returned 7 from …".

    Raises that error for an ability whose values have wrong types.
    """

    def __init__(self, bus: Bus, fault: Callable[[str], LumenError]) -> None:
        self._bus, self._fault = bus, fault
        for ability, name, value_of, kind in _VALUES:
            if able := self.ability(ability):
                with faults_named(fault, name):
                    value = value_of(able)
                if not isinstance(value, kind):
                    raise fault(f"has {shown(value)} as `{name}`: it must be a {kind.__name__}")

    def ability(self, kind: type[Ability]) -> Ability | None:
        with faults_named(self._fault, "ability"):
            found = self._bus.ability(kind)
            if found is None or isinstance(found, kind):
                return found
        raise self._fault(f"returned {shown(found)} from `ability`: it must return a `{kind.__name__}` or None")

    def carry(self, routes: Mapping[str, Route]) -> None:
        with faults_named(self._fault, "carry"):
            self._bus.carry(routes)

    def prepare(self, routes: Mapping[str, Route]) -> None:
        with faults_named(self._fault, "prepare"):
            self._bus.prepare(routes)

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        with faults_named(self._fault, "subscribe"):
            undo = self._bus.subscribe(pattern, handler)
        if not callable(undo):
            raise self._fault(f"returned {shown(undo)} from `subscribe`: it must return a function")
        return partial(self._end, undo)

    def send(self, message: Outgoing) -> None:
        with faults_named(self._fault, "send"):
            self._bus.send(message)

    def reply(self, message: Message, body: Any) -> None:
        with faults_named(self._fault, "reply"):
            self._bus.reply(message, body)

    def close(self) -> None:
        with faults_named(self._fault, "close"):
            self._bus.close()

    def _end(self, undo: Callable[[], None]) -> None:
        with faults_named(self._fault, "the end of a subscription"):
            undo()
