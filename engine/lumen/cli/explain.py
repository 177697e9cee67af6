"""`lumen explain`: what a code means, why it matters, an example of what is wrong and of what is right."""

import argparse
import json
from collections.abc import Iterator
from typing import Any

from lumen.cli.terminal import coloured, paint
from lumen.errors import UsageError
from lumen.language.diagnostics import Severity
from lumen.rules.codes import CODES, FAMILIES
from lumen.rules.pages import Page, Example, page
from lumen.rules.selection import unknown_code

_COLOURS = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.INFO: "blue"}


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("code", nargs="?", metavar="CODE", help="as lint prints it; default: list all, by family")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="how to print it (default: text)")


def run(options: argparse.Namespace) -> int:
    code = options.code and options.code.strip("[]`")
    if code and code not in CODES and code not in FAMILIES:
        raise UsageError(unknown_code(code))
    if code in CODES:
        found = page(code)
        print(json.dumps(_as_json(found), indent=2) if options.format == "json" else _text(found, coloured()))
    else:
        families = [code] if code else list(FAMILIES)
        print(_json_list(families) if options.format == "json" else _list(families, coloured()))
    return 0


def family(code: str) -> str:
    """The family that a code belongs to."""
    return next(name for name, codes in FAMILIES.items() if code in codes)


def _list(families: list[str], on: bool) -> str:
    width = max(len(code) for name in families for code in FAMILIES[name])
    blocks = []
    for name in families:
        rows = [
            f"  {paint(f'{code:{width}}', _COLOURS[entry.severity], on=on)}  {entry.summary}"
            for code, entry in FAMILIES[name].items()
        ]
        blocks.append("\n".join([paint(name, "bold", on=on), *rows]))
    return "\n\n".join([*blocks, "`lumen explain CODE` says more."])


def _json_list(families: list[str]) -> str:
    return json.dumps({"codes": [_entry(code) for name in families for code in FAMILIES[name]]}, indent=2)


def _entry(code: str) -> dict[str, Any]:
    severity, summary = CODES[code]
    return {"code": code, "family": family(code), "severity": str(severity), "summary": summary}


def _as_json(found: Page) -> dict[str, Any]:
    return {
        **_entry(found.code),
        "what": found.what,
        "why": found.why,
        "wrong": [{"file": s.file, "text": s.text, "mark": s.mark and s.mark._asdict()} for s in found.wrong],
        "right": [{"file": s.file, "text": s.text} for s in found.right],
    }


def _text(found: Page, on: bool) -> str:
    severity = CODES[found.code].severity
    title = f"{paint(found.code, 'bold', _COLOURS[severity], on=on)}  {severity}, {family(found.code)}"
    wrong = "\n\n".join("\n".join(_sheet(sheet, on)) for sheet in found.wrong)
    right = "\n\n".join("\n".join(_sheet(sheet, on)) for sheet in found.right)
    return "\n\n".join(
        (title, found.what, found.why, paint("Wrong:", "bold", on=on), wrong, paint("Right:", "bold", on=on), right)
    )


def _sheet(sheet: Example, on: bool) -> Iterator[str]:
    """The lines of an example, the wrong word underlined."""
    yield f"  {paint(sheet.file, 'bold', on=on)}" + (f" ({_NOTES[sheet.note]})" if sheet.note else "")
    for number, line in enumerate(sheet.text.splitlines(), 1):
        yield f"  {paint(f'{number:2} |', 'dim', on=on)} {line}".replace("\t", "\u2192").rstrip()
        if sheet.mark and sheet.mark.line == number:
            width = max(1, sheet.mark.last - sheet.mark.first)
            yield f"  {paint('   |', 'dim', on=on)} {' ' * (sheet.mark.first - 1)}{paint('^' * width, 'red', on=on)}"


_NOTES = {"latin-1": "saved as Latin-1", "folder": "a folder of that name", "none": "not there"}
