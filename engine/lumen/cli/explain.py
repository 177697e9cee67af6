"""`lumen explain`: print what a code means, why it matters, and a wrong and a right example."""

import argparse
import json
from collections.abc import Collection, Iterator
from typing import Any

from lumen.cli.render.terminal_text import SEVERITY_COLOURS
from lumen.cli.terminal import coloured, paint
from lumen.language.text_lines import lines_of
from lumen.lint.codes import codes, families
from lumen.lint.pages import Example, Page, page
from lumen.lint.selection import selected
from lumen.project.formats.conversion_findings import CODE_MEANINGS


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen explain` to its parser."""
    parser.add_argument(
        "code",
        nargs="?",
        metavar="CODE",
        help="a lint code, the first letters of several codes, or a family (default: all codes)",
    )
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Print the page of a code, or list the codes that the word selects; without a word, list all. Return 0.

    A word selects a family, or the codes that begin with it. Raises UsageError if it selects none.
    """
    word = (options.code or "").strip("[]`")
    json_wanted = options.format == "json"
    if word in codes():
        found = page(word)
        print(json.dumps(_as_json(found), indent=2) if json_wanted else _text(found, coloured()))
    elif word in CODE_MEANINGS:
        what = CODE_MEANINGS[word]
        print(json.dumps({"code": word, "what": what}, indent=2) if json_wanted else f"{word}\n\n{what}")
    else:
        wanted = selected([word]) if word else codes().keys()
        print(_json_list(wanted) if json_wanted else _list(wanted, coloured()))
    return 0


def _list(wanted: Collection[str], on: bool) -> str:
    width = max(map(len, wanted))
    blocks = []
    for name, members in families().items():
        rows = [
            f"  {paint(f'{code:{width}}', SEVERITY_COLOURS[entry.severity], on=on)}  {entry.summary}"
            for code, entry in members.items()
            if code in wanted
        ]
        blocks += ["\n".join([paint(name, "bold", on=on), *rows])] if rows else []
    return "\n\n".join([*blocks, "Run `lumen explain CODE` for details and an example."])


def _json_list(wanted: Collection[str]) -> str:
    return json.dumps({"codes": [_entry(code) for code in codes() if code in wanted]}, indent=2)


def _entry(code: str) -> dict[str, Any]:
    known = codes()[code]
    return {"code": code, "family": known.family, "severity": str(known.severity), "summary": known.summary}


def _as_json(found: Page) -> dict[str, Any]:
    return {
        **_entry(found.code),
        "what": found.what,
        "why": found.why,
        "wrong": [{"file": s.file, "text": s.text, "mark": s.mark and s.mark._asdict()} for s in found.wrong],
        "right": [{"file": s.file, "text": s.text} for s in found.right],
    }


def _text(found: Page, on: bool) -> str:
    severity, family = codes()[found.code].severity, codes()[found.code].family
    title = f"{paint(found.code, 'bold', SEVERITY_COLOURS[severity], on=on)}  {severity}, {family}"
    blocks = [title, found.what, found.why]
    for heading, sheets in (("Wrong:", found.wrong), ("Right:", found.right)):
        if sheets:
            blocks += [paint(heading, "bold", on=on), *("\n".join(_sheet(sheet, on)) for sheet in sheets)]
    return "\n\n".join(filter(None, blocks))


def _sheet(sheet: Example, on: bool) -> Iterator[str]:
    """Yield the lines of an example, with the wrong word underlined."""
    yield f"  {paint(sheet.file, 'bold', on=on)}" + (f" ({_NOTES[sheet.note]})" if sheet.note else "")
    for number, line in enumerate(lines_of(sheet.text.rstrip("\n")), 1):
        yield f"  {paint(f'{number:2} |', 'dim', on=on)} {line}".replace("\t", "\u2192").rstrip()
        if sheet.mark and sheet.mark.line == number:
            width = max(1, sheet.mark.last - sheet.mark.first)
            yield f"  {paint('   |', 'dim', on=on)} {' ' * (sheet.mark.first - 1)}{paint('^' * width, 'red', on=on)}"


_NOTES = {
    "latin-1": "saved as Latin-1",
    "folder": "a folder of that name",
    "none": "not there",
    "before": "as it runs",
    "physics": "found with --physics",
    "whole": "the whole file",
    "installed": "of an installed package",
}
