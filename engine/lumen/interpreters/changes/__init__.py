"""The semantic diff of two bundles: what a reload would change, as sentences with a risk each."""

from lumen.interpreters.changes.change import Change, Risk
from lumen.interpreters.changes.fixed import FIXED, live
from lumen.interpreters.changes.projects import changes, risk, summary

__all__ = ["FIXED", "Change", "Risk", "changes", "live", "risk", "summary"]
