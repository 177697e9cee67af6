"""Lumen's names for the events and actors of an XState file."""

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from lumen.features.formats_charts.xstate.descriptors import invoke_id, own_event
from lumen.features.formats_charts.xstate.state_tree import XStateStateTree
from lumen.language.diagnostics import NodePath
from lumen.project.formats.unused_names import unused_name

_BLANKS = re.compile(r"\s+")
_SENDERS = ("xstate.raise", "xstate.send", "xstate.sendTo")


class XStateNames:
    """Maps the names in an XState file to Lumen's: different names stay different in the whole behaviour."""

    def __init__(self, outline: XStateStateTree) -> None:
        self.outline = outline
        self.events = self._free("event", {n: w for n, w in _events((), outline.source.data) if not own_event(n)})
        self.actors = self._free("actor", dict(_actors((), outline.source.data)))

    def event(self, name: str) -> str:
        """Return Lumen's name for an event or a descriptor, both XState's own and the author's."""
        if own := own_event(name):
            family, id = own
            if "*" in id:
                return f"{family}{id}"
            return f"{family}{self._state(id) if family == 'done.state.' else self.actor(id)}"
        return self.events.get(name) or _BLANKS.sub("_", name.strip())

    def actor(self, id: str) -> str:
        """Return Lumen's id for an actor."""
        return self.actors.get(id) or invoke_id(id)

    def _state(self, id: str) -> str:
        """Return Lumen's name for the state with this id; if there is none, the id in a valid form."""
        found = self.outline.resolve(self.outline.root, f"#{id}")
        return (found.name or self.outline.title) if found else invoke_id(id)

    def _free(self, kind: str, names: Mapping[str, NodePath]) -> dict[str, str]:
        """Map each name to a unique one that is valid in a behaviour; report names that change."""
        cleaned: Callable[[str], str] = invoke_id if kind == "actor" else lambda name: _BLANKS.sub("_", name.strip())
        found = {name: name for name in names if cleaned(name) == name}
        taken = set(found)
        for name, where in names.items():
            if name not in found:
                found[name] = unused_name(cleaned(name), taken.__contains__, len(names))
                taken.add(found[name])
                message = f"the {kind} `{name}` is renamed to `{found[name]}` in the whole behaviour"
                self.outline.findings.changed(self.outline.source.place(where), message)
        return found


def _events(where: NodePath, data: Any) -> Iterator[tuple[str, NodePath]]:
    """Yield the name and place of each event that is awaited or sent."""
    if isinstance(data, list):
        for number, item in enumerate(data):
            yield from _events((*where, number), item)
    if not isinstance(data, dict):
        return
    if data.get("type") in _SENDERS:
        body = data if "event" in data else data.get("params")
        event = body.get("event") if isinstance(body, dict) else None
        name = event.get("type") if isinstance(event, dict) else event
        if isinstance(name, str) and name:
            yield name, where
    for key, value in data.items():
        if key == "states" and isinstance(value, dict):
            for name, state in value.items():
                yield from _events((*where, key, name), state)
            continue
        if key == "on":
            rows = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
            for at, row in rows:
                name = at if isinstance(at, str) else row.get("event") if isinstance(row, dict) else None
                if isinstance(name, str) and name and "*" not in name:
                    yield name, (*where, key, at)
                yield from _events((*where, key, at), row)
        elif key not in ("context", "meta"):
            yield from _events((*where, key), value)


def _actors(where: NodePath, state: Any) -> Iterator[tuple[str, NodePath]]:
    """Yield the id and place of each actor that a state or an inner state invokes by id."""
    if not isinstance(state, dict):
        return
    data = state.get("invoke")
    for number, row in enumerate(data) if isinstance(data, list) else ((None, data),):
        id = row.get("id") if isinstance(row, dict) else None
        if isinstance(id, str) and id:
            yield id, (*where, "invoke", *(() if number is None else (number,)), "id")
    states = state.get("states")
    for name, child in states.items() if isinstance(states, dict) else ():
        yield from _actors((*where, "states", name), child)
