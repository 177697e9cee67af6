"""How goldens hold findings: what was found and where in one file, its words in a second.

Words are improved more often than rules, so that a change of one leaves the other file as it is.
"""

import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from tests.golden.adapters_language import Diagnostic, findings

Lint = Callable[[Path, Mapping[str, bytes]], tuple[Diagnostic, ...]]


def write_findings(folder: Path, inputs: Iterable[tuple[str, Path, Mapping[str, bytes]]], lint: Lint = findings) -> int:
    """Write findings.json and words.json of these projects (name, root and files); return how many there were."""
    found, words = {}, {}
    for name, root, files in inputs:
        diagnostics = lint(root, files)
        found[name] = [_finding(diagnostic) for diagnostic in diagnostics]
        if diagnostics:
            words[name] = [_words(diagnostic) for diagnostic in diagnostics]
    write_json(folder / "findings.json", found)
    write_json(folder / "words.json", words)
    return len(found)


def write_json(file: Path, data: Any) -> None:
    """Write data as JSON that people can compare."""
    file.write_text(json.dumps(data, indent=1, ensure_ascii=False) + "\n", "utf-8")


def _finding(diagnostic: Diagnostic) -> str:
    related = [_place(one.place) for one in diagnostic.related]
    more = f" | {', '.join(related)}" if related else ""
    return f"{diagnostic.severity} {diagnostic.code} {_place(diagnostic.place)}{more}"


def _place(place: Any) -> str:
    return f"{place.file}:{place.line}:{place.column}-{place.end_line}:{place.end_column}"


def _words(diagnostic: Diagnostic) -> list[str]:
    return [diagnostic.message, diagnostic.hint, *(one.message for one in diagnostic.related)]
