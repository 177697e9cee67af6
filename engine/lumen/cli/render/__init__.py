"""Findings for people and for machines: each format a small function from findings to text."""

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Protocol, cast

from lumen.app.lint.findings import Findings


class Renderer(Protocol):
    """`found` has what to show of each project; `coloured` is whether a terminal shows it."""

    def __call__(self, found: Sequence[Findings], *, coloured: bool = False) -> str: ...


FORMATS: Mapping[str, str] = {
    "text": "with the line of the file, for people",
    "concise": "a line for each finding",
    "json": "one object, for programs",
    "sarif": "SARIF 2.1.0, for code scanning",
    "github": "annotations for GitHub Actions",
    "junit": "JUnit XML, for continuous integration",
}
"""Each format, and what it is for; it is the module of its name here."""


def render(format: str, found: Sequence[Findings], *, coloured: bool = False) -> str:
    """The findings in that format; empty where there are none and the format has no summary."""
    module = import_module(f"lumen.cli.render.{format}")
    return cast(Renderer, module.render)(found, coloured=coloured)
