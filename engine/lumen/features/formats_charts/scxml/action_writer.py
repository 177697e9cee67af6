"""Writes Lumen's actions as SCXML's executable content."""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from lumen.expressions import parse_expression, unparse
from lumen.expressions.tree import Literal
from lumen.features.formats_charts.ecmascript import ScriptError, Vocabulary, write_expression
from lumen.features.formats_charts.scxml.log_templates import expression_of
from lumen.features.formats_charts.scxml.xml_tags import XmlTag
from lumen.language.actions import (
    Assign,
    CancelSend,
    ComputedValue,
    Expression,
    If,
    LogText,
    PlacedAction,
    Raise,
    Send,
    Template,
)
from lumen.project.formats.behavior_data import plain_action, plain_value
from lumen.project.formats.conversion_findings import ExportReport
from lumen.project.formats.durations import duration

_IDENTIFIER = re.compile(r"[A-Za-z_]\w*", re.ASCII)


class ScxmlActionWriter:
    """Writes the actions of one machine."""

    def __init__(self, vocabulary: Vocabulary, report: ExportReport) -> None:
        self.vocabulary, self.report = vocabulary, report

    def block(self, steps: Sequence[PlacedAction]) -> list[XmlTag]:
        """Return the actions as elements; report and leave out those that ECMAScript can't express."""
        return [tag for step in steps for tag in self._one(step)]

    def expression(self, expression: Expression) -> str:
        """Translate an expression to ECMAScript, and report the names in it that only Lumen has.

        Raises ScriptError if ECMAScript can't express it.
        """
        written = write_expression(expression.source, self.vocabulary)
        self._foreign(written.foreign, expression.where)
        return written.text

    def _foreign(self, names: Sequence[str], where: Any) -> None:
        for name in names:
            self.report.foreign(f"`{name}` in an expression", where)

    def _location(self, way: str) -> str:
        key, *within = way.split(".")
        fields = (f".{name}" if _IDENTIFIER.fullmatch(name) else f"[{json.dumps(name)}]" for name in within)
        return "".join((self.vocabulary.keys[key], *fields))

    def _one(self, step: PlacedAction) -> list[XmlTag]:
        try:
            return list(self._tags(step))
        except ScriptError as error:
            verb = next(iter(plain_action(step.action)))
            self.report.lost(f"`{verb}` is left out: {error}", step.where)
            return []

    def _tags(self, step: PlacedAction) -> Iterator[XmlTag]:
        match step.action:
            case Assign(values):
                if any(isinstance(v, Expression) and not is_constant(v.source) for v in list(values.values())[1:]):
                    message = "this `assign` becomes several: if one fails, those before it keep their effect"
                    self.report.changed(message, step.where)
                for key, value in values.items():
                    yield XmlTag("assign", {"location": self._location(key), "expr": self.value(value)})
            case Raise(event, None):
                yield XmlTag("raise", {"event": event})
            case Raise(event, data):
                yield XmlTag("send", {"event": event, "target": "#_internal"}, self.data(data))
            case Send(event, data, delay, id, to) if not isinstance(delay, Template):
                target = f"#_{to}" if to else ""
                length = duration(delay * 1000) if delay else ""
                attributes = {"event": event, "target": target, "id": id, "delay": length}
                yield XmlTag("send", attributes, self.data(data) if data is not None else [])
            case CancelSend(id):
                yield XmlTag("cancel", {"sendid": id})
            case LogText(template):
                text, foreign = expression_of(template.text, self.vocabulary)
                self._foreign(foreign, step.where)
                yield XmlTag("log", {"expr": text})
            case If() as choice:
                yield XmlTag("if", {"cond": self.expression(choice.guard)}, list(self._branches(choice)))
            case action:
                plain = plain_action(action)
                self.report.foreign(f"`{next(iter(plain))}`", step.where)
                yield XmlTag("lumen:action", {}, [], json.dumps(plain, ensure_ascii=False))

    def _branches(self, choice: If) -> Iterator[XmlTag]:
        yield from self.block(choice.then)
        match choice.otherwise:
            case (PlacedAction(action=If() as other),):
                yield XmlTag("elseif", {"cond": self.expression(other.guard)})
                yield from self._branches(other)
            case (_, *_):
                yield XmlTag("else")
                yield from self.block(choice.otherwise)

    def data(self, value: ComputedValue) -> list[XmlTag]:
        """Return an event's data as elements: a `<param>` for each entry of a non-empty map, else one `<content>`.

        Raises ScriptError if ECMAScript can't express a value.
        """
        if isinstance(value, Mapping) and value and all(value):
            return [XmlTag("param", {"name": key, "expr": self.value(item)}) for key, item in value.items()]
        return [XmlTag("content", {"expr": self.value(value)})]

    def value(self, value: ComputedValue) -> str:
        """Return a value in ECMAScript. Raises ScriptError if ECMAScript can't express it."""
        match value:
            case Expression():
                return self.expression(value)
            case tuple():
                return f"[{', '.join(map(self.value, value))}]"
            case Mapping():
                return "{" + ", ".join(f"{unparse(Literal(k))}: {self.value(v)}" for k, v in value.items()) + "}"
        return unparse(Literal(plain_value(value)))

    def literal(self, value: Any) -> str:
        """Return a JSON value as an ECMAScript literal."""
        match value:
            case list() | tuple():
                return f"[{', '.join(map(self.literal, value))}]"
            case Mapping():
                pairs = (f"{unparse(Literal(str(k)))}: {self.literal(v)}" for k, v in value.items())
                return "{" + ", ".join(pairs) + "}"
        return unparse(Literal(value))


def is_constant(source: str) -> bool:
    """Return whether a Lumen expression is a literal, whose evaluation can't fail."""
    return isinstance(parse_expression(source), Literal)
