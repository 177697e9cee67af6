"""Verdicts for people and for machines: each format a small function from a verdict to text."""

from collections.abc import Callable, Mapping

from lumen.cli.verdict import Verdict
from lumen.cli.verdicts.json import render as render_json
from lumen.cli.verdicts.junit import render as render_junit
from lumen.cli.verdicts.text import render as render_text

FORMATS: Mapping[str, Callable[[Verdict], str]] = {
    "text": render_text,
    "json": render_json,
    "junit": render_junit,
}
