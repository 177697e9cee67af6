"""Routing keys: their form, and clashes with Lumen's own keys."""

import re
from collections.abc import Mapping
from difflib import get_close_matches

from lumen.language.diagnostics import ERROR, WARNING, Code
from lumen.language.routes import Direction, Route, route_meanings
from lumen.language.routing_keys import DEFAULT_ALIASES, DEFAULT_KEYS, INTERNAL_KEYS, KEY_PREFIXES, SHARED_ROUTES
from lumen.project.document_report import DocumentReport
from lumen.project.settings import Settings

ROUTE_KEY = Code("route-key", "routes", ERROR, "a routing key has an invalid form")
TAKEN_KEY = Code("taken-key", "routes", ERROR, "a route sends with a key that Lumen itself uses for something else")
SHARED_KEY = Code("shared-key", "routes", WARNING, "robots that share a bus use the same key")
NEAR_KEY = Code("near-key", "routes", WARNING, "a routing key is almost the same as one of Lumen's own")

MAX_ROUTING_KEY_BYTES = 255
"""The length limit of a routing key (AMQP 0-9-1, 3.1.1: a short string)."""
NEAR = 0.8
"""The least similarity (difflib's ratio) at which a key's first word counts as a misspelt prefix of Lumen."""

_WORD = re.compile(r"[^\s.*#{}]+|\{robot\}")


def check_key(report: DocumentReport, route: Route, settings: Settings) -> bool:
    """Return whether a route's key is valid and not one of Lumen's own; report faults, near misses and shared keys."""
    path = (*route.where, "key")
    for key, name in ((route.key, "key"), (route.alias, "alias")):
        message, hint = _fault(key) if key or name == "key" else ("", "")
        if message:
            report(ROUTE_KEY, (*route.where, name), message, hint)
            return False
    _shared(report, route, settings)
    if route.direction is Direction.OUT and _taken(report, route, settings):
        return False
    first = route.key.split(".")[0]
    near = get_close_matches(first.lower(), KEY_PREFIXES, n=1, cutoff=NEAR)
    if first not in KEY_PREFIXES and near:
        message = f"`{route.key}` begins with `{first}`, which is almost a prefix of Lumen's own keys"
        report(NEAR_KEY, path, message, f"did you mean `{near[0]}`? Otherwise choose another first word")
    return True


def _fault(key: str) -> tuple[str, str]:
    words = key.split(".")
    if "*" in key or "#" in key:
        return f"`{key}` contains a wildcard, but a message has one exact key", "write the whole key"
    if key != key.strip() or any(not word for word in words):
        return f"`{key}` has an empty word", "write words with single dots between them"
    if " " in key:
        return f"`{key}` contains a space", f"write dots between its words: {'.'.join(key.replace('.', ' ').split())}"
    if "{stand}" in words:
        return (
            "`{stand}` is the name of a stand, but no robot has a stand",
            "write `stand:` beside the `name:` of `robot:`",
        )
    if bad := [word for word in words if not _WORD.fullmatch(word)]:
        return (
            f"`{bad[0]}` can't be a word of a routing key",
            "write a word without braces, or the whole word `{robot}` for the robot's name",
        )
    if len(key.encode("utf-8", "replace")) > MAX_ROUTING_KEY_BYTES:
        return f"the key is longer than {MAX_ROUTING_KEY_BYTES} bytes", "shorten it"
    return "", ""


def _taken(report: DocumentReport, route: Route, settings: Settings) -> bool:
    """Return whether Lumen itself uses that key for something else; if it does, report the route."""
    key = route.key_for(settings.robot)
    owner = _owners(settings).get(key, route.name)
    message, cause = f"`{key}` is the key of Lumen's own route `{owner}`", f"name {owner}"
    if key in INTERNAL_KEYS:
        message, cause = f"`{key}` is one of Lumen's own keys, which no route can have", f"key {key}"
    elif owner == route.name:
        return False
    hint = f"choose a key of your own, such as `museum.{route.name}`"
    if owner in route_meanings() and owner not in settings.routes and owner != route.name:
        hint = f"name the route `{owner}`, or {hint}"
    report(TAKEN_KEY, (*route.where, "key"), message, hint, cause=cause)
    return True


def _owners(settings: Settings) -> Mapping[str, str]:
    """Return the names of the routes that only Lumen uses, by their keys in this exhibition."""
    own = {name: key for name, key in DEFAULT_KEYS.items() if name not in SHARED_ROUTES}
    keys = {name: settings.routes[name].key if name in settings.routes else key for name, key in own.items()}
    aliases = {alias: name for name, alias in DEFAULT_ALIASES.items() if name in own and name not in settings.routes}
    return aliases | {key.replace("{robot}", settings.robot): name for name, key in keys.items()}


def _shared(report: DocumentReport, route: Route, settings: Settings) -> None:
    """Report a key without `{robot}` if robots share a broker, because a message's key must then name its robot."""
    ours = route.name in DEFAULT_KEYS
    if settings.aliases is not False or "{robot}" in route.key or not (ours or route.event):
        return
    what = f"become `{route.event}` for all of them" if route.event else "belong to no particular robot"
    told = "" if settings.told_apart else " (`aliases: false`)"
    message = f"several robots share the bus{told}: messages on `{route.key}` {what}"
    hint = f"write {DEFAULT_KEYS[route.name] if ours else _with_robot(route.key)}"
    report(SHARED_KEY, (*route.where, "key"), message, hint)


def _with_robot(key: str) -> str:
    first, *rest = key.split(".")
    return ".".join((first, "{robot}", *rest))
