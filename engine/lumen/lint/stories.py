"""Checks of stories: the states, context keys, sensors, events and routes that they name."""

import json
from collections.abc import Mapping
from typing import Any

from lumen.expressions import check_expression, schema_of
from lumen.expressions.expression_findings import UNKNOWN_CONTEXT_KEY, UNKNOWN_STATE
from lumen.language.actions import Expression
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.machines import MachineDefinition
from lumen.language.properties import conditions_of
from lumen.language.stories import AnswerQuestion, Expect, Happen, SendMessage, Story, TouchSensor
from lumen.lint.events import UNKNOWN_EVENT, declared, descriptors, hears, raised
from lumen.lint.lookups import References, first
from lumen.lint.recipients import sent_to
from lumen.lint.references import known_route
from lumen.project.complaints import WRONG_TYPE
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.expressions import place_within
from lumen.project.memoization import Same, memoize
from lumen.project.roles import LEFT_OUT
from lumen.project.schema import faults
from lumen.statechart.nesting import ID_SEPARATOR, resolutions
from lumen.statechart.type_checks import fits, refusal, type_checks

UNKNOWN_SENSOR = Code("unknown-sensor", "references", ERROR, "the robot has no tactile sensor of that name")


def check(draft: ProjectDraft) -> None:
    """Report states, context keys, motions, routes, sensors and events that a story names but that do not exist."""
    references = References(draft)
    for name, story in draft.stories.items():
        _Script(draft, references, draft.report("behaviors/stories", name), story).check()


class _Script:
    def __init__(self, draft: ProjectDraft, references: References, report: DocumentReport, story: Story) -> None:
        self.draft, self.references, self.report, self.story = draft, references, report, story
        main = draft.settings.behavior if draft.settings else ""
        self.behavior = story.behavior or main
        self.machine = draft.behaviors.get(self.behavior)
        self.events = declared(draft, self.machine) if self.machine else {}
        self.sound = not any(behavior == self.behavior for behavior, *_ in draft.unsound)

    def check(self) -> None:
        if self.story.behavior:
            self.references.look_up(self.report, ("behavior",), "behavior", self.story.behavior)
        for i, state in enumerate(self.story.never):
            self.state(("never", i), state)
        for condition in conditions_of(self.story.properties):
            self.condition(condition)
        for key, value in self.story.context.items():
            self.key(("context", key), key, value)
        for step in self.story.steps:
            match step.action:
                case TouchSensor(sensor, pressed):
                    self.sensor((*step.where, "touch" if pressed else "release"), sensor)
                case Happen(name, data):
                    self.event(first(self.report, (*step.where, "event", "name"), (*step.where, "event")), name)
                    if (*step.where, "event", "data") not in self.report.pruned:
                        self.fits((*step.where, "event", "data"), {} if data is None else data, self.events.get(name))
                case AnswerQuestion(event=event, data=data) if event:
                    self.event((*step.where, "answers", "raise"), event)
                    if (*step.where, "answers", "data") not in self.report.pruned:
                        self.fits((*step.where, "answers", "data"), data, self.events.get(event))
                case SendMessage(route, body):
                    self.message((*step.where, "message"), route, body)
                case Expect() as expected:
                    self.expect((*step.where, "expect"), expected)

    def condition(self, condition: Expression) -> None:
        """Check the expression of a property against the declarations of its behaviour."""
        machine = self.machine
        if machine is None or not self.sound:
            return
        context = {key: machine.types.get(key, schema_of(value)) for key, value in machine.context.items()}
        names = {name for state in machine.states.values() for name in (state.path, state.alias) if name}
        for finding in check_expression(
            condition.shown,
            context=context,
            states=names,
            functions=self.draft.known_functions,
            expected={"type": "boolean"},
        ):
            place = place_within(self.report.document, condition.where, condition.shown, finding.offset, finding.length)
            self.report.diagnostics.append(finding.code.at(place, finding.message, finding.hint))

    def expect(self, where: NodePath, expected: Expect) -> None:
        for i, state in enumerate(expected.states):
            self.state(first(self.report, (*where, "state", i), (*where, "state")), state)
        for key, value in expected.context.items():
            self.key((*where, "context", key), key, value)
        if expected.played is not None:
            self.references.look_up(self.report, (*where, "played"), "motion", expected.played)
        if expected.published is not None:
            place = first(self.report, (*where, "published", "route"), (*where, "published"))
            known_route(self.draft, self.report, place, expected.published)

    def state(self, path: NodePath, name: str) -> None:
        """Report the name of a state that does not exist.

        The name is an id or a path; `quiz/ask` is the state `ask` of the behaviour invoked as `quiz`.
        """
        if (
            self.machine is None
            or _has(self.machine, name)
            or self._lost(name)
            or any(_has(*reading) for reading in resolutions(self.machine, name))
        ):
            return
        machine, rest = next(resolutions(self.machine, name))
        state = machine.states.get(rest)
        pruned = self.draft.report("behaviors", self.behavior).pruned
        if any((*s.where, "id") in pruned and s.path.endswith(rest) for s in machine.states.values()):
            return  # its id was invalid
        names = _names(machine, name.removesuffix(rest))
        inner = sorted(known for known in names if known.rpartition(".")[2] == rest)
        hint = (
            f"write `{inner[0]}`: a state without an `id` is called by its path" if inner else did_you_mean(name, names)
        )
        if state and rest:
            hint = f"write its id: `{name.removesuffix(rest)}{state.name}`"
        message = f"`{self.behavior}` has no state `{name}`"
        file = f"behaviors/{self.behavior}.yaml"
        self.report(
            UNKNOWN_STATE,
            path,
            message,
            hint,
            cause=f"{file} state {name}",
            root=f"the states of {file}",
        )

    def key(self, path: NodePath, key: str, value: Any) -> None:
        """Report an unknown context key, or a value that the key can't have."""
        if self.machine is None or self._lost(key):
            return
        if key not in self.machine.context:
            hint = did_you_mean(key, self.machine.context, "it has")
            message = f"the context of `{self.behavior}` has no `{key}`"
            cause = f"behaviors/{self.behavior}.yaml context {key}"
            self.report(UNKNOWN_CONTEXT_KEY, path, message, hint, key=True, cause=cause)
        elif self.sound and not fits(value, check := type_checks(self.machine)[key]):
            hint = f"its initial value is {json.dumps(self.machine.context[key], ensure_ascii=False)}"
            self.report(WRONG_TYPE, path, f"`{key}` {refusal(value, check)}", hint)

    def sensor(self, path: NodePath, sensor: str) -> None:
        body = self.draft.body
        if body and not body.tactile:
            hint = "a rehearsal of this story fails here: leave the story to robots with such sensors"
            self.report(LEFT_OUT, path, f"{body.name} has no touch sensors, so nobody can touch `{sensor}`", hint)
        elif body and sensor not in body.tactile:
            hint = did_you_mean(sensor, body.tactile, f"{body.name} has")
            self.report(UNKNOWN_SENSOR, path, f"there is no tactile sensor `{sensor}`", hint)

    def event(self, path: NodePath, event: str) -> None:
        machine: MachineDefinition | None = self.machine
        if machine is None or self._lost(event) or any(hears(d, event) for d in descriptors(machine)):
            return
        document = self.draft.report("behaviors", self.behavior).document
        known = {*self.events, *raised(document), *sent_to(self.draft, machine)}
        if event not in known:
            waited = {d for d in descriptors(machine) if "*" not in d}
            message = f"nothing in `{self.behavior}` uses the event `{event}`"
            hint = did_you_mean(event, known | waited)
            self.report(UNKNOWN_EVENT, path, message, hint, cause=f"name {event}")

    def message(self, where: NodePath, route: str, body: Any) -> None:
        known = known_route(self.draft, self.report, (*where, "route"), route)
        if known and self.draft.settings and (*where, "body") not in self.report.pruned:
            self.fits((*where, "body"), body, self.draft.messages.get(self.draft.settings.routes[route].schema))

    def fits(self, path: NodePath, data: Any, schema: Any) -> None:
        """Report data in the story that does not fit the schema of the real data."""
        if isinstance(schema, Mapping):
            for complaint in faults(data, schema):
                place = (*path, *complaint.path)
                self.report(complaint.code, place, complaint.message, complaint.hint, key=complaint.key)

    def _lost(self, name: str) -> bool:
        """Return whether a name was in an unreadable part of the behaviour, or of a behaviour that it invokes."""
        last = name.rpartition(ID_SEPARATOR)[2]
        behaviors = self.draft.behaviors if last != name else (self.behavior,)
        lost = [self.draft.report("behaviors", behavior).lost for behavior in behaviors]
        return any(name in found or last in found or last.rpartition(".")[2] in found for found in lost)


def _has(machine: MachineDefinition, name: str) -> bool:
    named = (state.name for state in machine.states.values() if state.path)
    return name in memoize(("state names", machine.id), Same(machine), lambda: frozenset(named))


def _names(machine: MachineDefinition, prefix: str) -> set[str]:
    """Return the names of a machine's states with `prefix`, and those of the machines that it invokes."""
    names = {prefix + state.name for state in machine.states.values() if state.path}
    for invoke in (invoke for state in machine.states.values() for invoke in state.invoke):
        if other := machine.invoked.get(invoke.behavior):
            names |= {f"{prefix}{invoke.id}{ID_SEPARATOR}{state.name}" for state in other.states.values() if state.path}
    return names
