"""Reads XState's invocations that Lumen wrote, and the transitions at the end of any others."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from lumen.features.formats_charts.xstate.action_reader import DO_ACTOR, XStateActionReader, shown_name
from lumen.features.formats_charts.xstate.constants import constant_data
from lumen.features.formats_charts.xstate.known import losses
from lumen.features.formats_charts.xstate.state_tree import XStateNode
from lumen.features.formats_charts.xstate.transition_reader import XStateTransitionReader
from lumen.language.diagnostics import NodePath
from lumen.project.formats.behavior_data import TransitionData, single

_ENDS = {"onDone": "done.invoke", "onError": "error.invoke"}


class ActorEnds(NamedTuple):
    """The converted invocations of a state."""

    data: dict[str, Any]
    """`do`, `invoke`, and the transitions at their end."""
    waits: dict[str, list[TransitionData]]
    """The transitions at the end of actors that can't be converted, by their descriptors in `on`."""


class XStateInvokeReader:
    """Reads the invocations of one file."""

    def __init__(self, parts: XStateActionReader, transitions: XStateTransitionReader) -> None:
        self.parts, self.transitions = parts, transitions

    def of(self, state: XStateNode, own: Mapping[str, Any]) -> ActorEnds:
        """Convert a state's invocations; `own` is Lumen's part of the state's `meta`."""
        data: dict[str, Any] = {}
        invokes: list[dict[str, Any]] = []
        waits: dict[str, list[TransitionData]] = {}
        for number, where, row in self._rows(state):
            for key, message, hint in losses("invoke", row):
                self.parts.lost((*where, key), message, hint)
            if not isinstance(row.get("id", ""), str):
                self.parts.lost((*where, "id"), "`id` is not a string", "put it in quotes")
            if invoked := self._invoked(own, where, row):
                invokes.append({**invoked, **self._ends(state, where, row)})
            elif (steps := self._steps(row)) is not None and "do" not in data:
                data["do"] = steps
                data.update(self._ends(state, where, row))
            else:
                self._wait(state, number, where, row, waits)
        return ActorEnds(data | ({"invoke": single(invokes)} if invokes else {}), waits)

    def _wait(
        self,
        state: XStateNode,
        number: int,
        where: NodePath,
        row: Mapping[str, Any],
        waits: dict[str, list[TransitionData]],
    ) -> None:
        """Report an actor without code, and add the transitions at its end to `waits`."""
        given = row.get("id")
        id = self.parts.names.actor(given if isinstance(given, str) and given else f"{number}.{state.foreign_id}")
        for key, family in _ENDS.items():
            if key in row:
                waits.setdefault(f"{family}.{id}", []).extend(self.transitions.under(state, (*where, key), row[key]))
        source = row.get("src")
        named = source.get("type") if isinstance(source, dict) else source
        shown = f" of `{shown_name(named, source)}`" if isinstance(named, str) else ""
        hint = f"invoke a behaviour with the id `{id}`" + (": transitions wait for its end" if waits else "")
        self.parts.lost(where, f"`invoke`{shown}: its code is not in the file", hint)
        if "onSnapshot" in row:
            self.parts.lost((*where, "onSnapshot"), "`onSnapshot`: a behaviour reports only its end")
        if "input" in row:
            self.parts.lost(
                (*where, "input"), "`input` of the `invoke` is left out", "write it into the `invoke` of the behaviour"
            )

    def _ends(self, state: XStateNode, where: NodePath, row: Mapping[str, Any]) -> dict[str, Any]:
        """Return `onDone` and `onError` of an invocation that Lumen wrote, if they have transitions."""
        found = {key: self.transitions.under(state, (*where, key), row[key]) for key in _ENDS if key in row}
        return {key: single(rows) for key, rows in found.items() if rows}

    def _steps(self, row: Mapping[str, Any]) -> list[Any] | None:
        given = row.get("input")
        return self.parts.do(given.get("steps")) if row.get("src") == DO_ACTOR and isinstance(given, dict) else None

    def _invoked(self, own: Mapping[str, Any], where: NodePath, row: Mapping[str, Any]) -> dict[str, Any] | None:
        """Return the `invoke` row that Lumen wrote as an actor; None for any other actor or an invalid row."""
        inputs, id, behavior = own.get("invoke"), row.get("id"), row.get("src")
        if not isinstance(inputs, dict) or id not in inputs or not isinstance(behavior, str):
            return None
        data = {"behavior": behavior} | ({"id": id} if id != behavior else {})
        data |= {"input": inputs[id]} if inputs[id] else {}
        if not self.parts.fits({"invoke": data}):
            return None
        if row.get("input", {}) != constant_data(inputs[id] or {}):
            message = "`input` differs from `meta.lumen.invoke`, which is used"
            self.parts.changed((*where, "input") if "input" in row else where, message, "make both equal")
        return data

    def _rows(self, state: XStateNode) -> Iterator[tuple[int, NodePath, Mapping[str, Any]]]:
        """Yield the number, place and object of each item of `invoke`; report invalid items.

        An item that is only a name (XState 4) becomes an object with that name as its `src`.
        """
        data, where = state.source.get("invoke"), (*state.where, "invoke")
        rows = [((*where, i), row) for i, row in enumerate(data)] if isinstance(data, list) else [(where, data)]
        for number, (place, row) in enumerate(rows):
            if isinstance(row, dict):
                yield number, place, row
            elif isinstance(row, str):
                yield number, place, {"src": row}
            elif row is not None or isinstance(data, list):
                self.parts.lost(place, "this is not an invocation")
