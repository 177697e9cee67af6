"""Findings for people and for machines: each format a small function from findings to text."""

from collections.abc import Sequence
from typing import Protocol

from lumen.feature import owner, table
from lumen.project.broken_features import called_for_text
from lumen.run.linting.findings import Findings


class Renderer(Protocol):
    """`found` has what to show of each project; `coloured` is whether a terminal shows it."""

    def __call__(self, found: Sequence[Findings], *, coloured: bool = False) -> str: ...


def finding_formats() -> tuple[str, ...]:
    """Return the names of all formats."""
    return tuple(table("finding_formats"))


def render(format: str, found: Sequence[Findings], *, coloured: bool = False) -> str:
    """Return the findings in that format; empty if there are none and the format has no summary.

    Raises LumenError with the name of the package if a format is faulty that was installed beside Lumen.
    """
    where: str = table("finding_formats")[format]
    return called_for_text(owner("finding_formats", format), where, found, coloured=coloured)
