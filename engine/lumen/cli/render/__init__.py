"""Formats of findings, for people and for programs: each is a function from findings to text."""

from collections.abc import Sequence
from typing import Protocol

from lumen.feature import owner, table
from lumen.project.broken_features import called_for_text
from lumen.run.linting.findings import Findings


class Renderer(Protocol):
    """A function from the findings of each project to text; `coloured` adds the escape sequences of a terminal."""

    def __call__(self, found: Sequence[Findings], *, coloured: bool = False) -> str: ...


def finding_formats() -> tuple[str, ...]:
    """Return the names of all formats."""
    return tuple(table("finding_formats"))


def render(format: str, found: Sequence[Findings], *, coloured: bool = False) -> str:
    """Return the findings in this format, one of `finding_formats()`.

    Raises LumenError with the name of the package if the format belongs to another package and is faulty.
    """
    where: str = table("finding_formats")[format]
    return called_for_text(owner("finding_formats", format), where, found, coloured=coloured)
