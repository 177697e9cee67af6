"""Checks the route table: keys, schemas and events."""

from collections.abc import Collection, Iterator, Mapping

from lumen.language.addresses import credentials_of, unescaped
from lumen.language.built_in_routes import BUILT_IN_ROUTES
from lumen.language.commands import Track
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, did_you_mean, has_errors
from lumen.language.routes import (
    COMMAND,
    FLOATS_TYPE,
    HEARD,
    IMAGE,
    JOINT,
    JPEG_TYPE,
    LONGEST_COMMAND_TTL,
    SHORTEST_IMAGE_INTERVAL,
    Carried,
    Direction,
    Route,
    route_meanings,
)
from lumen.language.routing_keys import DEFAULT_ALIASES, DEFAULT_KEYS
from lumen.lint.events import descriptors, hears
from lumen.lint.lookups import References
from lumen.lint.references import UNKNOWN_ROUTE, WRONG_DIRECTION
from lumen.lint.routing_keys import check_key
from lumen.lint.walk import action_sites
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

DUPLICATE_ROUTE = Code("duplicate-route", "routes", ERROR, "two routes carry the same key to the same event")
MISSING_ROUTE = Code("missing-route", "routes", WARNING, "a behaviour needs a route that is missing")
NO_TTL = Code("no-ttl", "routes", WARNING, "a command that arrives late is still performed")
LONG_TTL = Code("long-ttl", "routes", WARNING, "a command may arrive so late that it is no longer wanted")
LOSSY_JOURNAL = Code("lossy-journal", "routes", ERROR, "a route that must not lose messages is set to drop them")
BEYOND_CAMERA = Code("beyond-camera", "routes", ERROR, "a route requests images that the robot's camera can't take")
PASSWORD_IN_FILE = Code("password-in-file", "routes", ERROR, "a password or a PIN is in a file of the project")
WRONG_FORM = Code("wrong-form", "routes", ERROR, "a route has a `content_type` that its messages can't have")
UNUSED_ROUTE = Code("unused-route", "routes", WARNING, "the messages of a route become an event that nothing waits for")

_FORMED = {JPEG_TYPE: IMAGE, FLOATS_TYPE: JOINT}


def check(draft: ProjectDraft) -> None:
    """Report faults of the rows in the route table, and missing rows."""
    settings, report = draft.settings, draft.main
    if settings is None or report is None:
        return
    _password(settings.bus, report)
    references = References(draft)
    events: dict[tuple[str, str], str] = {}
    _removed(settings.removed_routes, report)
    for name, route in settings.routes.items():
        if route.built_in or not check_key(report, route, settings):
            continue
        _ways(draft, report, route)
        _carried(report, route)
        _pictures(report, route)
        if route.schema:
            references.look_up(report, (*route.where, "schema"), "message", route.schema)
        if route.event:
            _event(draft, report, route)
            keys = (key for key in (route.key_for(settings.robot), route.alias) if key)
            other = next((o for key in keys if (o := events.setdefault((key, route.event), name)) != name), name)
            if other != name:
                message = f"`{other}` has the same key and becomes the same event"
                related = [((*settings.routes[other].where, "key"), "the other one is here")]
                report(DUPLICATE_ROUTE, (*route.where, "key"), message, "delete one of them", related=related)
    _missing(draft, settings.routes, report)


def _removed(names: Collection[str], report: DocumentReport) -> None:
    """Report rows that are null although no route of that name comes with Lumen."""
    for name in names:
        if name not in BUILT_IN_ROUTES:
            message = f"`null` can remove only a route that comes with Lumen, and `{name}` is not one"
            hint = (
                f"{did_you_mean(name, BUILT_IN_ROUTES, 'available:')}; for your own route, write `key` and `direction`"
            )
            report(UNKNOWN_ROUTE, ("routes", name), message, hint)


def _password(bus: str, report: DocumentReport) -> None:
    """Report the broker's credentials in lumen.yaml, because a project can be copied, mailed or published."""
    if credentials_of(bus):
        message = "a user name and a password are in a file that others can read"
        hint = "put them into the environment variable LUMEN_BUS, or into a file that LUMEN_BUS_CREDENTIALS names"
        if signs := unescaped(bus):
            hint += f"; in LUMEN_BUS write {signs}"
        report(PASSWORD_IN_FILE, ("bus",), message, hint)


def _carried(report: DocumentReport, route: Route) -> None:
    """Report a time to live that is too long for a command or a stop, and limits that let a journal drop messages."""
    where = route.where
    if route.carried in (Carried.COMMAND, Carried.STOP) and (route.ttl or 0.0) > LONGEST_COMMAND_TTL:
        message = f"a {route.carried} may be performed {route.ttl:g} s late, when it is no longer wanted"
        report(
            LONG_TTL,
            (*where, "ttl"),
            message,
            f"write 2s to {LONGEST_COMMAND_TTL:g}s, long enough for a short failure of the broker",
        )
    if route.carried is Carried.JOURNAL:
        for key, value in (("ttl", route.ttl), ("keep", route.keep), ("most", route.most)):
            if value is not None:
                message = f"a journal must keep every message, but `{key}` drops messages"
                report(LOSSY_JOURNAL, (*where, key), message, f"delete `{key}`, or `carried: journal`", key=True)


def _pictures(report: DocumentReport, route: Route) -> None:
    """Report sizes, rates and content types that the route's sense can't have.

    Only a camera has a size, and a limited rate; each content type belongs to either images or joints.
    """
    if (of := _FORMED.get(route.content_type)) and route.sense != of:
        message = f"`{route.content_type}` is for the sense `{of}`, but this route carries `{route.sense}`"
        hint = f"write `of: {of}` beside it, or delete `content_type`"
        report(WRONG_FORM, (*route.where, "content_type"), message, hint)
    if route.size and route.sense != IMAGE:
        message = f"`{route.name}` can't have a `size`: only the images of the route `{IMAGE}` can"
        report(BEYOND_CAMERA, (*route.where, "size"), message, "delete `size`", key=True)
    if route.sense == IMAGE and route.every and route.every < SHORTEST_IMAGE_INTERVAL:
        message = f"an image every {1000 * route.every:g} ms is too often: the camera takes 30 images per second"
        hint = f"write {1000 * SHORTEST_IMAGE_INTERVAL:g}ms or more"
        report(BEYOND_CAMERA, (*route.where, "every"), message, hint)


def _missing(draft: ProjectDraft, routes: Mapping[str, Route], report: DocumentReport) -> None:
    """Report routes that a behaviour needs without naming them: `joint` for `track`, and `heard` for its event."""
    if has_errors(draft.diagnostics):
        return
    for behavior, machine in draft.behaviors.items():
        tracks = any(_moves_joints(draft, site.step.action) for site in action_sites(machine))
        waits = any(d != "*" and hears(d, HEARD) for d in descriptors(machine))
        for name, needed, what in ((JOINT, tracks, "uses `track`"), (HEARD, waits, "waits for `heard`")):
            if needed and name not in routes and name not in report.lost:
                message = f"`{behavior}` {what}, but there is no route `{name}`: {route_meanings()[name]}"
                hint, cause = f"write a row `{name}:`", f"name {name}"
                where: NodePath = ("routes",)
                if meant := next((r for r in routes.values() if name in (r.event, *_meant(r))), None):
                    hint, where = f"rename this row to `{name}`: it has the key of that route", meant.where
                report(MISSING_ROUTE, where, message, hint, key=True, cause=cause)


def _meant(route: Route) -> Iterator[str]:
    """Yield the names of Lumen's own routes that have the same key as a route."""
    return (name for keys in (DEFAULT_KEYS, DEFAULT_ALIASES) for name, key in keys.items() if key == route.key)


def _moves_joints(draft: ProjectDraft, action: object) -> bool:
    """Return whether an action switches a controller of joints on or off; True if the controller is unknown."""
    controller = draft.controllers.get(action.controller) if isinstance(action, Track) else None
    return isinstance(action, Track) and not (controller and controller.signals and not controller.output_bindings)


def _ways(draft: ProjectDraft, report: DocumentReport, route: Route) -> None:
    """Report an outgoing route with an event, and an incoming command route without a time limit.

    A command that is performed late is worse than a lost command.
    """
    if route.direction is Direction.OUT and route.event:
        message = f"messages on this route go out, so they can't become the event `{route.event}`"
        report(WRONG_DIRECTION, (*route.where, "event"), message, "write `direction: in`")
    if route.direction is Direction.IN and route.name == COMMAND and route.ttl is None and "ttl" not in report.lost:
        message = "a command that waited for a long time is still performed"
        report(NO_TTL, route.where, message, "write how long it is valid, such as `ttl: 2s`", key=True)


def _event(draft: ProjectDraft, report: DocumentReport, route: Route) -> None:
    """Report an incoming route whose event no behaviour waits for, and from which no controller reads."""
    if route.direction is Direction.OUT or not draft.behaviors or has_errors(draft.diagnostics):
        return
    if route == BUILT_IN_ROUTES.get(route.name):
        return  # `lumen new` writes this row, and without the row the route would not exist
    bound = {b.route for c in draft.controllers.values() for b in c.input_bindings}
    if route.name not in bound and not any(
        hears(d, route.event) for m in draft.behaviors.values() for d in descriptors(m)
    ):
        message = f"no behaviour waits for `{route.event}`, the event of this route"
        report(UNUSED_ROUTE, (*route.where, "event"), message, f"handle it with `on: {{{route.event}: …}}`")
