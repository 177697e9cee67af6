"""Motion files with mistakes: the findings and their places. A new case is a new file."""

import re
from pathlib import Path

import pytest

from lumen.errors import ProjectError
from lumen.language.diagnostics import Severity
from lumen.motion import Motion
from lumen.project.document_report import DocumentReport
from lumen.project.motions import build_motions
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse
from tests.motions.making import nao, read
from tests.scanning import matching
from tests.tables import for_each

CASES = matching(Path(__file__).parent / "broken", "*.yaml")


@for_each("case", CASES, ids=lambda case: case.stem)
def test_every_fault_is_found_at_its_place_and_nothing_else(case: Path) -> None:
    text = case.read_text()
    _, diagnostics = read(text, name=case.stem)
    found = [f"{d.code} {d.place.line}:{d.place.column}" for d in sorted(diagnostics, key=lambda d: d.place)]
    assert found == re.findall(r"# expect: (.+)", text)
    assert all(d.severity is Severity.ERROR and d.message and d.hint for d in diagnostics)


def said(text: str) -> str:
    return "\n".join(str(d) for d in read(text)[1])


def test_an_angle_beyond_the_limit_names_the_limit_in_the_file_s_unit() -> None:
    text = said("units: {angle: deg}\nkeyframes: [{at: 1s, joints: {RShoulderPitch: 400}}]")
    assert "`RShoulderPitch` can't go to 400 deg (its range is -119.5 to 119.5 deg)" in text


def test_a_misspelt_name_is_guessed() -> None:
    assert "did you mean `RShoulderPitch`?" in said("keyframes: [{at: 1s, joints: {RShoulderPich: 0}}]")
    assert "did you mean `Stand`?" in said("{start: Stnd, keyframes: [{at: 1s, joints: {HeadYaw: 0}}]}")


def test_what_the_schema_took_out_is_not_asked_for() -> None:
    """One mistake, one finding: an invalid time is not reported as missing too."""
    _, diagnostics = read("keyframes: [{at: soon, joints: {HeadYaw: 0}}, {at: 1s, joints: {HeadYaw: 0}}]")
    assert len(diagnostics) == 1


def test_a_million_keyframes_are_refused_at_once() -> None:
    with pytest.raises(ProjectError, match="1,000,000 keyframes are too many for one list"):
        Motion.from_dict({"keyframes": [{"at": "1s", "joints": {"HeadYaw": 0.1}}] * 1_000_000})


@for_each("text", ["[]", "3", "{}", "keyframes: 3", "keyframes: []", "keyframes: [3]", "keyframes: {a: 1}"])
def test_what_is_no_motion_is_said_and_not_built(text: str) -> None:
    motion, diagnostics = read(text)
    assert motion is None
    assert diagnostics


def project(**files: str) -> tuple[dict[str, object], list[str]]:
    """Return the motions of a project's files, and the codes of the findings, each with its file."""
    sources = {}
    for name, text in files.items():
        document, _ = parse(f"motions/{name}.yaml", text.encode())
        assert document is not None
        report = DocumentReport(document)
        sources[name] = (check_schema(document, "motion", report), report)
    built = build_motions(sources, nao())
    found = [f"{n}: {d.code}" for n, (_, report) in sources.items() for d in report.diagnostics]
    return dict(built), found


NOD = "keyframes: [{at: 1s, joints: {HeadPitch: 0.2}}]"


def test_motions_are_built_after_those_that_they_play() -> None:
    built, found = project(a="keyframes: [{play: b}]", b="keyframes: [{play: c}]", c=NOD)
    assert found == []
    assert list(built) == ["a", "b", "c"]


def test_a_circle_of_motions_is_said_once() -> None:
    built, found = project(
        a="keyframes: [{play: b}, {at: 300s, posture: Stand}]",
        b="keyframes: [{play: c}, {at: 200s, posture: Stand}]",
        c="keyframes: [{play: a}, {at: 90s, posture: Stand}]",
        d=NOD,
    )
    assert [f.split(": ")[1] for f in found] == ["motion-cycle"]
    assert "d" in built


def test_who_plays_a_broken_motion_is_not_blamed_for_it() -> None:
    _, found = project(a="keyframes: [{play: b}, {at: 1s, posture: Stand}]", b="keyframes: 3")
    assert [f for f in found if f.startswith("a")] == []
    assert found


@pytest.mark.slow
def test_long_chains_of_motions_are_built() -> None:
    files = {f"m{i}": f"keyframes: [{{play: m{i + 1}}}]" for i in range(2000)}
    built, found = project(**files, m2000=NOD)
    assert found == []
    assert len(built) == 2001
