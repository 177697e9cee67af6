"""Reads SCXML's executable content (section 4) as Lumen's actions."""

import re
from collections.abc import Iterable, Iterator
from typing import Any

from lumen.expressions import unparse
from lumen.features.formats_charts.ecmascript import ScriptError, parse_script, read_condition, read_value
from lumen.features.formats_charts.ecmascript.constants import constant
from lumen.features.formats_charts.scxml.data_model import ScxmlDataModel, written
from lumen.features.formats_charts.scxml.log_templates import plain_template, template_of
from lumen.features.formats_charts.scxml.namespaces import LUMEN_NAMESPACE
from lumen.project.formats.behavior_data import ActionData, quoted
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.durations import duration, milliseconds
from lumen.project.formats.foreign_json import foreign_json
from lumen.project.formats.xml_elements import XmlElement

_STATEMENT = re.compile(
    r"(?P<name>[A-Za-z_$][\w$]*)\s*(?:(?P<sign>[-+*/%]?)=(?!=)(?P<value>.+)|(?P<step>\+\+|--))", re.DOTALL
)


def assignments(source: str) -> list[tuple[str, str]] | None:
    """Return the names and values that a script like `x = 1; y += x; z++` assigns, in order.

    Comments are skipped. Return None if the script contains a quotation mark, or a statement of any other form.
    """
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", source, flags=re.DOTALL)
    if "'" in text or '"' in text:
        return None
    found = []
    for statement in filter(None, map(str.strip, text.split(";"))):
        match = _STATEMENT.fullmatch(statement)
        if match is None:
            return None
        name, value = match["name"], match["value"]
        if match["step"]:
            value = f"{name} {match['step'][0]} 1"
        elif match["sign"]:
            value = f"{name} {match['sign']} ({value})"
        found.append((name, value.strip()))
    return found


PROCESSORS = ("", "scxml", "http://www.w3.org/TR/scxml/#SCXMLEventProcessor", "http://www.w3.org/TR/scxml/")
_NOT_CONSTANT = object()
_WAY = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*", re.ASCII)


class LeftOutError(Exception):
    """An element has no counterpart in Lumen; the message and hint are for the document's author."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.message, self.hint = message, hint


class ScxmlActionReader:
    """Reads the actions of one document."""

    def __init__(self, context: ScxmlDataModel, findings: ConversionFindings) -> None:
        self.context, self.findings = context, findings

    def block(self, elements: Iterable[XmlElement]) -> list[ActionData]:
        """Return the elements' actions; report and leave out elements without a counterpart in Lumen."""
        return [action for element in elements for action in self.actions(element)]

    def actions(self, element: XmlElement) -> Iterator[ActionData]:
        """Yield an element's actions; report the element if it has no counterpart in Lumen."""
        try:
            yield from self._actions(element)
        except LeftOutError as error:
            self.findings.lost(element.place, error.message, error.hint)
        except ScriptError as error:
            self.findings.lost(element.place, f"`<{element.tag}>`: {error}")

    def condition(self, source: str) -> str:
        """Translate an ECMAScript condition to a guard. Raises ScriptError if Lumen can't express it."""
        return read_condition(source, self.context.names)

    def _actions(self, element: XmlElement) -> Iterator[ActionData]:
        match element.tag:
            case "raise":
                yield {"raise": self._named(element)}
            case "send":
                yield self._send(element)
            case "cancel":
                yield {"cancel": self._constant(element, "sendid", "sendidexpr")}
            case "log":
                yield {"log": self._text(element)}
            case "assign":
                yield self._assign(element)
            case "if":
                yield from self._if(element)
            case "script":
                yield from self._script(element)
            case tag if tag == f"{{{LUMEN_NAMESPACE}}}action":
                yield own(element)
            case tag:
                raise AssertionError(f"`{tag}` is in no table, so it should have been removed earlier")

    def _text(self, element: XmlElement) -> str:
        try:
            return template_of(element, self.context.names)
        except ScriptError as error:
            source = element.get("expr")
            self.findings.changed(element.place, f"`<log>` writes `{source}` as plain text: {error}")
            return plain_template(element, source)

    def _named(self, element: XmlElement) -> str:
        if not (name := element.get("event")):
            raise LeftOutError(f"`<{element.tag}>` has no event", 'write event="…"')
        return self.context.names.events.get(name, name)

    def _assign(self, element: XmlElement) -> ActionData:
        location = element.get("location").strip()
        id, *within = location.split(".") if _WAY.fullmatch(location) else [location]
        if id not in self.context.keys:
            where = "is not declared" if within or location.isidentifier() else "is not a plain name"
            raise LeftOutError(f"`<assign>` to `{location}`, which {where}", "declare it with `<data>`")
        if element.children:
            raise LeftOutError(f"`<assign>` of XML to `{location}`")
        given = "expr" in element.attributes
        value = self.value(element.get("expr")) if given else quoted(written(element.text))
        return {"assign": {".".join((self.context.keys[id], *within)): value}}

    def _script(self, element: XmlElement) -> Iterator[ActionData]:
        """Yield a script's assignments.

        Raises LeftOutError if it does more than assign to declared names, ScriptError if Lumen can't express a value.
        """
        found = assignments(element.text) if "src" not in element.attributes else None
        keys = self.context.keys
        if found is None or any(name not in keys for name, _ in found):
            raise LeftOutError("`<script>`: Lumen does not run ECMAScript", "use `<assign>` and conditions")
        yield from ({"assign": {keys[name]: self.value(source)}} for name, source in found)

    def value(self, source: str) -> Any:
        """Return an ECMAScript literal as its value, and any other expression in Lumen's language.

        Raises ScriptError if Lumen can't express it.
        """
        read = constant(parse_script(source), _NOT_CONSTANT)
        if read is not _NOT_CONSTANT:
            return quoted(read)
        return unparse(read_value(source, self.context.names))

    def _if(self, element: XmlElement) -> Iterator[ActionData]:
        branches: list[tuple[XmlElement, list[XmlElement]]] = [(element, [])]
        for child in element.children:
            if child.tag in ("elseif", "else"):
                branches.append((child, []))
            else:
                branches[-1][1].append(child)
        conditions = [self.condition(e.get("cond")) if e.tag != "else" else "" for e, _ in branches]
        blocks = [self.block(children) for _, children in branches]
        result: list[ActionData] = []
        for condition, block in reversed(list(zip(conditions, blocks, strict=True))):
            result = [{"if": condition, "then": block} | ({"else": result} if result else {})] if condition else block
        yield from result

    def _send(self, element: XmlElement) -> ActionData:
        event = self._constant(element, "event", "eventexpr")
        event = self.context.names.events.get(event, event)
        target = self._constant(element, "target", "targetexpr", optional=True)
        processor = self._constant(element, "type", "typeexpr", optional=True)
        delay = self._delay(element)
        if processor not in PROCESSORS:
            raise LeftOutError(
                f"`<send>` with the type `{processor}` is left out", "only events to the chart itself are carried over"
            )
        to = target.removeprefix("#_") if target.startswith("#_") and not target.startswith("#_scxml_") else ""
        if target and not to:
            hint = "only events to the chart itself, to `#_parent` and to charts that it invokes are carried over"
            raise LeftOutError(f"`<send>` to `{target}` is left out", hint)
        if "idlocation" in element.attributes:
            raise LeftOutError("`<send>` with `idlocation` is left out", "write `id` instead")
        body: dict[str, Any] = {"event": event}
        if (data := self.data(element)) is not None:
            body["data"] = data
        if target == "#_internal":
            if delay:
                raise LeftOutError("`<send>` to `#_internal` can't have a delay", "delete the target")
            return {"raise": body if len(body) > 1 else event}
        if to:
            body["to"] = to
        if delay:
            body["delay"] = duration(delay)
        if id := element.get("id"):
            body["id"] = id
        return {"send": body if len(body) > 1 else event}

    def _delay(self, element: XmlElement) -> float:
        text = self._constant(element, "delay", "delayexpr", optional=True)
        if (length := milliseconds(text)) is None:
            raise LeftOutError(f"`{text}` is not a delay", "write 500ms or 2s")
        return length

    def _constant(self, element: XmlElement, name: str, computed: str, *, optional: bool = False) -> str:
        """Return the attribute `name`, or the literal in the attribute `computed`, as text.

        Raises LeftOutError if it must be computed or a required one is missing, ScriptError if it can't be parsed.
        """
        if computed in element.attributes:
            source = element.get(computed)
            read = constant(parse_script(source), _NOT_CONSTANT)
            if not isinstance(read, str | int | float) or isinstance(read, bool):
                raise LeftOutError(
                    f"`{computed}` of `<{element.tag}>` is computed, which is not supported: `{source}`",
                    f"write `{name}`",
                )
            return str(read)
        if not element.get(name) and not optional:
            raise LeftOutError(f"`<{element.tag}>` has no `{name}`")
        return element.get(name)

    def data(self, element: XmlElement) -> Any:
        """Return the data that an element sends, from its names, parameters or content; None without any.

        Raises LeftOutError or ScriptError if the data can't be converted.
        """
        found: dict[str, Any] = {}
        for name in element.get("namelist").split():
            found[name] = unparse(read_value(name, self.context.names))
        for param in element.of("param"):
            source = param.get("expr") if "expr" in param.attributes else param.get("location")
            found[param.get("name")] = self.value(source)
        if found:
            return found
        for content in element.of("content"):
            if content.children:
                raise LeftOutError("`<content>` is XML", "write it as JSON")
            return self.value(content.get("expr")) if "expr" in content.attributes else quoted(written(content.text))
        return None


def own(element: XmlElement) -> Any:
    """Return the parsed JSON of an element in Lumen's namespace. Raises LeftOutError if it is invalid."""
    try:
        return foreign_json(element.text)
    except (ValueError, RecursionError):
        raise LeftOutError("this element must contain JSON as Lumen writes it") from None
