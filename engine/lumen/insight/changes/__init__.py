"""The semantic diff of two bundles: what a reload would change, as sentences with a risk each."""

from lumen.insight.changes.change import Change, Risk
from lumen.insight.changes.projects import change_data, changes, risk, summary
from lumen.insight.changes.restart_fields import RESTART_FIELDS, live

__all__ = ["RESTART_FIELDS", "Change", "Risk", "change_data", "changes", "live", "risk", "summary"]
