"""Writes a machine as an XState v5 configuration in JSON, for `createMachine`."""

import json
from collections.abc import Iterator, Sequence
from typing import Any

from lumen.expressions.readings import as_written
from lumen.features.formats_charts.heard_rows import LOST_ELSEWHERE, as_guard, key_of
from lumen.features.formats_charts.xstate.action_reader import ACTION_PREFIX, DO_ACTOR, EXPRESSION_GUARD, HEARS_GUARD
from lumen.features.formats_charts.xstate.constants import constant
from lumen.features.formats_charts.xstate.descriptors import EventDescriptors
from lumen.language.actions import Expression, PlacedAction, Template
from lumen.language.diagnostics import Diagnostic
from lumen.language.machines import Answer, Hears, Invoke, MachineDefinition, State, StateKind, Transition
from lumen.project.formats.behavior_data import (
    plain_action,
    plain_block,
    plain_button,
    plain_phrases,
    plain_properties,
    plain_value,
)
from lumen.project.formats.conversion_findings import ExportReport, PlaceOfPath

_HINT = "write an implementation with that name for XState"


def write_xstate(machine: MachineDefinition, place: PlaceOfPath) -> tuple[str, list[Diagnostic]]:
    """Return the configuration, and findings about parts that are missing from it or need code.

    An action becomes `{"type": "lumen.say", "params": …}`, a guard `{"type": "lumen.expression", "params":
    {"source": …}}`, a row of `hears` the guard `lumen.hears`, and `do` an invocation of `lumen.do`. Their code belongs
    in `setup`. Other features that XState lacks are in `meta`.
    """
    report = ExportReport(place, _HINT)
    data = _XStateWriter(machine, report).data()
    return json.dumps(data, ensure_ascii=False, indent=2) + "\n", report.diagnostics


class _XStateWriter:
    """Writes the states of one machine."""

    def __init__(self, machine: MachineDefinition, report: ExportReport) -> None:
        self.machine, self.report = machine, report
        self.descriptors = EventDescriptors(machine)

    def data(self) -> dict[str, Any]:
        machine = self.machine
        data: dict[str, Any] = {"id": machine.id} if machine.id else {}
        if machine.context:
            data["context"] = machine.context
        return {**data, **self._state(machine.root)}

    def _state(self, state: State) -> dict[str, Any]:
        data: dict[str, Any] = {"id": state.alias} if state.alias and state.path else {}
        if state.kind in (StateKind.PARALLEL, StateKind.FINAL, StateKind.HISTORY):
            data["type"] = str(state.kind)
        if state.kind is StateKind.HISTORY:
            data["history"] = "deep" if state.deep else "shallow"
            return data | ({"target": self._targets(state, state.initial)} if state.initial else {})
        below = [s for s in self.machine.states.values() if s.parent == state.path and s.path]
        extra = self._begin(state, data)
        data.update(self._behaviour(state))
        if below:
            data["states"] = {s.path.rpartition(".")[2]: self._state(s) for s in below} | extra
        return data

    def _begin(self, state: State, data: dict[str, Any]) -> dict[str, Any]:
        """Set `initial` in `data`, and return the states that must be added, by key.

        If the initial states are not a single child, an added state immediately enters them.
        """
        if state.kind is not StateKind.COMPOUND:
            return {}
        if len(state.initial) == 1 and self.machine.states[state.initial[0]].parent == state.path:
            data["initial"] = state.initial[0].rpartition(".")[2]
            return {}
        prefix = f"{state.path}." if state.path else ""
        key = "begin"
        while prefix + key in self.machine.states:
            key += "_"
        data["initial"] = key
        message = f"XState's `initial` must be a child: the additional state `{key}` leads to the inner state"
        self.report.changed(message, (*state.where, "initial"))
        targets = [self._id(path) for path in state.initial]
        return {key: {"always": {"target": targets[0] if len(targets) == 1 else targets}}}

    def _id(self, path: str) -> str:
        alias = self.machine.states[path].alias
        if alias:
            return f"#{alias}"
        return f"#{self.machine.id or '(machine)'}.{path}" if path else f"#{self.machine.id or '(machine)'}"

    def _targets(self, source: State, paths: Sequence[str]) -> Any:
        names = [self._target(source, path) for path in paths]
        return names[0] if len(names) == 1 else names

    def _target(self, source: State, path: str) -> str:
        parent, _, key = path.rpartition(".")
        if path and parent == source.path and self.machine.states[path].parent == source.path:
            return f".{key}"
        if path and source.path and source.parent == self.machine.states[path].parent:
            return key
        return self._id(path)

    def _behaviour(self, state: State) -> dict[str, Any]:
        data: dict[str, Any] = {}
        for key, steps in (("entry", state.entry), ("exit", state.exit)):
            if steps:
                data[key] = self._actions(steps)
        rows = self._rows(state)
        invokes = [self._invoke(invoke, rows) for invoke in state.invoke]
        name = state.name
        done, failed = rows.pop(f"!done.do.{name}", []), rows.pop(f"!error.do.{name}", [])
        if state.do:
            invokes.append(self._do(state, done, failed))
        if invokes:
            data["invoke"] = invokes[0] if len(invokes) == 1 else invokes
        if ended := rows.pop(f"!done.state.{name}", []):
            data["onDone"] = ended
        if on := {event: row for event, row in rows.items() if not event.startswith("!")}:
            data["on"] = on
        if always := [self._row(state, t) for t in state.transitions if not t.event]:
            data["always"] = always
        if after := self._after(state):
            data["after"] = after
        if meta := dict(self._meta(state)):
            data["meta"] = {"lumen": meta}
        if state.output is not None:
            data["output"] = constant(state.output)
        return data

    def _rows(self, state: State) -> dict[str, list[Any]]:
        """Return the transitions on events, including the state's own, by XState's descriptors."""
        table = self.descriptors.arranged(state)
        return {
            event: rows for event, found in table.items() if (rows := [self._row(state, t) for t in self._kept(found)])
        }

    def _kept(self, found: list[Transition]) -> Iterator[Transition]:
        """Yield the transitions that can be written; report the others, whose phrases come from a list entry."""
        for transition in found:
            if transition.hears and not key_of(transition.hears) and as_guard(transition) is None:
                message = f"`{transition.hears.title}` is left out: phrases from a list entry can't be converted"
                self.report.lost(message, transition.where)
            else:
                yield transition

    def _after(self, state: State) -> dict[str, list[Any]]:
        data: dict[str, list[Any]] = {}
        for transition in state.transitions:
            if transition.schedule:
                message = f"`at: {transition.schedule.text}` is left out: XState has no time of day"
                self.report.lost(message, transition.where)
            if isinstance(transition.delay, Template):
                message = f"`after: {transition.delay.shown}` is left out: a computed delay can't be converted"
                self.report.lost(message, transition.where)
            elif transition.delay is not None:
                length = round(transition.delay * 1000, 6)
                key = f"{int(length)}" if length == int(length) else f"{length}"
                data.setdefault(key, []).append(self._row(state, transition))
        return data

    def _invoke(self, invoke: Invoke, rows: dict[str, list[Any]]) -> dict[str, Any]:
        """Return an actor with the behaviour's name, and report that `setup` must provide it.

        Its `onDone` and `onError` are removed from `rows`. Its input is also in `meta`, as Lumen's expressions.
        """
        hint = f"give `setup` the actor `{invoke.behavior}` from `lumen export xstate {invoke.behavior}`"
        self.report.changed(f"`invoke` of `{invoke.behavior}` becomes an actor", invoke.where, hint)
        data: dict[str, Any] = {"id": invoke.id, "src": invoke.behavior}
        if invoke.input:
            data["input"] = {key: constant(value) for key, value in invoke.input.items()}
        for key, kind in (("onDone", "done"), ("onError", "error")):
            if found := rows.pop(f"!{kind}.invoke.{invoke.id}", []):
                data[key] = found
        return data

    def _do(self, state: State, done: list[Any], failed: list[Any]) -> dict[str, Any]:
        self.report.foreign(f"`{DO_ACTOR}`", (*state.where, "do"))
        data: dict[str, Any] = {"src": DO_ACTOR, "input": {"steps": plain_block(state.do)}}
        return data | ({"onDone": done} if done else {}) | ({"onError": failed} if failed else {})

    def _row(self, state: State, transition: Transition) -> dict[str, Any]:
        row: dict[str, Any] = {}
        if transition.offer:
            self.report.changed("`offer` is left out: XState has no language model", transition.where)
        if transition.approve:
            self.report.lost("`approve` is left out: XState has no approval by a person", transition.where)
        if transition.targets:
            row["target"] = self._targets(state, transition.targets)
        if transition.hears:
            row["guard"] = self._heard(transition, transition.hears)
        elif transition.guard:
            row["guard"] = self._guard(transition.guard, transition)
        if transition.actions:
            row["actions"] = self._actions(transition.actions)
        if transition.targets and self._leaves_itself(state, transition):
            row["reenter"] = True
        return row

    def _heard(self, transition: Transition, row: Hears) -> dict[str, Any]:
        """Return the guard for a row of `hears`: `lumen.hears`, or an expression for phrases from a list entry.

        The change is reported, since other tools lack such rows.
        """
        if key := key_of(row):
            self.report.changed(f"`{row.title}` becomes a guard `{HEARS_GUARD}`", transition.where, LOST_ELSEWHERE)
            source = {"source": as_written(transition.guard.source)} if transition.guard else {}
            return {"type": HEARS_GUARD, "params": {"row": key, **source}}
        condition = as_guard(transition)
        assert condition is not None  # `_kept` leaves out the others
        self.report.changed(f"`{row.title}` becomes the guard `{condition.source}`", transition.where, LOST_ELSEWHERE)
        return self._guard(condition, transition)

    def _guard(self, guard: Expression, transition: Transition) -> dict[str, Any]:
        self.report.foreign(f"the guard `{EXPRESSION_GUARD}`", transition.where)
        return {"type": EXPRESSION_GUARD, "params": {"source": guard.source}}

    def _leaves_itself(self, state: State, transition: Transition) -> bool:
        """Return whether Lumen leaves a state in which XState, without `reenter`, would stay."""
        prefix = f"{state.path}." if state.path else ""
        within = all(path == state.path or path.startswith(prefix) for path in transition.targets)
        return within and (
            transition.reenter or state.kind is not StateKind.COMPOUND or state.path in transition.targets
        )

    def _actions(self, steps: Sequence[PlacedAction]) -> list[dict[str, Any]]:
        return [self._action(step) for step in steps]

    def _action(self, step: PlacedAction) -> dict[str, Any]:
        plain = plain_action(step.action)
        verb = next(iter(plain))
        self.report.foreign(f"the action `{ACTION_PREFIX}{verb}`", step.where)
        body = plain if verb == "if" else plain[verb]
        whole = isinstance(body, dict) and set(body) != {"value"}
        return {"type": f"{ACTION_PREFIX}{verb}", "params": body if whole else {"value": body}}

    def _meta(self, state: State) -> Iterator[tuple[str, Any]]:
        if not state.path:
            yield from self._machine()
        if state.on_reload:
            yield "onReload", self._target(state, state.on_reload)
        if state.resume:
            yield "resume", state.resume
        if state.buttons:
            yield "buttons", [plain_button(button) for button in state.buttons]
        if state.output is not None:
            yield "output", plain_value(state.output)
        if state.invoke:
            yield "invoke", {invoke.id: plain_value(invoke.input) for invoke in state.invoke}

    def _machine(self) -> Iterator[tuple[str, Any]]:
        machine = self.machine
        yield from ((key, table) for key in ("types", "events", "renamed") if (table := getattr(machine, key)))
        if machine.phrases:
            yield (
                "phrases",
                {name: plain_phrases(table, anyhow=name in machine.anyhow) for name, table in machine.phrases.items()},
            )
        if machine.answers:
            yield "answers", {name: [_answer(row) for row in rows] for name, rows in machine.answers.items()}
        if machine.lists:
            yield "lists", {name: list(entries) for name, entries in machine.lists.items()}
        if machine.properties:
            yield "properties", plain_properties(machine)


def _answer(row: Answer) -> dict[str, Any]:
    return {"phrases": plain_phrases(row.phrases), "value": row.value}
