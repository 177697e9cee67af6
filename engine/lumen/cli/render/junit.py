"""JUnit XML: a test for each file, a failure for each finding."""

from collections.abc import Iterator, Sequence

from lumen.cli.junit_xml import JunitCase, JunitFailure, JunitSuite, junit_xml
from lumen.language.diagnostics import Diagnostic, Severity
from lumen.run.linting.findings import Findings


def render(found: Sequence[Findings], *, coloured: bool = False) -> str:
    """Return a suite for each project, in which a file without findings is a passed test."""
    suites = [JunitSuite(each.name("").rstrip("/") or ".", list(_cases(each))) for each in found]
    return junit_xml("lumen lint", suites)


def _cases(found: Findings) -> Iterator[JunitCase]:
    by_file: dict[str, list[Diagnostic]] = {file: [] for file in found.asked or found.files}
    for diagnostic in found.diagnostics:
        by_file.setdefault(diagnostic.place.file, []).append(diagnostic)
    for file, diagnostics in by_file.items():
        name = found.name(file)
        yield from (_case(name, diagnostic) for diagnostic in diagnostics)
        if not diagnostics:
            yield JunitCase(name, "lint", {"file": name})


def _case(file: str, diagnostic: Diagnostic) -> JunitCase:
    """Return a finding as a failure; a note is a passed case with the text as its output."""
    place = f"{file}:{diagnostic.place.line}:{diagnostic.place.column}"
    attributes = {"file": file, "line": str(diagnostic.place.line)}
    case = JunitCase(f"{place} {diagnostic.code}", f"lint.{diagnostic.code}", attributes)
    said = f"{diagnostic.message} ({diagnostic.hint})" if diagnostic.hint else diagnostic.message
    if diagnostic.severity is Severity.INFO:
        return case._replace(output=said)
    details = "\n".join([f"{place}: {said}", *(f"{r.place}: {r.message}" for r in diagnostic.related)])
    return case._replace(failure=JunitFailure(diagnostic.message, details, str(diagnostic.severity)))
