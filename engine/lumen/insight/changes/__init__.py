"""The semantic diff of two bundles: the changes of a reload as sentences, each with a risk."""

from lumen.insight.changes.change import Change, Risk
from lumen.insight.changes.projects import change_data, changes, risk, summary
from lumen.insight.changes.sections import RESTART_FIELDS, live

__all__ = ["RESTART_FIELDS", "Change", "Risk", "change_data", "changes", "live", "risk", "summary"]
