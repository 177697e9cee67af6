"""Rules for show control: whether MQTT, OSC and DMX can carry the routes of `modules.show`."""

from collections.abc import Iterator, Mapping

from lumen.features.show.settings import SHOW_PATH, DmxLink, MqttLink, OscLink, Show, may_come_from_devices
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.routes import Direction, Route
from lumen.lint.references import known_route
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.message_fields import FieldKind, SchemaField, message_fields

SHOW_ADDRESS = Code("show-address", "routes", ERROR, "a topic, an address or a channel is invalid, or is used twice")
SHOW_DIRECTION = Code("show-direction", "routes", ERROR, "a device can't send on a route, or is not allowed to")
SHOW_FIELD = Code("show-field", "routes", ERROR, "a field of a message can't be sent to or from a device")

MAX_TOPIC_BYTES = 65_535
"""The maximum length of a topic in MQTT 3.1.1 (4.7.3) [bytes]."""
_OSC_RESERVED = " #*,?[]{}"
"""The characters that an OSC address must not contain (OSC 1.0)."""


def check(draft: ProjectDraft) -> None:
    """Report errors in the links to devices."""
    settings, report = draft.settings, draft.main
    if settings is None or report is None:
        return
    ways, show = _Ways(draft, report), settings.section(Show)
    if show.mqtt:
        ways.mqtt(show.mqtt)
    if show.osc:
        ways.osc(show.osc)
    if show.dmx:
        ways.dmx(show.dmx)


class _Ways:
    """The rules for each link; `draft` must have settings."""

    def __init__(self, draft: ProjectDraft, report: DocumentReport) -> None:
        self.draft, self.report = draft, report

    def mqtt(self, link: MqttLink) -> None:
        """Report errors in the MQTT link's topics, fields and directions."""
        path, taken = (*SHOW_PATH, "mqtt", "routes"), dict[str, str]()
        for name, row in link.routes.items():
            where = _value(self.report, (*path, name), "topic")
            if fault := _topic_fault(row.topic):
                self.report(SHOW_ADDRESS, where, *fault)
            else:
                self.twice(taken, row.topic, name, where)
        for name, route in self.routes(path, link.routes):
            self.may_come(route, (*path, name))
            if field := link.routes[name].field:
                where = (*path, name, "field")
                kinds = (FieldKind.STRING, FieldKind.NUMBER, FieldKind.INTEGER, FieldKind.BOOLEAN)
                self.field(route, field, where, kinds, "a plain-text message can be only a text, a number or a boolean")

    def osc(self, link: OscLink) -> None:
        """Report errors in the OSC link's addresses, arguments and directions."""
        path, taken = (*SHOW_PATH, "osc", "routes"), dict[str, str]()
        for name, row in link.routes.items():
            where = _value(self.report, (*path, name), "address")
            if fault := _address_fault(row.address):
                self.report(SHOW_ADDRESS, where, *fault)
            else:
                self.twice(taken, row.address, name, where)
        for name, route in self.routes(path, link.routes):
            if self.may_come(route, (*path, name)) and route.direction is Direction.IN and link.listen is None:
                message = f"`{name}` is an incoming route, but `osc` does not listen for messages"
                self.report(
                    SHOW_DIRECTION, (*path, name), message, "write `listen:` with a port of this computer", key=True
                )
            self.arguments(route, link.routes[name].fields, (*path, name))

    def dmx(self, link: DmxLink) -> None:
        """Report errors in the DMX link's channels, fields and directions."""
        path, taken = (*SHOW_PATH, "dmx", "routes"), dict[int, NodePath]()
        for name, channels in link.routes.items():
            for field, channel in channels.items():
                where = (*path, name, field)
                if channel in taken:
                    related = [(taken[channel], "the first use is here")]
                    hint = "give each field its own channel"
                    self.report(SHOW_ADDRESS, where, f"channel {channel} is used twice", hint, related=related)
                taken.setdefault(channel, where)
        for name, route in self.routes(path, link.routes):
            if route.direction is Direction.IN:
                message = f"`{name}` is an incoming route, but DMX can only send"
                self.report(SHOW_DIRECTION, (*path, name), message, "choose a route with `direction: out`", key=True)
                continue
            for field in link.routes[name]:
                where, kinds = (*path, name, field), (FieldKind.NUMBER, FieldKind.INTEGER, FieldKind.BOOLEAN)
                found = self.field(
                    route, field, where, kinds, "a channel can hold only a number or a boolean", key=True
                )
                if found and found.kind is not FieldKind.BOOLEAN and not _ranged(found):
                    message = f"`{field}` has no range, so it can't be mapped to the values 0 to 255 of a channel"
                    hint = f"write `minimum` and `maximum` in schemas/messages/{route.schema}.schema.json"
                    self.report(SHOW_FIELD, where, message, hint, key=True)

    def routes(self, path: NodePath, names: Mapping[str, object]) -> Iterator[tuple[str, Route]]:
        """Yield the named routes that lumen.yaml has; report unknown names."""
        assert self.draft.settings
        for name in names:
            if known_route(self.draft, self.report, (*path, name), name, key=True):
                yield name, self.draft.settings.routes[name]

    def may_come(self, route: Route, path: NodePath) -> bool:
        """Return whether a route is outgoing, or open to messages from devices; report any other route."""
        if route.direction is Direction.OUT or may_come_from_devices(route):
            return True
        message = f"`{route.name}` has one of Lumen's own keys ({route.key}), on which devices may not send"
        hint = f"use a route with a key of your own, such as `museum.{route.name}`"
        self.report(SHOW_DIRECTION, path, message, hint, key=True)
        return False

    def twice(self, taken: dict[str, str], place: str, name: str, path: NodePath) -> None:
        """Report a topic or address that another route already uses."""
        if (other := taken.setdefault(place, name)) != name:
            message = f"`{other}` already uses `{place}`: the messages of the two routes would mix"
            self.report(SHOW_ADDRESS, path, message, "give each route its own topic or address")

    def arguments(self, route: Route, fields: tuple[str, ...] | None, path: NodePath) -> None:
        """Report errors in the fields that become arguments: `fields`, or all schema fields if `fields` is None."""
        known, kinds = self.fields(route), (FieldKind.STRING, FieldKind.NUMBER, FieldKind.INTEGER, FieldKind.BOOLEAN)
        can = "an argument can be only a text, a number or a boolean"
        if fields is None and not known:
            if self.has_schema(route):
                message = f"`{route.name}` has no schema with fields for the arguments"
                self.report(SHOW_FIELD, path, message, "write `fields: []` if there are no arguments", key=True)
            return
        for i, field in enumerate(known if fields is None else fields):
            where = path if fields is None else (*path, "fields", i)
            self.field(route, field, where, kinds, can, key=fields is None)

    def field(
        self,
        route: Route,
        name: str,
        path: NodePath,
        kinds: tuple[FieldKind, ...],
        can: str,
        *,
        key: bool = False,
    ) -> SchemaField | None:
        """Return the field if the schema has it and its kind is allowed; else report an error and return None.

        If the route's schema is unusable, only return None.
        """
        known = self.fields(route)
        if name not in known:
            if self.has_schema(route):
                hint = did_you_mean(name, known, "it has") if known else "give the route a `schema` with this field"
                self.report(SHOW_FIELD, path, f"`{route.name}` has no field `{name}`", hint, key=key)
            return None
        if known[name].kind not in kinds:
            hint = f"{can}: give the field such a `type` in schemas/messages/{route.schema}.schema.json"
            self.report(
                SHOW_FIELD, path, f"`{name}` of `{route.name}` has a type that can't be sent there", hint, key=key
            )
            return None
        return known[name]

    def fields(self, route: Route) -> Mapping[str, SchemaField]:
        """Return the fields of a route's schema, by name."""
        return message_fields(self.draft.messages.get(route.schema))

    def has_schema(self, route: Route) -> bool:
        """Return False if the route's schema is unusable, in which case a missing field is not the route's error."""
        return not route.schema or route.schema in self.draft.messages


def _value(report: DocumentReport, path: NodePath, name: str) -> NodePath:
    """Return the path of the value `name`, which may be written without its name in a short form."""
    long = (*path, name)
    return long if long in report.document.spans else path


def _ranged(field: SchemaField) -> bool:
    return field.low is not None and field.high is not None and field.low < field.high


def _topic_fault(topic: str) -> tuple[str, str] | None:
    if "+" in topic or "#" in topic:
        return f"`{topic}` contains a wildcard, but a message has one exact topic", "write the whole topic"
    if "\0" in topic or len(topic.encode("utf-8", "replace")) > MAX_TOPIC_BYTES:
        return "this topic is too long or contains a null character", "write a few words with `/` between them"
    if topic.startswith("$"):
        return f"`{topic}` begins with $, like the broker's own topics", "choose another first word"
    return None


def _address_fault(address: str) -> tuple[str, str] | None:
    if not address.startswith("/"):
        return f"`{address}` does not begin with /", f"write `/{address}`"
    if bad := [sign for sign in address if sign in _OSC_RESERVED or not 32 < ord(sign) < 127]:
        return f"an OSC address can't contain `{bad[0]}`", "write ASCII words with `/` between them"
    return None
