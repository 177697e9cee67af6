"""A verdict as JUnit XML, which continuous integration reads."""

import re
import xml.etree.ElementTree as ET

from lumen.app.exploring import Explored
from lumen.app.rehearsal import Rehearsal
from lumen.cli.verdict import Verdict
from lumen.cli.verdicts import text

_FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def render(verdict: Verdict) -> str:
    """A suite of the stories and, where the behaviour was explored, one of what was found."""
    root = ET.Element("testsuites", name=_clean(verdict.name))
    if verdict.rehearsals or not verdict.explored:
        stories = _suite(root, "stories", sum(r.took for r in verdict.rehearsals))
        for rehearsal in verdict.rehearsals:
            _story(stories, rehearsal)
        _properties(stories, verdict)
        _count(stories)
    if verdict.explored:
        _explored(_suite(root, "explore", verdict.explored.took), verdict.explored)
    for key in ("tests", "failures", "errors"):
        root.set(key, str(sum(int(suite.get(key, 0)) for suite in root)))
    root.set("time", f"{verdict.took:.3f}")
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode")


def _suite(root: ET.Element, name: str, took: float) -> ET.Element:
    return ET.SubElement(root, "testsuite", name=name, time=f"{took:.3f}")


def _count(suite: ET.Element) -> None:
    suite.set("tests", str(len(suite.findall("testcase"))))
    suite.set("failures", str(len(suite.findall("testcase/failure"))))
    suite.set("errors", "0")
    suite.set("skipped", "0")


def _story(suite: ET.Element, rehearsal: Rehearsal) -> None:
    file = f"behaviors/stories/{rehearsal.story.name}.yaml"
    case = ET.SubElement(
        suite, "testcase", name=_clean(rehearsal.story.name), classname="stories", time=f"{rehearsal.took:.3f}"
    )
    case.set("file", _clean(file))
    if failed := rehearsal.failed:
        case.set("line", str(rehearsal.place.line if rehearsal.place else 1))
        _failure(case, failed.what, text.story(rehearsal))


def _properties(suite: ET.Element, verdict: Verdict) -> None:
    if verdict.coverage is None:
        return
    counts = {"states": verdict.coverage.states, "transitions": verdict.coverage.transitions}
    properties = ET.Element("properties")
    for what, (some, every) in counts.items():
        ET.SubElement(properties, "property", name=f"coverage.{what}", value=f"{some} of {every}")
    suite.insert(0, properties)
    if verdict.uncovered:
        case = ET.SubElement(suite, "testcase", name="coverage", classname="coverage", time="0")
        said = f"{verdict.coverage.percent:.1f} % is covered, and {verdict.wanted:g} % wanted"
        _failure(case, said, "\n".join(f"{gap.place}: {gap.what}" for gap in verdict.coverage.gaps()))


def _explored(suite: ET.Element, explored: Explored) -> None:
    findings = explored.findings
    for finding in findings:
        case = ET.SubElement(suite, "testcase", name=_clean(finding.message), classname=explored.behavior, time="0")
        case.set("file", finding.place.file)
        case.set("line", str(finding.place.line))
        _failure(case, finding.message, finding.story)
    if not findings:
        ET.SubElement(suite, "testcase", name=explored.behavior, classname="explore", time=f"{explored.took:.3f}")
    _count(suite)


def _failure(case: ET.Element, message: str, details: str) -> None:
    failure = ET.SubElement(case, "failure", message=_clean(message), type="AssertionError")
    failure.text = _clean(details)


def _clean(said: str) -> str:
    """The text without the characters that XML does not have."""
    return _FORBIDDEN.sub("\ufffd", said)
