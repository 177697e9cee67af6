"""Write JUnit XML for continuous integration: suites of test cases, each of which passed or failed."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from typing import NamedTuple

_FORBIDDEN = re.compile("[^\t\n\u0020-\u007e\u00a0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


class JunitFailure(NamedTuple):
    """The reason why a case failed: one line, and the details."""

    message: str
    details: str
    type: str = "AssertionError"


class JunitCase(NamedTuple):
    """A test. It passed if `failure` is None. `attributes` are its `time` [s], `file` and `line`, if they are known."""

    name: str
    classname: str
    attributes: Mapping[str, str] = {}
    failure: JunitFailure | None = None
    output: str = ""


class JunitSuite(NamedTuple):
    """Tests that belong together; `took` is the time that they ran [s], None if they were not run."""

    name: str
    cases: Sequence[JunitCase]
    took: float | None = None
    properties: Mapping[str, str] = {}


def junit_xml(name: str, suites: Sequence[JunitSuite], took: float | None = None) -> str:
    """Return the document of a run that `took` this long [s]; characters that XML forbids are replaced."""
    root = ET.Element("testsuites", name=_clean(name))
    for suite in suites:
        _add_suite(root, suite)
    _set_counts(root, [case for suite in suites for case in suite.cases])
    if took is not None:
        root.set("time", f"{took:.3f}")
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode")


def _add_suite(root: ET.Element, suite: JunitSuite) -> None:
    element = ET.SubElement(root, "testsuite", name=_clean(suite.name))
    if suite.took is not None:
        element.set("time", f"{suite.took:.3f}")
    _set_counts(element, suite.cases)
    if suite.took is not None:
        element.set("skipped", "0")
    if suite.properties:
        properties = ET.SubElement(element, "properties")
        for key, value in suite.properties.items():
            ET.SubElement(properties, "property", name=key, value=value)
    for case in suite.cases:
        _add_case(element, case)


def _set_counts(element: ET.Element, cases: Sequence[JunitCase]) -> None:
    element.set("tests", str(len(cases)))
    element.set("failures", str(sum(case.failure is not None for case in cases)))
    element.set("errors", "0")


def _add_case(suite: ET.Element, case: JunitCase) -> None:
    attributes = {key: _clean(value) for key, value in case.attributes.items()}
    element = ET.SubElement(
        suite, "testcase", {"name": _clean(case.name), "classname": _clean(case.classname), **attributes}
    )
    if case.output:
        ET.SubElement(element, "system-out").text = _clean(case.output)
    if case.failure:
        message, details, kind = case.failure
        ET.SubElement(element, "failure", message=_clean(message), type=kind).text = _clean(details)


def _clean(said: str) -> str:
    return _FORBIDDEN.sub("\ufffd", said)
