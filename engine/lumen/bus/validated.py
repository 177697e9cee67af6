"""Validation of bodies against the message schemas of a project's routes."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from lumen.bus.aliases import COPY, Aliases
from lumen.bus.bodies import check_subscription
from lumen.bus.checking import SchemaCheck, body_checks
from lumen.errors import BadMessageError, Refused
from lumen.language.projects import Project
from lumen.language.routes import Route
from lumen.language.routing_keys import KEY_PREFIXES
from lumen.ports import Ability, Bus, KnowsListeners, Message, MessageHandler, Outgoing
from lumen.project.broken_features import fault_of_subscriber
from lumen.upkeep.drops import ReasonLog

OnRefused = Callable[[str, str], object]
"""Called for a message that was not delivered, with its key and the reason."""

MAX_FAULTS = 100
"""The number of different faults of subscribers that are reported; later ones are not."""

_log = logging.getLogger(__name__)


class ValidatedBus(Bus):
    """A bus that passes only bodies that are valid on their routes.

    If this program publishes an invalid body, `publish` raises BusError. If an invalid body arrives, it is not
    delivered: `on_refused` is called, and the bus sets the message aside and answers the sender. Keys without a route
    pass unchecked if they begin with `avatar` or `lumen`, others not at all. A key with an alias is also sent and
    received under it.

    `arrived` is called, on any thread, after a subscriber has handled a message. `failed` is called once with each
    fault of an installed package's subscriber, whose message is lost; the fault is logged with its traceback. On a bus
    in this process, a message that was sent here keeps the same object as its id, and is not checked again for each
    subscriber.
    """

    def __init__(
        self,
        bus: Bus,
        project: Project,
        on_refused: OnRefused | None = None,
        arrived: Callable[[], None] | None = None,
        failed: Callable[[str], None] = lambda _: None,
    ) -> None:
        self._bus, self._listeners = bus, bus.ability(KnowsListeners)
        self._on_refused = on_refused or ReasonLog(_log, "a message on `%(key)s` was refused: %(reason)s")
        self._checks: dict[str, SchemaCheck] = {}
        self._routed: frozenset[str] = frozenset()
        self._passed: str | None = None
        self._aliases, self._listening = Aliases(), list[_Listening]()
        self._arrived, self._failed = arrived, failed
        self._faults: set[str] = set()
        self.use(project)

    def ability(self, kind: type[Ability]) -> Ability | None:
        return self if isinstance(self, kind) else self._bus.ability(kind)

    @property
    def unchecked(self) -> Bus:
        """The bus beneath, for observers: it also carries messages that fit no route."""
        return self._bus

    def heard(self, key: str) -> bool:
        """Return whether a message with this key has a receiver under its key or its alias; True if that is unknown."""
        known = self._listeners
        alias = self._aliases.names.get(key) if self._aliases.used else None
        return known is None or known.heard(key) or bool(alias and known.heard(alias))

    def use(self, project: Project) -> None:
        """Switch to the routes and schemas of another bundle, also while messages flow."""
        routes = by_key(project)
        self._checks, self._routed, self._passed = body_checks(project), frozenset(routes), None
        self._bus.carry(routes)
        if not isinstance(self._bus, ValidatedBus):  # a validated bus beneath handles the aliases already
            self._aliases.use(project, self._bus)
            for listening in tuple(self._listening):
                self._listen(listening)

    def carry(self, routes: Mapping[str, Route]) -> None:
        self._bus.carry(routes)

    def prepare(self, routes: Mapping[str, Route]) -> None:
        self._bus.prepare(routes)

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        check_subscription(pattern, handler)
        arrived = self._arrived

        def checked(message: Message) -> None:
            if message.id is not self._passed and (reason := self._wrong(message.key, message.body)):
                self._on_refused(message.key, reason)
                raise Refused(reason)
            try:
                handler(message)
            except (Refused, KeyboardInterrupt):
                raise
            except BaseException as error:  # even SystemExit
                if not (fault := fault_of_subscriber(error, pattern)):
                    raise
                self._report(fault, error)
            if arrived:
                arrived()

        listening = _Listening(pattern, checked, self._bus.subscribe(pattern, checked))
        self._listening.append(listening)
        self._listen(listening)

        def undo() -> None:
            if listening in self._listening:
                self._listening.remove(listening)
                listening.undo()
                if listening.alias:
                    listening.alias.undo()

        return undo

    def send(self, message: Outgoing) -> None:
        key, body = message.key, message.body
        check = self._checks.get(key)
        if (check is None or not check.fits(body)) and (reason := self._wrong(key, body)):
            raise BadMessageError(f"a message on `{key}` cannot be sent: {reason}")
        self._passed = message.id
        self._bus.send(message)
        if (alias := self._aliases.names.get(key)) and self._aliases.used:
            self._bus.send(message._replace(key=alias, id=f"{message.id}{COPY}"))

    def reply(self, message: Message, body: Any) -> None:
        self._bus.reply(message, body)

    def close(self) -> None:
        self._bus.close()

    def _report(self, fault: str, error: BaseException) -> None:
        """Report a fault of a subscriber once."""
        if fault not in self._faults and len(self._faults) < MAX_FAULTS:
            self._faults.add(fault)
            _log.error("%s", fault, exc_info=error)
            self._failed(fault)

    def _listen(self, listening: "_Listening") -> None:
        """Subscribe under the present alias of the pattern, if it has one, instead of the previous alias."""
        alias, before = self._aliases.names.get(listening.pattern, ""), listening.alias
        if alias == (before.pattern if before else ""):
            return
        listening.alias = None
        if alias:
            handler = self._aliases.taking(listening.handler)
            listening.alias = _Listening(alias, handler, self._bus.subscribe(alias, handler))
        if before:
            before.undo()

    def _wrong(self, key: str, body: Any) -> str:
        check = self._checks.get(key)
        if check is not None:
            return check(body)
        known = key in self._routed or key.split(".", 1)[0] in KEY_PREFIXES
        return "" if known else "no route in lumen.yaml has this key, and it does not begin with `avatar` or `lumen`"


@dataclass(eq=False)
class _Listening:
    """A subscription, and the one under the alias of its key."""

    pattern: str
    handler: MessageHandler
    undo: Callable[[], None]
    """Ends the subscription."""
    alias: "_Listening | None" = None
    """The subscription under the alias of the pattern, None if the pattern has no alias."""


def by_key(project: Project) -> dict[str, Route]:
    """Return the project's routes by their keys and aliases; of several with the same key, the most reliable one."""
    routes = sorted(project.routes.values(), key=lambda route: route.must_arrive)
    aliases = {route.alias: route for route in routes if route.alias and project.aliases is not False}
    return aliases | {route.key_for(robot): route for route in routes for robot in project.served}


def validated(
    bus: Bus,
    project: Project,
    on_refused: OnRefused | None = None,
    arrived: Callable[[], None] | None = None,
    failed: Callable[[str], None] = lambda _: None,
) -> ValidatedBus:
    """Return the bus with all messages checked against the project's message schemas."""
    return ValidatedBus(bus, project, on_refused, arrived, failed)
