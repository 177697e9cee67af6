"""Read `invoke` of a state: the behaviours that run while it is active."""

from collections.abc import Iterator
from itertools import combinations
from typing import Any

from lumen.language.diagnostics import NodePath
from lumen.language.machines import Invoke, StateKind
from lumen.project.document_report import DocumentReport
from lumen.project.expressions import Expressions
from lumen.project.outline import DUPLICATE_ID, BehaviorOutline, OutlinedState


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
    """Report two behaviours that can run at the same time and have the same id."""
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
