"""Fields of published bodies that the route's schema does not have."""

from collections.abc import Mapping

from lumen.expressions.expression_findings import UNKNOWN_FIELD
from lumen.language.actions import PublishBody
from lumen.language.diagnostics import did_you_mean, nearest
from lumen.lint.walk import action_sites
from lumen.project.draft import ProjectDraft


def check(draft: ProjectDraft) -> None:
    """Report fields in bodies of published messages that the route's schema forbids, or that are probably misspelt.

    Only top-level fields are checked, and only if the schema has `properties`. A line that already has a finding gets
    no other.
    """
    routes = draft.settings.routes if draft.settings else {}
    for name, machine in draft.behaviors.items():
        for site in action_sites(machine):
            action = site.step.action
            if isinstance(action, PublishBody) and isinstance(action.body, Mapping) and action.route in routes:
                schema = draft.messages.get(routes[action.route].schema) or {}
                fields = schema.get("properties") or {}
                closed = schema.get("additionalProperties", True) is False
                report, where = draft.report("behaviors", name), (*site.step.where, "publish", "body")
                for key in (key for key in action.body if fields and key not in fields):
                    meant = nearest(key, set(fields) - action.body.keys())
                    line = report.document.place((*where, key), key=True).line
                    if (meant or closed) and not any(d.place.line == line for d in report.diagnostics):
                        message = f"the messages of `{action.route}` have no field `{key}`"
                        report(UNKNOWN_FIELD, (*where, key), message, did_you_mean(key, fields, "they have"), key=True)
