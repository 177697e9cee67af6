"""Proposed changes: edits of an event or of a context, which are proved by taking a step."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.insight.explaining.words import prefix_of
from lumen.language.events import Event
from lumen.language.json_paths import with_value
from lumen.statechart.values import Invoked, Snapshot

ProposedChange = Mapping[str, Any]
"""New values by their names in expressions: `event.data.result`, `context.tries`, or `quiz/context.tries` in `quiz`.

Three names are special: `event` is the name of an event that must come, `state` is the name of a state that must be
active, and `wait` is the time for which nothing else can happen [s].
"""


class StepSituation(NamedTuple):
    """The start of a step that is tried: the snapshot and the event."""

    snapshot: Snapshot
    event: Event | None
    owner: str = ""
    """The ids of the behaviour whose context is edited; empty for the outermost."""

    def edited(self, change: ProposedChange) -> "StepSituation":
        """Return the situation with these edits; a new `event` has only the data in the change."""
        snapshot, event = self.snapshot, self.event
        if "event" in change:
            event = Event(change["event"], None, snapshot.at)
        for name, value in change.items():
            way = name.removeprefix(prefix_of(self.owner)).split(".")
            if way[0] == "context":
                snapshot = _remembering(snapshot, self.owner, way[1:], value)
            elif way[:2] == ["event", "data"] and event is not None:
                event = event._replace(data=with_value(event.data, way[2:], value))
        return self._replace(snapshot=snapshot, event=event)


def _remembering(snapshot: Snapshot, owner: str, way: list[str], value: Any) -> Snapshot:
    if not owner:
        return snapshot._replace(context=with_value(snapshot.context, way, value))
    rest, _, id = owner.rpartition("@")
    child = snapshot.invoked[id]
    inner = Invoked(child.state, _remembering(child.snapshot, rest, way, value), child.commands)
    return snapshot._replace(invoked={**snapshot.invoked, id: inner})
