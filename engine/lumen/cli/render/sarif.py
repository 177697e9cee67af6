"""SARIF 2.1.0 (OASIS), which code scanning reads."""

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

import lumen
from lumen.language.diagnostics import Diagnostic, Place, Severity
from lumen.lint.codes import codes
from lumen.lint.fixes import Edit, fixes
from lumen.lint.pages import page
from lumen.run.linting.findings import Findings

_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}
_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"


def render(found: Sequence[Findings], *, coloured: bool = False) -> str:
    """Return a log with one run for each project.

    Files are relative to the project, and the project to its repository.
    """
    log = {"$schema": _SCHEMA, "version": "2.1.0", "runs": [_run(each) for each in found]}
    return json.dumps(log, indent=2)


def _run(found: Findings) -> dict[str, Any]:
    codes = sorted({d.code for d in found.diagnostics})
    run: dict[str, Any] = {
        "tool": {
            "driver": {
                "name": "lumen lint",
                "semanticVersion": lumen.__version__,
                "rules": [_rule(code) for code in codes],
            }
        },
        "columnKind": "unicodeCodePoints",
        "results": [_result(found, d, codes) for d in found.diagnostics],
    }
    if found.root:
        run["originalUriBaseIds"] = _bases(found)
    return run


def _bases(found: Findings) -> dict[str, Any]:
    repository = Path(found.repository)
    inside = os.path.relpath(os.path.abspath(found.root), repository).replace(os.sep, "/")
    here = {"uri": "" if inside == "." else f"{quote(os.fsencode(inside))}/", "uriBaseId": "SRCROOT"}
    return {"PROJECT": here, "SRCROOT": {"uri": repository.absolute().as_uri() + "/"}}


def _rule(code: str) -> dict[str, Any]:
    """Return the description of a code; for a code of another tool only its name."""
    if code not in codes():
        return {"id": code}
    known, found = codes()[code], page(code)
    plain = f"{found.what}\n\n{found.why}"
    example = "\n\n".join(f"Wrong:\n\n```{s.language}\n{s.text}```" for s in found.wrong[:1])
    right = "\n\n".join(f"Right:\n\n```{s.language}\n{s.text}```" for s in found.right[:1])
    return {
        "id": code,
        "shortDescription": {"text": f"{known.summary[0].upper()}{known.summary[1:]}."},
        "fullDescription": {"text": found.what},
        "help": {"text": plain, "markdown": f"{plain}\n\n{example}\n\n{right}"},
        "defaultConfiguration": {"level": _LEVELS[known.severity]},
        "properties": {"tags": [known.family]},
    }


def _result(found: Findings, diagnostic: Diagnostic, codes: Sequence[str]) -> dict[str, Any]:
    said = f"{diagnostic.message}: {diagnostic.hint}" if diagnostic.hint else diagnostic.message
    result: dict[str, Any] = {
        "ruleId": diagnostic.code,
        "ruleIndex": codes.index(diagnostic.code),
        "level": _LEVELS[diagnostic.severity],
        "message": {"text": said},
        "locations": [_location(found, diagnostic.place)],
    }
    if diagnostic.related:
        result["relatedLocations"] = [
            _location(found, r.place) | {"id": i, "message": {"text": r.message}}
            for i, r in enumerate(diagnostic.related, 1)
        ]
    if proposed := fixes(diagnostic, found.files):
        result["fixes"] = [
            {"description": {"text": fix.title}, "artifactChanges": _changes(found, fix.edits)} for fix in proposed
        ]
    return result


def _changes(found: Findings, edits: Sequence[Edit]) -> list[dict[str, Any]]:
    return [
        {
            "artifactLocation": _artifact(found, edit.place.file),
            "replacements": [{"deletedRegion": _region(edit.place), "insertedContent": {"text": edit.text}}],
        }
        for edit in edits
    ]


def _location(found: Findings, place: Place) -> dict[str, Any]:
    return {"physicalLocation": {"artifactLocation": _artifact(found, place.file), "region": _region(place)}}


def _artifact(found: Findings, file: str) -> dict[str, str]:
    uri = quote(file)
    return {"uri": uri, "uriBaseId": "PROJECT"} if found.root else {"uri": uri}


def _region(place: Place) -> dict[str, int]:
    """Return the region of a place; as SARIF requires, its end is the column after the last character."""
    end = (place.end_line, place.end_column)
    end_line, end_column = max(end, (place.line, place.column))
    return {"startLine": place.line, "startColumn": place.column, "endLine": end_line, "endColumn": end_column}
