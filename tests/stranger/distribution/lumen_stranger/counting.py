"""Formats that only count."""

from collections.abc import Sequence

from lumen.run.linting.findings import Findings
from lumen.run.verdict import Verdict


def findings(found: Sequence[Findings], *, coloured: bool = False) -> str:
    return f"{sum(len(each.diagnostics) for each in found)} in all"


def verdict(verdict: Verdict) -> str:
    return f"{len(verdict.rehearsals)} played, {verdict.failed} failed"
