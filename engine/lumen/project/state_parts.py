"""Parts of a state or story, read from plain data: `invoke`, `buttons` and `properties`."""

from collections.abc import Callable, Iterator, Mapping
from itertools import combinations
from typing import Any, NamedTuple

from lumen.expressions import check_expression
from lumen.expressions.own_functions import KnownFunctions, expanded
from lumen.language.actions import Expression
from lumen.language.buttons import Button, button_events
from lumen.language.diagnostics import NodePath
from lumen.language.machines import Invoke, StateKind
from lumen.language.properties import Property
from lumen.project.complaints import ONE_VERB
from lumen.project.document_report import DocumentReport
from lumen.project.expressions import Expressions, expanded_here, place_within
from lumen.project.outline import DUPLICATE_ID, BehaviorOutline, OutlinedState
from lumen.project.routes import duration
from lumen.project.sections import read_fields


class ReadButton(NamedTuple):
    """A button of a state."""

    button: Button
    actions: Any = None
    """The data of the button's actions; None if it only sends an event that is handled elsewhere."""


def read_buttons(data: Any, where: NodePath, state: str) -> tuple[ReadButton, ...]:
    """Return the buttons that can be read, in the order of the file; `state` is the name of their state."""
    rows = [row if isinstance(row, Mapping) and row.get("label") else {} for row in data or ()]
    labels = [_label(row.get("label", "")) for row in rows]
    own = button_events(state, labels)
    found = []
    for number, (row, label) in enumerate(zip(rows, labels, strict=True)):
        event = row.get("event") or ("actions" in row and own[number])
        if row and event:
            key, place = str(row.get("key", "")), (*where, number)
            button = read_fields(Button, {**row, "event": event}, label=label, key=key, where=place)
            found.append(ReadButton(button, row.get("actions")))
    return tuple(found)


def _label(texts: Any) -> dict[str, str]:
    """Return texts by language; a text that serves all languages has the empty key."""
    table = {"": texts} if isinstance(texts, str) else texts
    return {"" if language == "any" else language: str(text) for language, text in table.items()}


ReadCondition = Callable[[str, NodePath], Expression | None]


def build_properties(data: Mapping[str, Any], report: DocumentReport, read: ReadCondition) -> tuple[Property, ...]:
    """Return the properties that can be read, in the order of the file; report the others."""
    found = []
    for name, row in (data.get("properties") or {}).items():
        where = ("properties", name)
        said = [key for key in ("always", "eventually") if key in row]
        if not said and report.broken(where):
            continue
        if len(said) != 1:
            hint = "write `always:` and a condition, or `eventually:` and `within:`; to use both, add another property"
            report(ONE_VERB, where, f"`{name}` needs exactly one condition: `always` or `eventually`", hint, key=True)
            continue
        conditions = {key: read(row[key], (*where, key)) for key in ("always", "eventually", "whenever") if key in row}
        within = duration(row, "within", report, where) if "within" in row else 0.0
        if None not in conditions.values() and within is not None:
            found.append(Property(name, **conditions, within=within, where=where))
    return tuple(found)


def unbound_conditions(report: DocumentReport, functions: KnownFunctions) -> ReadCondition:
    """Return a reader of conditions for a file that does not declare the names in them, such as a story.

    The reader returns None for a faulty condition, which it reports.
    """

    def read(source: str, where: NodePath) -> Expression | None:
        findings = check_expression(source, context=None, functions=functions)
        for finding in findings:
            place = place_within(report.document, where, source, finding.offset, finding.length)
            report.diagnostics.append(finding.code.at(place, finding.message, finding.hint))
        meant = None if findings else expanded_here(expanded, source, functions, report, where)
        return None if meant is None else Expression(meant, where, source if meant != source else "")

    return read


def invocations(entry: OutlinedState, expressions: Expressions) -> tuple[Invoke, ...]:
    """Return the behaviours that a state invokes, in the order of the file."""
    found = []
    for where, id, row in invoked(entry):
        data = row.get("input") or {}
        values = {key: expressions.value(value, (*where, "input", key)) for key, value in data.items()}
        found.append(Invoke(id, row["behavior"], values, where))
    return tuple(found)


def invoked(entry: OutlinedState) -> Iterator[tuple[NodePath, str, dict[str, Any]]]:
    """Yield the path, the id and the data of each item under `invoke`."""
    body, where = entry.data.get("invoke"), (*entry.where, "invoke")
    rows = [((*where, i), row) for i, row in enumerate(body)] if isinstance(body, list) else [(where, body)]
    for place, row in rows:
        if row:
            yield place, row.get("id") or row["behavior"], row


def check_ids(outline: BehaviorOutline, report: DocumentReport) -> None:
    """Report invoked behaviours that can run at the same time and have the same id."""
    found: dict[str, list[tuple[OutlinedState, NodePath]]] = {}
    for entry in outline.entries.values():
        for where, id, row in invoked(entry):
            found.setdefault(id, []).append((entry, (*where, "id" if "id" in row else "behavior")))
    for id, uses in found.items():
        said: set[NodePath] = set()
        for (one, _), (other, where) in combinations(uses, 2):
            if where not in said and _together(one, other):
                said.add(where)
                message = f"{one.title} also invokes a behaviour as `{id}`, and both can run at once"
                report(DUPLICATE_ID, where, message, hint="give each `invoke` a different `id`")


def _together(one: OutlinedState, other: OutlinedState) -> bool:
    """Return True if two states can be active at the same time."""
    inner = other
    while not one.lies_in(inner):
        assert inner.parent is not None  # every state lies in the root
        inner = inner.parent
    return inner is one or inner is other or inner.kind is StateKind.PARALLEL
