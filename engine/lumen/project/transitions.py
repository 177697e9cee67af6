"""Read transitions of a behaviour, `on`, `always`, `after`, `at`, `onDone` and `onError`, with resolved targets."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from lumen.language.actions import Template
from lumen.language.diagnostics import ERROR, Code, NodePath
from lumen.language.hours import Schedule
from lumen.language.machines import Approval, Hears, StateKind, Transition
from lumen.project.actions import Actions
from lumen.project.document_report import DocumentReport
from lumen.project.expressions import Expressions
from lumen.project.hears_keys import HearsKeys
from lumen.project.outline import BehaviorOutline, OutlinedState
from lumen.project.schedules import schedule
from lumen.project.state_parts import invoked, read_buttons
from lumen.talk.hearing import HEARD

CONFLICTING_TARGETS = Code(
    "conflicting-targets", "statecharts", ERROR, "the states of a target can't be active together"
)
MISPLACED_APPROVAL = Code(
    "misplaced-approval", "statecharts", ERROR, "a transition with `approve` is not started by an event from outside"
)
ENDLESS_ALWAYS = Code("endless-always", "statecharts", ERROR, "an `always` would repeat for ever")

_OUTSIDE = frozenset(("on", "hears"))
_OWN = ("done", "error", "after", "at")
"""The first words in the names of events that the behaviour raises itself."""

PlacedValue = tuple[NodePath, Any]


class TransitionReader:
    """Reads the transitions of one document's states."""

    def __init__(
        self, report: DocumentReport, outline: BehaviorOutline, actions: Actions, expressions: Expressions
    ) -> None:
        self.report, self.outline = report, outline
        self.actions, self.expressions = actions, expressions
        self.rows = HearsKeys(report, expressions)

    def of(self, entry: OutlinedState) -> tuple[Transition, ...]:
        """Return the transitions of a state, in the order of the file, without those that are broken."""
        return tuple(found for key, body in entry.data.items() for found in self._under(entry, key, body))

    def targets(
        self, entry: OutlinedState, body: Any, where: NodePath, written: Any = None
    ) -> list[OutlinedState] | None:
        """Return the states that a target or a list of targets names.

        If a state does not exist, or if the states can't be active together, report the fault and return None.
        `written` is the target as the file has it, if that differs.
        """
        rows = _rows(body, where)
        shown = [text for _, text in _rows(written or body, where)]
        found = [self.outline.resolve(entry, text, place, s) for (place, text), s in zip(rows, shown, strict=True)]
        states = [state for state in found if state is not None]
        if len(states) < len(found) or not self._together(states, where):
            return None
        return states

    def _under(self, entry: OutlinedState, key: str, body: Any) -> Iterator[Transition]:
        where = (*entry.where, key)
        match key:
            case "on":
                for event, rows in body.items():
                    yield from self._candidates(entry, rows, (*where, event), event=event)
            case "buttons":
                yield from self._pressed(entry, body, where)
            case "hears":
                for row, rows in body.items():
                    yield from self._heard(entry, row, rows, (*where, row))
            case "always":
                yield from self._candidates(entry, body, where)
            case "after":
                yield from self._after(entry, body, where)
            case "at":
                yield from self._at(entry, body, where)
            case "invoke":
                for place, id, row in invoked(entry):
                    for end, event in (("onDone", f"done.invoke.{id}"), ("onError", f"error.invoke.{id}")):
                        if end in row:
                            yield from self._candidates(entry, row[end], (*place, end), event=event, exact=True)
            case "onDone":
                kind = "do" if entry.kind is StateKind.ATOMIC else "state"
                yield from self._candidates(entry, body, where, event=f"done.{kind}.{entry.name}", exact=True)
            case "onError":
                yield from self._candidates(entry, body, where, event=f"error.do.{entry.name}", exact=True)

    def _pressed(self, entry: OutlinedState, body: Any, where: NodePath) -> Iterator[Transition]:
        """Yield the transitions of buttons with `actions`: they perform these, and the state stays active."""
        for button, data in read_buttons(body, where, entry.name):
            if data is not None:
                actions = self.actions.block(data, (*button.where, "actions"))
                yield Transition(entry.path, button.event, (), None, actions, where=button.where)

    def _heard(self, entry: OutlinedState, key: str, body: Any, where: NodePath) -> Iterator[Transition]:
        """Yield the transitions of a row of `hears`; the row of a key that can't be read is marked as pruned."""
        way, names = self.rows.read(key, where)
        if way == "" and not names:
            self.report.pruned.add(where)
            return
        for place, row in _rows(body, where):
            number = self.expressions.rounds.rows[place] = len(self.expressions.rounds.rows)
            if found := self._one(entry, row, place, HEARD, leaves=True):
                yield replace(found, where=place, hears=Hears(number, key, names, way))

    def _after(self, entry: OutlinedState, body: Mapping[str, Any], where: NodePath) -> Iterator[Transition]:
        for text, rows in body.items():
            delay = self.actions.delay(text, (*where, text), key=True)
            if delay is not None:
                length = text if isinstance(delay, Template) else text.replace(" ", "")
                event = f"after.{length}.{entry.name}"
                yield from self._candidates(entry, rows, (*where, text), event=event, exact=True, delay=delay)

    def _at(self, entry: OutlinedState, body: Mapping[str, Any], where: NodePath) -> Iterator[Transition]:
        for text, rows in body.items():
            found = schedule(text, self.report, (*where, text), key=True)
            if found is not None:
                event = f"at.{''.join(found.text.split())}.{entry.name}"
                yield from self._candidates(entry, rows, (*where, text), event=event, exact=True, schedule=found)
            else:
                self.report.pruned.add((*where, text))  # its target counts as unreachable for this reason

    def _candidates(
        self,
        entry: OutlinedState,
        body: Any,
        where: NodePath,
        *,
        event: str = "",
        exact: bool = False,
        delay: float | Template | None = None,
        schedule: Schedule | None = None,
    ) -> Iterator[Transition]:
        leaves = bool(event)
        for place, row in _rows(body, where):
            found = self._one(entry, row, place, event, leaves)
            leaves = leaves or (isinstance(row, Mapping) and "guard" in row and "target" in row)
            if found:
                yield replace(found, delay=delay, schedule=schedule, exact=exact, where=place)

    def _one(self, entry: OutlinedState, row: Any, where: NodePath, event: str, leaves: bool) -> Transition | None:
        """Return a transition; None if it is broken, which is reported.

        `leaves` is true if an event, or an earlier transition with a guard, keeps an `always` from repeating forever.
        """
        if isinstance(row, str):
            row, place = {"target": row}, where
        else:
            place = (*where, "target")
        targets = self.targets(entry, row["target"], place) if "target" in row else []
        guard = self.expressions.expression(row["guard"], (*where, "guard")) if "guard" in row else None
        actions = self.actions.block(row.get("actions"), (*where, "actions"))
        if targets is None or (guard is None and "guard" in row):
            self.report.missed.update(text for _, text in _rows(row.get("target", []), place))
            return None
        if not (leaves or targets or guard):
            hint = "add a `target` or a `guard`"
            self.report(
                ENDLESS_ALWAYS, where, "an `always` without `target` and `guard` would repeat for ever", hint=hint
            )
            return None
        paths = tuple(target.path for target in targets)
        approve = self._approval(row["approve"], (*where, "approve"), event) if "approve" in row else None
        return Transition(
            entry.path,
            event,
            paths,
            guard,
            actions,
            row.get("reenter", False),
            approve=approve,
            offer=row.get("offer", False),
        )

    def _approval(self, data: Any, where: NodePath, event: str) -> Approval | None:
        """Return the approval that a transition needs.

        If the transition can't wait for approval, report that and return None.
        """
        if event == "*" or event.split(".")[0] in _OWN or len(set(where) & _OUTSIDE) == 0:
            message = "only a transition that is started by an event from outside can wait for approval"
            hint = "go to a state that waits for a button, and add `approve` to the transition in its `on`"
            self.report(MISPLACED_APPROVAL, where, message, hint=hint, key=True)
            return None
        if isinstance(data, str):
            return Approval()
        within = self.actions.duration(data["within"], (*where, "within")) if "within" in data else None
        return Approval(within, data.get("else", "stay"))

    def _together(self, states: list[OutlinedState], where: NodePath) -> bool:
        if (pair := rivals(states, lambda state: str(state.kind))) is None:
            return True
        message = f"`{pair[0].path}` and `{pair[1].path}` can't be active together"
        hint = "list only states in different regions of one parallel state"
        self.report(CONFLICTING_TARGETS, where, message, hint=hint)
        return False


_Nested = TypeVar("_Nested")
"""A state with a `parent`, in a behaviour or in a foreign chart."""


def rivals(states: Sequence[_Nested], kind: Callable[[Any], str]) -> tuple[_Nested, _Nested] | None:
    """Return two states that can't be targets together; None if all can.

    Two states are rivals if they are in different children of a state that is not parallel. A history and any other
    state in the history's parent are rivals too. `kind` returns the kind of a state, as in `StateKind`.
    """
    came: dict[int, tuple[Any, _Nested]] = {}
    outer: Sequence[Any] = states
    spoken = {id(state.parent): state for state in outer if kind(state) == StateKind.HISTORY and state.parent}
    for state in states:
        child: Any = state
        while (parent := child.parent) is not None:
            history = spoken.get(id(parent), state)
            via, first = came.setdefault(id(parent), (child, state))
            if history is not state:
                return history, state
            if via is not child and kind(parent) != StateKind.PARALLEL:
                return first, state
            child = parent
    return None


def _rows(body: Any, where: NodePath) -> list[PlacedValue]:
    return [((*where, i), row) for i, row in enumerate(body)] if isinstance(body, list | tuple) else [(where, body)]
