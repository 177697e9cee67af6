"""Broken controller files: each fault at its word, all of them in one run, and none twice."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from lumen.errors import ProjectError
from lumen.fuzzy import Controller
from lumen.language.controllers import ACTIVATIONS, COMPARISONS, DEFUZZIFIERS, S_NORMS, T_NORMS, TERM_PARAMETERS
from lumen.language.diagnostics import Diagnostic, Severity
from lumen.project.controllers import build_controller
from lumen.project.document_report import DocumentReport
from lumen.project.schema import check_schema, load_schema
from lumen.project.yaml_reader import parse
from tests.tables import for_each

HEAD = Path("tests/fuzzy/at_length.yaml").read_text()


def diagnose(text: str) -> list[Diagnostic]:
    document, found = parse("head.yaml", text.encode())
    assert document
    report = DocumentReport(document)
    build_controller(check_schema(document, "controller", report), report, name="head")
    return [*found, *report.diagnostics]


def shown(text: str, diagnostic: Diagnostic) -> str:
    """Return the text at the diagnostic's place."""
    place = diagnostic.place
    lines = text.splitlines()[place.line - 1 : place.end_line]
    if len(lines) > 1:
        return lines[0][place.column - 1 :]
    return lines[0][place.column - 1 : place.end_column - 1]


ONE = "if FaceXLoc is Negative then AngleX is Positive"

CASES = [
    ("FaceXLoc is Zero then", "FaceXLoc is Zro then", "unknown-term", "Zro", "did you mean `Zero`?"),
    ("if FaceXLoc is Zero", "if FaceXLok is Zero", "unknown-variable", "FaceXLok", "did you mean `FaceXLoc`?"),
    ("then AngleX is Zero", "then AngelX is Zero", "unknown-variable", "AngelX", "did you mean `AngleX`?"),
    ("then AngleX is Zero", "then FaceXLoc is Zero", "not-an-output", "FaceXLoc", "the outputs are `AngleX`, `AngleY`"),
    ("Zero then AngleX", "Zero the AngleX", "rule-syntax", "the", "did you mean `then`?"),
    ("if FaceXLoc is Zero", "if FaceXLoc iss Zero", "rule-syntax", "iss", "write: FaceXLoc is TERM"),
    ("gaussian: [160, 50]", "gaussian: [160]", "wrong-parameters", "[160]", "write `gaussian: [mean, sigma]`"),
    ("gaussian: [160, 50]", "triangle: [0, 9, 3]", "not-ascending", "3", "ascending order: 0, 3, 9"),
    ("gaussian: [160, 50]", "gaussian: [160, -50]", "not-positive", "-50", "the width of the term"),
    ("gaussian: [160, 50]", "gaussian: [160, 0]", "not-positive", "0", "the width of the term"),
    ("gaussian: [160, 50]", "gaussian: [.nan, 50]", "not-a-number", ".nan", "write a number"),
    ("gaussian: [160, 50]", "gaussian: [160, .inf]", "not-finite", ".inf", "write a number"),
    ("gaussian: [160, 50]", "gaussian: [160, 1e-200]", "extreme-number", "1e-200", "between 1e-12 and 1e+12"),
    ("gaussian: [160, 50]", "gaussian: [1e308, 50]", "extreme-number", "1e308", "between 1e-12 and 1e+12"),
    ("gain: 1.5", "gain: .inf", "not-finite", ".inf", "write a number"),
    ("gain: 1.5", "gain: .nan", "not-a-number", ".nan", "write a number"),
    ("gain: 1.5", "gain: 1e308", "extreme-number", "1e308", "between 1e-12 and 1e+12"),
    ("limits: [-60, 60]", "limits: [-60, .inf]", "not-finite", ".inf", "write a number"),
    ("period: 4s", "period: 0s", "bad-duration", "0s", "write a longer time"),
    ("period: 4s", "stale: 0 ms", "bad-duration", "0 ms", "write a longer time"),
    ("gaussian: [160, 50]", "ramp: [5, 5]", "empty-term", "[5, 5]", "two different numbers"),
    ("gaussian: [160, 50]", "constant: 5", "term-without-set", "constant", "use a shape"),
    ("gaussian: [160, 50]", "gausian: [160, 50]", "unknown-key", "gausian", "did you mean `gaussian`?"),
    ("{gaussian: [160, 50]}", "{gaussian: [160, 50], ramp: [0, 1]}", "two-shapes", "ramp", "two terms"),
    ("{gaussian: [160, 50]}", "{height: 0.5}", "no-shape", "Zero", "write, for example"),
    ("range: [0, 320]", "range: [320, 0]", "empty-range", "[320, 0]", "write [0, 320]"),
    ("range: [-15, 15]", "range: [-15, .inf]", "not-finite", "[-15, .inf]", "two numbers"),
    ("range: [0, 320]", "range: [0]", "wrong-value", "[0]", "Least and greatest"),
    ("implication: minimum", "implication: minimun", "wrong-value", "minimun", "did you mean `minimum`?"),
    ("defuzzifier: centroid", "defuzzifier: weighted-sum", "term-without-value", "gaussian", "`constant`, `linear`"),
    ("resolution: 1000", "resolution: 1", "wrong-value", "1", "a number from 10 to"),
    ("FaceXLoc: face.x", "FaceXLok: face.x", "unknown-variable", "FaceXLok", "did you mean `FaceXLoc`?"),
    ("    FaceXLoc: face.x\n", "", "unbound-input", "FaceXLoc", "route.field"),
    ("    AngleX: {joint: head.yaw, gain: 1.5, limits: [-60, 60]}\n", "", "unbound-output", "AngleX", "head.yaw"),
    ("limits: [-60, 60]", "limits: [60, -60]", "empty-range", "[60, -60]", "greater"),
    ("search: 8s", "search: 8", "wrong-type", "8", ""),
    ("      Zero: {gaussian: [160, 50]}", "      very: {gaussian: [160, 50]}", "reserved-name", "very", "another name"),
    ("  AngleY:\n", "  FaceYLoc:\n", "duplicate-variable", "FaceYLoc", "rename one"),
    ("Zero: {gaussian: [160, 50]}", "Negative: {gaussian: [160, 50]}", "duplicate-key", "Negative", "line"),
]


@for_each(("old", "new", "code", "word", "hint"), CASES, ids=[f"{c[2]}-{c[3]}" for c in CASES])
def test_a_fault_is_shown_at_its_word(old: str, new: str, code: str, word: str, hint: str) -> None:
    text = HEAD.replace(old, new, 1)
    assert text != HEAD
    found = [d for d in diagnose(text) if d.code == code]
    assert found, [str(d) for d in diagnose(text)]
    assert shown(text, found[0]) == word
    assert hint in found[0].hint


def test_the_shipped_controller_has_no_fault() -> None:
    assert diagnose(HEAD) == []


def test_one_fault_is_said_once() -> None:
    for old, new in (
        ("gaussian: [160, 50]", "gausian: [160, 50]"),
        ("gaussian: [160, 50]", "gaussian: [160, 0]"),
        ("gaussian: [160, 50]", "gaussian: [.nan, 50]"),
        ("range: [0, 320]", "range: [0, 1e300]"),
        ("gaussian: [160, 50]", "gaussian: [160, 1e-200]"),
        ("gain: 1.5", "gain: .inf"),
    ):
        assert len(diagnose(HEAD.replace(old, new))) == 1


def test_all_faults_are_said_at_once() -> None:
    text = HEAD.replace("FaceXLoc is Zero", "FaceXLoc is Zro").replace("[120, 40]", "[120, -40]").replace("8s", "8")
    assert {d.code for d in diagnose(text)} == {"unknown-term", "not-positive", "wrong-type"}


@pytest.mark.parametrize(
    ("written", "line", "column"),
    [
        (f'- "{ONE.replace("Positive", "Positiv")}"', 0, 42),
        ("- >-\n    if FaceXLoc is Negative\n    then AngleX is Positiv", 2, 20),
        ("- |\n    if FaceXLoc is Negative\n      then AngleX is Positiv\n", 2, 22),
        ("- if FaceXLoc is Negative\n    then AngleX\n    is Positiv", 2, 8),
    ],
)
def test_a_word_is_found_in_every_kind_of_text(written: str, line: int, column: int) -> None:
    text = HEAD.replace(f"- {ONE}", written)
    first = text[: text.index(written)].count("\n") + 1
    (diagnostic,) = diagnose(text)
    assert diagnostic.code == "unknown-term"
    assert shown(text, diagnostic) == "Positiv"
    assert diagnostic.place.line == first + line
    assert line == 0 or diagnostic.place.column == column


def test_an_unbound_output_is_only_a_warning() -> None:
    (found,) = diagnose(HEAD.replace("    AngleX: {joint: head.yaw, gain: 1.5, limits: [-60, 60]}\n", ""))
    assert found.severity is Severity.WARNING


def test_a_controller_without_bindings_is_whole() -> None:
    assert diagnose(HEAD[: HEAD.index("bind:")]) == []


def test_a_dict_is_checked_alike() -> None:
    data: Mapping[str, Any] = {
        "inputs": {"x": {"range": [0, 1], "terms": {"low": {"ramp": [1, 0]}}}},
        "outputs": {"y": {"range": [0, 1], "terms": {"low": {"ramp": [1, 0]}}}},
        "rules": ["if x is lo then y is low"],
    }
    with pytest.raises(ProjectError, match=r"unknown-term.*did you mean `low`"):
        Controller.from_dict(data)
    with pytest.raises(ProjectError, match="no-rules"):
        Controller.from_dict({**data, "rules": []})


def test_angles_and_times_arrive_in_si() -> None:
    head = Controller.load("fuzzy/head.yaml")
    yaw, pitch = head.output_bindings
    assert (yaw.joint, yaw.gain, pitch.gain) == ("head.yaw", 1.5, -1.5)
    assert yaw.maximum == pytest.approx(1.0472, abs=1e-4)
    assert yaw.angle == pytest.approx(0.0174533)
    assert [(b.route, b.path) for b in head.input_bindings] == [("face", ("x",)), ("face", ("y",))]
    assert (head.tracking.hold, head.tracking.search) == (2.0, 8.0)
    assert head.tracking.sweep["head.yaw"] == pytest.approx(0.5236, abs=1e-4)


def test_the_schema_knows_the_whole_vocabulary() -> None:
    schema = load_schema("controller")
    operators = schema["properties"]["operators"]["properties"]
    assert set(schema["$defs"]["term"]["properties"]) == {*TERM_PARAMETERS, "height"}
    assert operators["conjunction"]["enum"] == operators["implication"]["enum"] == list(T_NORMS)
    assert operators["disjunction"]["enum"] == operators["aggregation"]["enum"] == list(S_NORMS)
    assert operators["defuzzifier"]["enum"] == list(DEFUZZIFIERS)
    assert operators["activation"]["properties"]["method"]["enum"] == list(ACTIVATIONS)
    assert operators["activation"]["properties"]["comparison"]["enum"] == list(COMPARISONS)
