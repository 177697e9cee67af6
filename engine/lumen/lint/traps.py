"""Values that YAML reads in an unintended way: words for true and false, numbers, quotes; and unfilled placeholders."""

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import repeat

from lumen.language.actions import SayText
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath
from lumen.language.machines import MachineDefinition
from lumen.language.text_lines import LineIndex, lines_of
from lumen.lint.walk import action_sites
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

CURLY_QUOTES = Code("curly-quotes", "text", WARNING, "curly quotes are used where YAML needs straight ones")
LOOKS_LIKE_NUMBER = Code(
    "looks-like-number", "text", WARNING, "a value looks like a number, but is read as another number or as a text"
)
LOOKS_LIKE_TRUTH = Code("looks-like-truth", "text", WARNING, "`yes`, `no`, `on` or `off` is a text, not true or false")
NOT_FILLED_IN = Code("not-filled-in", "speech", WARNING, "the robot would say the name of a value instead of the value")


_TRUTHS = {"yes": "true", "on": "true", "y": "true", "no": "false", "off": "false", "n": "false"}
_TRUTH = re.compile(r"(?i)(?<=[:,\[-] )(yes|no|on|off|y|n)(?=\s|[,}\]]|$)", re.MULTILINE)
_ZERO, _ZEROS = re.compile(r"0(?<=[ \[,+-]0)\d"), re.compile(r"[-+]?0\d+")  # _ZERO finds lines, quickly
_GROUP, _GROUPED = re.compile(r"_(?<=\d_)\d"), re.compile(r"[-+]?\d{1,3}(?:_\d{3})+")
_CURLY = re.compile("[“”„‘’«»]")
_PAIRS = {"“": "”", "”": "”", "„": "“”", "‘": "’", "«": "»"}
_DATA = ("context", "data", "body", "robot")
_HALF = re.compile(r"(?<!\{)\$?\{\s*((?:context|event|state)\.[\w.]+)\s*\}(?!\})")
_SIGNS = re.compile(r"(?:<|%|\[)\s*((?:context|event|state)\.[\w.]+)\s*(?:>|%|\])")
"""Matches a placeholder for a value of Lumen in another tool's brackets."""
_OF_OTHERS = re.compile(
    r"\{%.*?%\}|\{#.*?#\}|[$#]\{\s*(?P<certain>\w+)\s*\}|(?<!\{)\{\s*(?P<braces>[^\W\d]\w*)\s*\}(?!\})"
    r"|%\((?P<percent>\w+)\)s|%(?P<signs>\w+)%|\$(?P<dollar>\w+)|<(?P<angles>\w+)>|\[(?P<square>\w+)\]"
)
"""Matches a placeholder or a condition in the form of Python, JavaScript, Jinja, Liquid or a shell."""
_BARE = re.compile(r"(?:context|event\.data)\.\w+(?:\.\w+)*")


def check(draft: ProjectDraft) -> None:
    """Report values probably meant as truth values, numbers or quoted texts, and unfilled placeholders."""
    for file, report in draft.reports.items():
        report.memoize(("traps", file), None, partial(_values, report))
    for name, machine in draft.behaviors.items():
        _holes(machine, draft.report("behaviors", name))


def _values(report: DocumentReport) -> None:
    _strange(report)
    for pattern, look in ((_TRUTH, _truth), (_ZERO, _number), (_GROUP, _number), (_CURLY, _quotes)):
        if lines := _lines(report.document.text, pattern):
            for path, source, value in list(_plain(report, lines)):
                look(report, path, source, value)


def _lines(text: str, pattern: re.Pattern[str]) -> set[int]:
    """Return the numbers of the lines in which a pattern is found."""
    found = [match.start() for match in pattern.finditer(text)]
    index = LineIndex(text) if found else None
    return set(map(index.line, found)) if index else set()


def _plain(report: DocumentReport, wanted: set[int]) -> Iterator[tuple[NodePath, str, object]]:
    """Yield every unquoted value in one of these lines: its path, its source text, and its value."""
    lines = lines_of(report.document.text)
    for path, span in report.document.spans.items():
        place = span.value
        if place.line in wanted and path and place.line == place.end_line:
            source = lines[place.line - 1][place.column - 1 : place.end_column - 1]
            if source and source[0] not in "'\"[{|>&*!":
                yield path, source, report.document.find(path)


def _truth(report: DocumentReport, path: NodePath, source: str, value: object) -> None:
    """Report a word such as `no` in data, where true or false may be meant; among phrases it is an ordinary word."""
    if isinstance(value, str) and (meant := _TRUTHS.get(value.lower())) and any(key in _DATA for key in path[:-1]):
        hint = f'write `{meant}`, or put it in quotes if you mean the text: "{value}"'
        report(LOOKS_LIKE_TRUTH, path, f"this is the text `{value}`, not `{meant}`", hint)


def _number(report: DocumentReport, path: NodePath, source: str, value: object) -> None:
    if isinstance(value, int) and not isinstance(value, bool) and _ZEROS.fullmatch(source):
        hint = f'write `{value}`, `0o{source.lstrip("+-0")}` for an octal number, or "{source}" for a text'
        report(LOOKS_LIKE_NUMBER, path, f"`{source}` is the number {value}: leading zeros are ignored", hint)
    elif isinstance(value, str) and _GROUPED.fullmatch(source) and any(key in _DATA for key in path[:-1]):
        hint = f"write `{source.replace('_', '')}`, or put it in quotes if you mean the text"
        report(LOOKS_LIKE_NUMBER, path, f"`{source}` is a text, not a number", hint)


def _quotes(report: DocumentReport, path: NodePath, source: str, value: object) -> None:
    closing = _PAIRS.get(source[:1], "")
    place = report.document.place(path)
    if any(d.place.line == place.line and d.place.column == place.column for d in report.diagnostics):
        return  # the value has a finding already
    if isinstance(value, str) and len(source) > 1 and source[-1] in closing and not _CURLY.search(source[1:-1]):
        hint = f'write straight quotes: "{source[1:-1]}"'
        report(CURLY_QUOTES, path, "these quotes are part of the text: YAML accepts only straight ones", hint)


def _strange(report: DocumentReport) -> None:
    """Replace the hints of errors that curly quotes caused."""
    if not _CURLY.search(report.document.text):
        return
    lines = lines_of(report.document.text)
    for i, found in enumerate(report.diagnostics):
        start, line = found.place.column - 1, lines[found.place.line - 1]
        said = line[start : found.place.end_column - 1] if found.place.line == found.place.end_line else ""
        if found.severity is ERROR and _CURLY.search(said[:1] + said[-1:]):
            hint = "write straight quotes: YAML and expressions accept only these"
            report.diagnostics[i] = replace(found, hint=hint)


def _holes(machine: MachineDefinition, report: DocumentReport) -> None:
    """Report texts that would say the name of a value instead of the value."""
    for site in action_sites(machine):
        if isinstance(site.step.action, SayText):
            for template in (t for texts in site.step.action.texts.values() for t in texts):
                said = template.shown
                if foreign := next((f for f in map(_foreign, _OF_OTHERS.finditer(said), repeat(machine)) if f), None):
                    report(NOT_FILLED_IN, template.where, f"the robot would say `{foreign[0]}` literally", foreign[1])
                elif found := _HALF.search(said) or _SIGNS.search(said) or _BARE.fullmatch(said):
                    name = found[0] if found.re is _BARE else found[1]
                    message = f"the robot would say `{found[0]}` literally"
                    report(NOT_FILLED_IN, template.where, message, f"write `{{{{ {name} }}}}`")


def _foreign(found: re.Match[str], machine: MachineDefinition) -> tuple[str, str] | None:
    """Return a placeholder in another tool's form, and the hint; None if it may be meant as ordinary text."""
    if found[0].startswith("{%"):
        return found[0], "texts have no `{% … %}`: write `{{ CONDITION ? 'one text' : 'another' }}`"
    if found[0].startswith("{#"):
        return found[0], "texts have no `{# … #}`: write a YAML comment, `# …`, outside the text"
    form, name = next((form, name) for form, name in found.groupdict().items() if name)
    if name in machine.context:
        return found[0], f"write `{{{{ context.{name} }}}}`"
    if form in ("certain", "braces"):
        return found[0], f"write `{{{{ context.NAME }}}}`; `context` has no `{name}`"
    return None
