"""Reads XState's transitions as Lumen's."""

from typing import Any

from lumen.features.formats_charts.xstate.action_reader import HEARS_GUARD, XStateActionReader
from lumen.features.formats_charts.xstate.known import BOOLEANS, losses
from lumen.features.formats_charts.xstate.state_tree import XStateNode, XStateStateTree
from lumen.language.diagnostics import NodePath
from lumen.project.formats.behavior_data import TransitionData
from lumen.project.transitions import rivals


class XStateTransitionReader:
    """Reads the transitions of one file."""

    def __init__(self, outline: XStateStateTree, parts: XStateActionReader, version_4: bool) -> None:
        self.outline, self.parts, self.version_4 = outline, parts, version_4

    def rows(self, state: XStateNode, key: str) -> list[TransitionData]:
        """Return the transitions under one of the state's keys."""
        return self.under(state, (*state.where, key), state.source[key], eventless=key == "always")

    def under(
        self, state: XStateNode, where: NodePath, data: Any, *, eventless: bool = False, heard: bool = False
    ) -> list[TransitionData]:
        """Convert a target, an object or a list of these to transitions; report and leave out invalid ones.

        An `eventless` transition without a guard and a target is invalid. With `heard`, a row of `hears` has its key as
        `hears`.
        """
        rows = [((*where, i), row) for i, row in enumerate(data)] if isinstance(data, list) else [(where, data)]
        found = [self._row(state, place, {} if row is None else row, heard) for place, row in rows]
        kept = [row for row in found if row is not None]
        if eventless and any("target" not in row and "guard" not in row for row in kept):
            self.parts.lost(
                where, "a transition without event, guard and target is left out: it would repeat without end"
            )
            kept = [row for row in kept if "target" in row or "guard" in row]
        return kept

    def _row(self, state: XStateNode, where: NodePath, data: Any, may_hear: bool) -> TransitionData | None:
        if isinstance(data, str):
            data = {"target": data}
        if not isinstance(data, dict):
            self.parts.lost(where, "this is not a transition")
            return None
        for key, message, hint in losses("transition", data):
            self.parts.lost((*where, key), message, hint)
        for key in BOOLEANS & data.keys():
            if not isinstance(data[key], bool):
                self.parts.lost((*where, key), f"`{key}` can't be `{data[key]}`", "write true or false")
        if data.get("guard") is not None and data.get("cond") is not None:
            self.parts.lost((*where, "cond"), "`cond` beside `guard` is left out", "delete one of them")
        if "meta" in data:
            self.parts.changed((*where, "meta"), "`meta` is not carried over")
        row: TransitionData = {}
        guard = data["guard"] if data.get("guard") is not None else data.get("cond")
        if may_hear and isinstance(guard, dict) and guard.get("type") == HEARS_GUARD:
            heard = self.parts.heard(guard, (*where, "guard"))
            if heard is None:
                return None
            row.update(heard)
        elif guard is not None:
            source = self.parts.guard(guard, (*where, "guard"))
            if source is None:
                return None
            row["guard"] = source
        if data.get("in") is not None:
            if (state_in := self._state_in(data["in"], (*where, "in"))) is None:
                return None
            row["guard"] = f"{state_in} && ({row['guard']})" if "guard" in row else state_in
        if data.get("target") not in (None, []):
            targets = self.targets(state, data["target"], (*where, "target"))
            if targets is None:
                return None
            reenter = self._reenters(data)
            row.update(self._way(state, where, targets, reenter))
        self.parts.row = row.get("hears", "")
        if actions := self.parts.actions(data.get("actions"), (*where, "actions")):
            row["actions"] = actions
        self.parts.row = ""
        return row

    def _reenters(self, data: dict[str, Any]) -> bool:
        """Return whether a transition leaves its own state and enters it again.

        Without `reenter` or `internal`, it does so only in version 4, and only if no target begins with a dot.
        """
        if isinstance(data.get("reenter"), bool):
            return bool(data["reenter"])
        if isinstance(data.get("internal"), bool):
            return not data["internal"]
        targets = data["target"] if isinstance(data["target"], list) else [data["target"]]
        return self.version_4 and not any(isinstance(t, str) and t.startswith(".") for t in targets)

    def _state_in(self, data: Any, where: NodePath) -> str | None:
        """Return version 4's `in` as a condition; report it and return None if it is not `#` and a state's id."""
        found = self.outline.resolve(self.outline.root, data) if isinstance(data, str) and data[:1] == "#" else None
        if found is None:
            self.parts.lost(
                where,
                f"`in`: the state `{data}` does not exist",
                'write "#" and the id of the state; until then the transition is left out',
            )
            return None
        return f"In('{found.name or self.outline.title}')"

    def targets(self, state: XStateNode, data: Any, where: NodePath) -> list[XStateNode] | None:
        """Return the target states. Report and return None if one does not exist or they can't be active together."""
        found = []
        for text in data if isinstance(data, list) else [data]:
            target = self.outline.resolve(state, text) if isinstance(text, str) else None
            if target is None:
                self.parts.lost(where, f"there is no state `{text}` to go to", "the transition is left out")
                return None
            found.append(target)
        if pair := rivals(found, lambda node: str(node.kind)):
            message = f"`{pair[0].name}` and `{pair[1].name}` can't be active together"
            self.parts.lost(where, message, "the transition is left out")
            return None
        return found

    def named(self, state: XStateNode, targets: list[XStateNode]) -> Any:
        """Return the state's reference to its target, or a list for several targets."""
        names = [state.calls(target, self.outline.title) for target in targets]
        return names[0] if len(names) == 1 else names

    def _way(self, state: XStateNode, where: NodePath, targets: list[XStateNode], reenter: bool) -> TransitionData:
        """Return `target` and `reenter`, if needed.

        Without `reenter`, a transition to its own state has no target if the state is atomic, and the initial child if
        it is compound.
        """
        if targets == [state] and not reenter and state.kind == "atomic":
            return {}
        if targets == [state] and not reenter and state.kind == "compound":
            self.parts.changed(
                where, f"`{state.original or self.outline.title}` is not left: the target is its first inner state"
            )
            first = state.regular[0]
            initial = state.source.get("initial")
            entered = state.child(initial) if isinstance(initial, str) else None
            return {"target": state.calls(entered or first, self.outline.title)}
        row: TransitionData = {"target": self.named(state, targets)}
        below = bool(targets) and all(target.lies_below(state) for target in targets)
        if reenter and below and state.kind == "compound":
            row["reenter"] = True
        self._parallel(state, where, targets, reenter)
        return row

    def _parallel(self, state: XStateNode, where: NodePath, targets: list[XStateNode], reenter: bool) -> None:
        """Report a transition whose domain is a parallel state: by W3C's rule, it also leaves and enters that state."""
        domain: XStateNode | None = (
            state if not reenter and all(t is state or t.lies_below(state) for t in targets) else None
        )
        ancestor = state.parent
        while domain is None and isinstance(ancestor, XStateNode):
            if all(target.lies_below(ancestor) for target in targets):
                domain = ancestor
            ancestor = ancestor.parent
        if domain is not None and domain.kind == "parallel":
            hint = "SCXML enters a parallel state with all its regions"
            self.parts.changed(
                where, f"this transition also leaves and enters `{domain.original or self.outline.title}`", hint
            )
