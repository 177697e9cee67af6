"""Checks names and types in expressions against the declared context and the messages' schemas."""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from lumen.expressions import ExpressionFinding, check_expression, check_template, schema_of
from lumen.expressions.expression_findings import TYPE_MISMATCH
from lumen.language.actions import Template, context_key
from lumen.language.diagnostics import Place, Related
from lumen.language.json_paths import schema_at
from lumen.language.machines import MachineDefinition, Transition
from lumen.language.shared import SHARED
from lumen.lint.caught import caught_schema
from lumen.lint.events import declared, hears, outcome, raised
from lumen.lint.lists import entry_schema, list_schema
from lumen.lint.recipients import sent_to
from lumen.lint.traps import LOOKS_LIKE_TRUTH
from lumen.lint.walk import ExpressionSite, expression_sites
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.expressions import cause_of, place_within
from lumen.project.remembered_findings import Check, RememberedFindings
from lumen.talk.hearing import HEARD

_TRUTHS = (LOOKS_LIKE_TRUTH, TYPE_MISMATCH)

BOOLEAN_SCHEMA: Mapping[str, Any] = {"type": "boolean"}


def check(draft: ProjectDraft) -> None:
    """Report faults in the names and types of the expressions of every behaviour."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        _Expressions(draft, name, machine, report).check()


class _Expressions:
    def __init__(self, draft: ProjectDraft, name: str, machine: MachineDefinition, report: DocumentReport) -> None:
        self.machine, self.report = machine, report
        self.known, self.whole = draft.settings is not None, draft.words.keys() >= set(machine.words)
        self.events = declared(draft, machine)
        for event in (*raised(report.document), *sent_to(draft, machine)):
            self.events[event] = None
        self.context = {key: machine.types.get(key, schema_of(value)) for key, value in machine.context.items()}
        for behavior, part, key in draft.unsound:
            if behavior == name:
                (self.context if part == "types" else self.events)[key] = {}
        self.loops = any(path[-1:] == ("for",) for path in report.document.spans)
        self.lists = {key: list_schema(entries) for key, entries in machine.lists.items()}
        self.names: dict[str, Any] = {
            "context": self.context,
            "phrases": machine.phrases if self.whole else None,
            "answers": machine.answers if self.whole else None,
            "states": {n for state in machine.states.values() for n in (state.path, state.alias) if n},
            "lists": self.lists if self.whole else None,
            "functions": draft.known_functions,
        }
        given = self.events, self.known
        self.remembered = RememberedFindings(("typed expressions", name), self.names, given)

    def check(self) -> None:
        for spot in expression_sites(self.machine):
            for finding in self.findings(spot):
                self.say(spot, finding)

    def findings(self, spot: ExpressionSite) -> Sequence[ExpressionFinding]:
        transition, variables = spot.transition, self.variables(spot)

        def around() -> dict[str, Any]:
            there = {"events": self.possible(transition), "variables": variables}
            if isinstance(spot.text, Template):
                return there
            return {**there, "expected": BOOLEAN_SCHEMA if spot.guard else spot.expected or self.expected(spot.key)}

        check: Check = check_template if isinstance(spot.text, Template) else check_expression
        if variables or spot.expected or (transition and transition.exact):
            return check(spot.text.shown, **self.names, **around())
        site = transition and transition.event, spot.guard, spot.key
        return self.remembered.of(check, spot.text.shown, site, around)

    def expected(self, way: str) -> Mapping[str, Any] | None:
        """Return the schema of the context key that `assign` writes; None if it is unknown."""
        key, *within = way.split(".")
        schema = schema_at(self.context.get(key), within)
        return schema if isinstance(schema, Mapping) else None

    def variables(self, spot: ExpressionSite) -> dict[str, Any]:
        """Return the schemas of the variables in scope: entries of `for`, `heard` in rows of `hears`, shared values."""
        where = spot.text.where
        found: dict[str, Any] = {SHARED: self.machine.types[SHARED]} if self.machine.shared else {}
        if spot.transition and spot.transition.hears and HEARD in spot.text.shown:
            found[HEARD] = caught_schema(self.machine, spot.transition.hears) if self.whole else {}
        for depth in range(len(where) if self.loops else 0):
            node = self.report.document.find(where[:depth])
            loop = node.get("for") if isinstance(node, Mapping) and where[depth] != "for" else None
            if isinstance(loop, Mapping) and "as" in loop:
                name = re.fullmatch(r"lists\.(\w+)", str(loop.get("each")).strip())
                entries = self.machine.lists.get(name[1], ()) if name and self.whole else ()
                found[loop["as"]] = entry_schema(entries) if entries else {}
        return found

    def possible(self, transition: Transition | None) -> dict[str, Any] | None:
        """Return the events that can trigger a transition, with their schemas; None if it could be any event."""
        if transition is None or not transition.event or "*" in transition.event or not self.known:
            return None
        if transition.exact:
            return outcome(self.machine, transition)
        return {name: schema for name, schema in self.events.items() if hears(transition.event, name)} or None

    def declared(self, spot: ExpressionSite, part: str, finding: ExpressionFinding) -> Iterator[Related]:
        """Yield the places of the context keys whose types don't fit."""
        if finding.code == TYPE_MISMATCH:
            keys = [*re.findall(r"\bcontext\.(\w+)", part), *([context_key(spot.key)] if spot.key else [])]
            for key in dict.fromkeys(k for k in keys if k in (self.report.document.data.get("context") or ())):
                place = self.report.document.place(("context", key), key=True)
                yield Related(
                    place,
                    f"the initial value of `{key}` is {json.dumps(self.machine.context[key], ensure_ascii=False)}",
                )

    def nulls(self, part: str, finding: ExpressionFinding) -> str:
        """Return the common cause of findings about one context key that is null and has no type; else empty."""
        keys = {key for key in re.findall(r"\bcontext\.(\w+)", part) if key in self.machine.context}
        key = keys.pop() if len(keys) == 1 and finding.code == TYPE_MISMATCH else ""
        alone = key and self.machine.context[key] is None and key not in self.machine.types
        return f"{self.report.document.file} null {key}" if alone else ""

    def say(self, spot: ExpressionSite, finding: ExpressionFinding) -> None:
        source = spot.text.shown
        place = place_within(self.report.document, spot.text.where, source, finding.offset, finding.length)
        part = source[finding.offset : finding.offset + finding.length]
        related = tuple(self.declared(spot, part, finding))
        cause = cause_of(self.report.document.file, finding) or self.nulls(part, finding)
        found = finding.code.at(place, finding.message, finding.hint, related, cause)
        if not self.truth(spot, finding, part, place):
            self.report.diagnostics.append(found)

    def truth(self, spot: ExpressionSite, finding: ExpressionFinding, part: str, place: Place) -> bool:
        """Return whether a word such as `no`, written for `false` in the context, causes a type mismatch.

        Such a mismatch is reported once, at the value in the context.
        """
        for key in re.findall(r"\bcontext\.(\w+)", part) if "true or false" in finding.message else ():
            there = self.report.document.place(("context", key))
            told = next((d for d in self.report.diagnostics if d.code in _TRUTHS and d.place == there), None)
            if told and told.code == LOOKS_LIKE_TRUTH:
                related = (Related(place, "this must be true or false"),)
                self.report.diagnostics[self.report.diagnostics.index(told)] = TYPE_MISMATCH.at(
                    there, told.message, told.hint, related
                )
            if told:
                return True
        return False
