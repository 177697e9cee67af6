"""Find the routes that come with Lumen and that a project's behaviours use without rows of their own."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

from lumen.language.actions import PublishBody, Raise, Send, nested
from lumen.language.built_in_routes import BUILT_IN_ROUTES
from lumen.language.controller_events import controller_events
from lumen.language.controllers import ControllerDefinition
from lumen.language.diagnostics import NodePath
from lumen.language.machines import MachineDefinition
from lumen.language.routes import Route, RouteUse
from lumen.project.memoization import Same, memoize
from lumen.project.settings import Settings


class _Uses(NamedTuple):
    """The events and routes that a behaviour uses."""

    heard: Mapping[str, NodePath]
    """The first place of each event for which the behaviour has a transition."""
    published: Mapping[str, NodePath]
    """The first place of each route to which the behaviour publishes."""
    made: frozenset[str]
    """The events that the behaviour declares, raises or sends, and those of its buttons."""


def used_routes(
    settings: Settings,
    behaviors: Mapping[str, MachineDefinition],
    controllers: Iterable[ControllerDefinition],
    lost: Collection[str],
) -> dict[str, Route]:
    """Return the routes that come with Lumen and apply to this project, each with the places that use it.

    A route applies if a behaviour hears its event, by name and not by `*`, or publishes to it. The project's own
    declarations have priority: a row of the same name, key, alias or event, a row that is `null`, and an event of the
    same name that its behaviours declare, raise or send, or that its buttons or controllers raise. `lost` are names in
    broken rows of lumen.yaml.
    """
    used = {f"behaviors/{name}.yaml": _uses(machine) for name, machine in behaviors.items()}
    rows = settings.routes.values()
    made = {row.event for row in rows if row.event}.union(*(each.made for each in used.values()))
    made |= controller_events(controllers).keys()
    keys = {key for row in rows for key in (row.key_for(settings.robot), row.alias) if key}
    named, found = {*settings.routes, *settings.removed_routes, *lost}, {}
    for name, route in BUILT_IN_ROUTES.items():
        if name in named or route.event in made or not keys.isdisjoint((route.key_for(settings.robot), route.alias)):
            continue
        if uses := tuple(use for file, each in used.items() for use in _uses_of(route, file, each)):
            found[name] = replace(route, uses=uses)
    return found


def _uses_of(route: Route, file: str, used: _Uses) -> Iterator[RouteUse]:
    if route.event in used.heard:
        yield RouteUse(file, used.heard[route.event], "hears")
    if route.name in used.published:
        yield RouteUse(file, used.published[route.name], "publishes to")


def _uses(machine: MachineDefinition) -> _Uses:
    return memoize(("route uses", machine.id), Same(machine), lambda: _read(machine))


def _read(machine: MachineDefinition) -> _Uses:
    heard, published, made = dict[str, NodePath](), dict[str, NodePath](), {*machine.events}
    for state in machine.states.values():
        made.update(button.event for button in state.buttons)
        blocks = [state.entry, state.do, state.exit]
        for transition in state.transitions:
            blocks.append(transition.actions)
            if transition.event and not transition.exact:
                heard.setdefault(transition.event.removesuffix(".*"), transition.where)
        for step in (step for block in blocks for step in nested(block)):
            match step.action:
                case PublishBody(route):
                    published.setdefault(route, (*step.where, "publish"))
                case Raise(event=event) | Send(event=event):
                    made.add(event)
    return _Uses(heard, published, frozenset(made))
