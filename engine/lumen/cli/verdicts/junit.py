"""A verdict as JUnit XML."""

from collections.abc import Iterator

from lumen.cli.junit_xml import JunitCase, JunitFailure, JunitSuite, junit_xml
from lumen.cli.verdicts import text
from lumen.run.exploring import Explored
from lumen.run.rehearsal import Rehearsal
from lumen.run.verdict import JudgedExample, JudgedSaying, Verdict


def render(verdict: Verdict) -> str:
    """Return a suite for the stories, one for the sayings, one for the functions, and one for the exploration."""
    suites = []
    if verdict.rehearsals or not (verdict.explored or verdict.sayings or verdict.examples):
        cases = [*map(_story, verdict.rehearsals), *_uncovered(verdict)]
        suites.append(JunitSuite("stories", cases, sum(r.took for r in verdict.rehearsals), _properties(verdict)))
    if verdict.sayings:
        suites.append(JunitSuite("sayings", [_saying(one) for one in verdict.sayings], 0.0))
    if verdict.examples:
        suites.append(JunitSuite("functions", [_example(one) for one in verdict.examples], 0.0))
    if verdict.explored:
        suites.append(JunitSuite("explore", list(_explored(verdict.explored)), verdict.explored.took))
    return junit_xml(verdict.name, suites, verdict.took)


def _story(rehearsal: Rehearsal) -> JunitCase:
    file = f"behaviors/stories/{rehearsal.story.name}.yaml"
    case = JunitCase(rehearsal.story.name, "stories", {"time": f"{rehearsal.took:.3f}", "file": file})
    if not rehearsal.failed:
        return case
    line = str(rehearsal.place.line if rehearsal.place else 1)
    failure = JunitFailure(rehearsal.failed.what, text.story(rehearsal))
    return case._replace(attributes={**case.attributes, "line": line}, failure=failure)


def _saying(one: JudgedSaying) -> JunitCase:
    said, place = one.tried.saying, one.place
    name = f"{said.behavior}.{said.state}: {said.text}"
    case = JunitCase(name, "sayings", {"time": "0", "file": place.file, "line": str(place.line)})
    if not one.tried.wrong:
        return case
    return case._replace(failure=JunitFailure(one.tried.wrong, f"{place}: {text.misheard(one)}"))


def _example(one: JudgedExample) -> JunitCase:
    place = one.place
    case = JunitCase(one.tried.call, "functions", {"time": "0", "file": place.file, "line": str(place.line)})
    if not one.tried.wrong:
        return case
    return case._replace(failure=JunitFailure(one.tried.wrong, f"{place}: {text.refuted(one)}"))


def _properties(verdict: Verdict) -> dict[str, str]:
    if verdict.coverage is None:
        return {}
    return {f"coverage.{what}": f"{some} of {every}" for what, (some, every) in verdict.coverage.counts.items()}


def _uncovered(verdict: Verdict) -> Iterator[JunitCase]:
    """Yield a failure if less is covered than was required."""
    if verdict.coverage and verdict.uncovered:
        said = f"{verdict.coverage.percent:.1f} % is covered, less than the required {verdict.wanted:g} %"
        details = "\n".join(f"{gap.place}: {gap.what}" for gap in verdict.coverage.gaps())
        yield JunitCase("coverage", "coverage", {"time": "0"}, JunitFailure(said, details))


def _explored(explored: Explored) -> Iterator[JunitCase]:
    for finding in explored.findings:
        attributes = {"time": "0", "file": finding.place.file, "line": str(finding.place.line)}
        failure = JunitFailure(finding.message, finding.story)
        yield JunitCase(finding.message, explored.behavior, attributes, failure)
    if not explored.findings:
        yield JunitCase(explored.behavior, "explore", {"time": f"{explored.took:.3f}"})
