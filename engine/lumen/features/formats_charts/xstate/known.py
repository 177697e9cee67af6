"""The parts of XState's machine configurations, versions 5 and 4, that the importer recognizes."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from lumen.project.formats.known import FormatTable, Known

_NOTE = {"description": "a note for readers"}
_STATE_NOTES = {"key": "the key under `states` is used", "order": "the order of the file is used"}
_TYPES = "JSON contains no types"
_OF_STATE = frozenset(
    ("id", "type", "initial", "states", "on", "always", "after", "entry", "exit", "onDone", "invoke", "parallel",
     "description", "tags", "meta", "output", "data")
)  # fmt: skip
_OLD = {
    "activities": "write `invoke`",
    "onEntry": "write `entry`",
    "onExit": "write `exit`",
    "history": "only a state of `type: history` can have it",
    "target": "only a state of `type: history` can have it",
}

KNOWN: FormatTable = {
    "machine": Known(
        _OF_STATE | {"context", "key"},
        _OLD
        | {
            "input": "a behaviour receives its input in its context",
            "delimiter": "Lumen separates paths by dots",
            "strict": "in Lumen, an unexpected event is not an error",
        },
        {
            "$schema": "only for editors", "version": "it does not change the behaviour", "schema": _TYPES,
            "schemas": _TYPES, "types": _TYPES, "tsTypes": _TYPES, "predictableActionArguments": "always true",
            "preserveActionOrder": "always true", "order": "the order of the file is used",
        },
    ),
    "state": Known(_OF_STATE, _OLD, _STATE_NOTES),
    "parallel state": Known(_OF_STATE - {"initial"}, _OLD | {"initial": "it enters all of its states"}, _STATE_NOTES),
    "final state": Known(
        frozenset(("id", "type", "entry", "exit", "output", "data", "tags", "meta", "description", "states")),
        dict.fromkeys(("on", "always", "after", "invoke", "onDone"), "nothing follows a final state")
        | dict.fromkeys(("initial", "parallel"), "a final state has no inner states"),
        _STATE_NOTES,
    ),
    "history state": Known(
        frozenset(("id", "type", "history", "target", "tags", "meta", "description")),
        {"states": "a history has no inner states"},
        _STATE_NOTES,
    ),
    "initial": Known(frozenset(("target", "actions")), meaningless=_NOTE),
    "transition": Known(
        frozenset(("target", "guard", "cond", "in", "actions", "reenter", "internal", "meta")), meaningless=_NOTE
    ),
    "transition in a list of `on`": Known(
        frozenset(("event", "target", "guard", "cond", "in", "actions", "reenter", "internal", "meta")),
        meaningless=_NOTE,
    ),
    "transition in a list of `after`": Known(
        frozenset(("delay", "target", "guard", "cond", "in", "actions", "reenter", "internal", "meta")),
        meaningless=_NOTE,
    ),
    "invoke": Known(
        frozenset(("id", "src", "input", "onDone", "onError", "onSnapshot")),
        {
            "data": "write `input`",
            "autoForward": "a behaviour always receives all events from outside",
            "systemId": "an actor is identified by its `id`",
        },
        {**_NOTE, "type": "Lumen has one kind of actor", "meta": "notes for other tools"},
    ),
    "action": Known(frozenset(("type", "params")), {"exec": "its code is not in the file"}),
    "xstate.raise": Known(frozenset(("type", "event", "delay", "id", "params"))),
    "xstate.send": Known(frozenset(("type", "event", "delay", "id", "to", "params"))),
    "xstate.cancel": Known(frozenset(("type", "sendId", "params"))),
    "xstate.log": Known(frozenset(("type", "label", "expr", "params"))),
    "xstate.assign": Known(frozenset(("type", "assignment", "params"))),
    "guard": Known(frozenset(("type", "params"))),
    "meta.lumen": Known(
        frozenset(("types", "events", "phrases", "answers", "lists", "properties", "renamed", "onReload", "resume",
                   "buttons", "output", "invoke"))
    ),
}  # fmt: skip
"""The keys of each kind of object that are read, lost or meaningless."""

STATE_KINDS = ("atomic", "compound", "parallel", "final", "history")
BOOLEANS = frozenset(("reenter", "internal", "parallel"))
"""Keys whose values are booleans."""

_VERSION_4 = frozenset(
    ("cond", "in", "schema", "tsTypes", "predictableActionArguments", "preserveActionOrder", "strict", "delimiter",
     "activities", "internal", "autoForward", "onEntry", "onExit")
)  # fmt: skip
_VERSION_5 = frozenset(("guard", "reenter", "input", "output", "onSnapshot", "systemId"))
_EVENTS_OF_4 = ("done.invoke.", "error.platform.", "done.state.")
_OBJECTS_OF_AUTHORS = frozenset(("context", "meta", "params", "input", "data", "output", "event", "assignment"))


def losses(place: str, names: Iterable[str]) -> Iterator[tuple[str, str, str]]:
    """Yield each name that is not converted, with a message and a hint; `place` is the object's kind in KNOWN."""
    known, whose = KNOWN[place], f"of {'an' if place[0] in 'aeix' else 'a'} {place}"
    for name, hint in known.losses(names):
        if name in known.lost:
            yield name, f"`{name}` {whose}: {hint}", ""
        else:
            yield name, f"`{name}` {whose} has no counterpart in Lumen", hint


def is_version_4(machine: Mapping[str, Any]) -> bool:
    """Return whether a machine uses features of version 4, and none that only version 5 or Lumen has."""
    old = False
    waiting: list[tuple[str, Any]] = [("", machine)]
    while waiting:
        within, item = waiting.pop()
        named = within in ("states", "on", "after")  # objects whose keys the author chose
        children = item.items() if isinstance(item, dict) else enumerate(item) if isinstance(item, list) else ()
        for key, value in children:
            word = key if isinstance(key, str) and not named else ""
            if word in _VERSION_5 or (word == "type" and str(value).startswith(("xstate.sendTo", "lumen."))):
                return False
            if word == "meta" and isinstance(value, dict) and "lumen" in value:
                return False
            old |= word in _VERSION_4 or (word, value) in (("parallel", True), ("type", "xstate.send"))
            old |= word in ("on", "after") and isinstance(value, list)
            old |= within == "on" and isinstance(key, str) and (key == "" or key.startswith(_EVENTS_OF_4))
            if word not in _OBJECTS_OF_AUTHORS and isinstance(value, dict | list):
                waiting.append((word, value))
    return old
