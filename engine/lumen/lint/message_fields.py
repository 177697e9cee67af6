"""A field of a route's messages, as their schema describes it."""

from collections.abc import Mapping, Sequence
from typing import Any

from lumen.expressions.expression_findings import UNKNOWN_FIELD
from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.lint.references import known_route
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft


def field_schema(
    draft: ProjectDraft, report: DocumentReport, path: NodePath, route: str, field: Sequence[str]
) -> Mapping[str, Any] | None:
    """The schema of a field, None where nothing says what it is; an unknown route or field is reported at `path`."""
    if not known_route(draft, report, path, route) or draft.settings is None:
        return None
    schema: Any = draft.messages.get(draft.settings.routes[route].schema)
    for i, step in enumerate(field):
        fields = schema.get("properties") if isinstance(schema, Mapping) else None
        if not isinstance(fields, Mapping):
            return None
        if step not in fields:
            owner = ".".join((route, *field[:i]))
            hint = did_you_mean(step, fields, f"`{owner}` has")
            report(UNKNOWN_FIELD, path, f"the messages of `{owner}` have no field `{step}`", hint)
            return None
        schema = fields[step]
    return schema if isinstance(schema, Mapping) else None
