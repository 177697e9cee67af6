"""Diagnostics for people and for machines: each format a small function from findings to text."""

from collections.abc import Mapping, Sequence
from typing import Protocol

from lumen.cli.render.json import render as render_json
from lumen.cli.render.text import render as render_text
from lumen.language.diagnostics import Diagnostic


class Renderer(Protocol):
    """`files` are the project's, for excerpts; `coloured` is whether a terminal shows it."""

    def __call__(self, diagnostics: Sequence[Diagnostic], files: Mapping[str, bytes], *, coloured: bool) -> str: ...


FORMATS: Mapping[str, Renderer] = {"text": render_text, "json": render_json}
