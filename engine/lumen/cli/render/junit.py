"""JUnit XML, which continuous integration reads: a test for each file, a failure for each finding."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Sequence

from lumen.app.lint.findings import Findings
from lumen.language.diagnostics import Diagnostic, Severity

_FORBIDDEN = re.compile("[^\t\n\u0020-\u007e\u00a0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def render(found: Sequence[Findings], *, coloured: bool = False) -> str:
    """A suite for each project; a file without findings is a test that passed."""
    root = ET.Element("testsuites", name="lumen lint")
    for each in found:
        _suite(root, each)
    for key in ("tests", "failures"):
        root.set(key, str(sum(int(suite.get(key, 0)) for suite in root)))
    root.set("errors", "0")
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode")


def _suite(root: ET.Element, found: Findings) -> None:
    suite = ET.SubElement(root, "testsuite", name=_clean(found.name("").rstrip("/") or "."))
    by_file: dict[str, list[Diagnostic]] = {file: [] for file in found.asked or found.files}
    for diagnostic in found.diagnostics:
        by_file.setdefault(diagnostic.place.file, []).append(diagnostic)
    for file, diagnostics in by_file.items():
        for diagnostic in diagnostics:
            _case(suite, found.name(file), diagnostic)
        if not diagnostics:
            ET.SubElement(
                suite, "testcase", name=_clean(found.name(file)), classname="lint", file=_clean(found.name(file))
            )
    suite.set("tests", str(len(suite.findall("testcase"))))
    suite.set("failures", str(len(suite.findall("testcase/failure"))))
    suite.set("errors", "0")


def _case(suite: ET.Element, file: str, diagnostic: Diagnostic) -> None:
    """One finding: a failure, but what is only to be known says so and passes."""
    name = f"{file}:{diagnostic.place.line}:{diagnostic.place.column} {diagnostic.code}"
    case = ET.SubElement(suite, "testcase", name=_clean(name), classname=f"lint.{diagnostic.code}")
    case.set("file", _clean(file))
    case.set("line", str(diagnostic.place.line))
    said = f"{diagnostic.message} ({diagnostic.hint})" if diagnostic.hint else diagnostic.message
    if diagnostic.severity is Severity.INFO:
        ET.SubElement(case, "system-out").text = _clean(said)
        return
    failure = ET.SubElement(case, "failure", message=_clean(diagnostic.message), type=str(diagnostic.severity))
    related = [f"{r.place}: {r.message}" for r in diagnostic.related]
    failure.text = _clean("\n".join([f"{file}:{diagnostic.place.line}:{diagnostic.place.column}: {said}", *related]))


def _clean(said: str) -> str:
    """The text without the characters that XML does not have, and those that move a cursor."""
    return _FORBIDDEN.sub("\ufffd", said)
