"""Fuzzy controllers from public bug reports: each keeps its values, and omitted parts are listed."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from lumen.features.formats_fuzzy.fcl import read_fcl
from lumen.features.formats_fuzzy.fis import read_fis
from lumen.features.formats_fuzzy.fll import read_fll
from lumen.fuzzy import Controller
from lumen.language.diagnostics import Diagnostic
from lumen.lint import rulebooks
from lumen.project.controllers import build_controller
from lumen.project.document_report import DocumentReport
from lumen.project.formats.conversion_findings import LOST
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse
from tests.tables import for_each

INPUTS = Path(__file__).parent / "inputs" / "fuzzy"


def read(name: str, *changes: tuple[str, str], encoding: str = "utf-8") -> tuple[dict[str, Any], list[Diagnostic]]:
    """Read an input file after some changes to its text; return the data and the findings."""
    text = (INPUTS / name).read_text("utf-8")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return READERS[name.rpartition(".")[2]](name, text.encode(encoding), name)


READERS: dict[str, Callable[[str, bytes, str], tuple[dict[str, Any], list[Diagnostic]]]] = {
    "fis": read_fis,
    "fcl": read_fcl,
    "fll": read_fll,
}


def value(data: dict[str, Any], **inputs: float) -> float:
    """Return the value of the only output."""
    [found] = Controller.from_dict(data).evaluate(inputs).values()
    return found


def centroid(membership: Callable[[float], float], high: float = 30.0) -> float:
    """Compute the centroid of a set over 0 to `high` from the definition."""
    ys = [high * (i + 0.5) / 100_000 for i in range(100_000)]
    degrees = [membership(y) for y in ys]
    return sum(y * degree for y, degree in zip(ys, degrees, strict=True)) / sum(degrees)


def test_two_inputs_of_one_name_stay_two() -> None:
    data, found = read("two-inputs-one-name.fis")
    assert list(data["inputs"]) == ["temp", "temp_2"]
    assert value(data, temp=2, temp_2=9) == pytest.approx(15.26, abs=0.01)
    assert [(d.place.line, d.message) for d in found] == [(22, "`temp` is renamed to `temp_2`")]


@for_each(
    ("first", "second", "names"),
    [
        ("the temp", "the-temp", ["the_temp", "the-temp"]),
        ("the temp", "the.temp", ["the_temp", "the_temp_2"]),
        ("temp", "z", ["temp", "z"]),
        ("temp_2", "temp", ["temp_2", "temp"]),
        ("not", "not", ["not_", "not__2"]),
    ],
)
def test_names_that_become_equal_by_cleaning_stay_two(first: str, second: str, names: list[str]) -> None:
    text = (INPUTS / "two-inputs-one-name.fis").read_text("utf-8")
    text = text.replace("'temp'", "{}").format(f"'{first}'", f"'{second}'")
    data, _ = read_fis("two.fis", text.encode(), "two")
    assert list(data["inputs"]) == names
    assert value(data, **dict(zip(names, (2, 9), strict=True))) == pytest.approx(15.26, abs=0.01)


def test_an_input_and_an_output_of_one_name_stay_two() -> None:
    data, found = read("two-inputs-one-name.fis", ("Name='z'", "Name='temp'"))
    assert [list(data[side]) for side in ("inputs", "outputs")] == [["temp", "temp_2"], ["temp_3"]]
    assert value(data, temp=2, temp_2=9) == pytest.approx(15.26, abs=0.01)
    assert len(found) == 2


def test_sections_and_terms_count_by_their_numbers() -> None:
    second = "[Input9]\nName='first'"
    swapped = [("[Input1]\nName='temp'", second), ("[Input2]", "[Input1]"), ("[Input9]", "[Input2]")]
    data, _ = read("two-inputs-one-name.fis", *swapped)
    assert data["rules"] == ["if temp is a then z is c", "if first is b then z is d"]
    terms = [("MF1='a'", "MF9='a'"), ("MF2='b'", "MF1='b'"), ("MF9='a'", "MF2='a'")]
    data, _ = read("two-inputs-one-name.fis", *terms)
    assert data["rules"] == ["if temp is b then z is c", "if temp_2 is a then z is d"]


@for_each(
    ("old", "new", "message"),
    [
        ("AndMethod", "AndMetod", "`AndMetod` is left out"),
        ("'min'", "'mim'", "unknown conjunction `mim`: the default is used"),
        ("Type='mamdani'", "Type='mamdany'", "unknown system type `mamdany`"),
        (
            "Type='mamdani'",
            "Type='sugeno'",
            "`Type` is 'sugeno', but the defuzzification is centroid: `Type` is ignored",
        ),
        ("NumInputs=2", "NumInputs=3", "`NumInputs` is 3, but the file has 2: all are read"),
        ("NumRules=2", "NumRules=1", "`NumRules` is 1, but the file has 2: all are read"),
        ("NumMFs=2", "NumMFs=3", "`NumMFs` is 3, but the file has 2: all are read"),
        ("NumMFs=2", "NumMFs=2\nUnit='K'", "`Unit` is left out"),
        ("NumMFs=2", "NumMFs=2\nRange=[0 5]", "`Range` is set twice: the first value is used"),
        ("[Input2]", "[Input3]", "[Input3] is read as number 2: rules refer to it by this number"),
        ("[Rules]", "[Rulse]\n[Rules]", "`[Rulse]` is left out: it is not in a section"),
        ("[System]", "Author='me'\n[System]", "`Author='me'` is left out: it is not in a section"),
        ("MF2='b'", "MF3='b'", "`temp` has no MF2"),
        ("(1) : 1", "(2) : 1", "this rule is left out: the weight 2 is not between 0 and 1"),
        ("(1) : 1", "(1) : 3", "this is not a rule for these inputs and outputs"),
        ("trimf", "trimef", "a term of `temp` is left out: unknown shape `trimef`"),
    ],
)
def test_unread_parts_of_a_fis_are_listed(old: str, new: str, message: str) -> None:
    text = (INPUTS / "two-inputs-one-name.fis").read_text("utf-8")
    _, found = read_fis("two.fis", text.replace(old, new, 1).encode(), "two")
    assert message in [d.message for d in found]


@for_each(
    ("encoding", "names", "said"),
    [
        ("utf-8", ["Скорость", "Давление"], []),
        ("utf-8-sig", ["Скорость", "Давление"], []),
        ("utf-16", ["Скорость", "Давление"], []),
        ("cp1251", ["Скорость", "Давление"], ["the file is not UTF-8: it is read as Windows-1251"]),
    ],
)
def test_cyrillic_names_stay(encoding: str, names: list[str], said: list[str]) -> None:
    data, found = read("cyrillic-names.fis", encoding=encoding)
    assert list(data["inputs"]) == names
    assert [d.message for d in found] == said
    assert data["rules"][0] == "if Скорость is Низкая then Клапан is Закрыт"
    assert value(data, **dict(zip(names, (2, 9), strict=True))) == pytest.approx(15.26, abs=0.01)


def test_names_in_latin_1_stay_two() -> None:
    data, found = read("two-inputs-one-name.fis", ("Name='temp'\nR", "Name='Größe'\nR"), encoding="latin-1")
    assert list(data["inputs"]) == ["Größe", "Größe_2"]
    assert found[0].message == "the file is not UTF-8: it is read as Latin-1"
    assert found[0].place.line == 15
    text = (INPUTS / "two-inputs-one-name.fis").read_text("utf-8")
    text = text.replace("'temp'", "{}").format("'temp é'", "'temp à'")
    data, _ = read_fis("two.fis", text.encode("latin-1"), "two")
    assert list(data["inputs"]) == ["temp_é", "temp_à"]


def test_not_in_a_conclusion_is_the_complement_of_the_set() -> None:
    data, found = read("not-in-conclusion.fis")
    assert value(data, x=5) == pytest.approx(15.0, abs=0.05)
    assert value(data, x=10) == pytest.approx(centroid(lambda y: 1 - max(min((y - 20) / 10, 1), 0)), abs=0.01)
    assert [(d.code, d.place.line) for d in found] == [("carried-over-differently", 30)]


@for_each(
    ("shape", "membership"),
    [
        ("'trapmf',[5 10 15 25]", lambda y: max(min((y - 5) / 5, 1, (25 - y) / 10), 0)),
        ("'gaussmf',[4 20]", lambda y: 2.718281828459045 ** (-((y - 20) ** 2) / 32)),
        ("'gbellmf',[4 2 20]", lambda y: 1 / (1 + abs((y - 20) / 4) ** 4)),
        ("'sigmf',[2 15]", lambda y: 1 / (1 + 2.718281828459045 ** (-2 * (y - 15)))),
        ("'sigmf',[2000 15]", lambda y: float(y > 15)),
        ("'smf',[10 20]", lambda y: _smooth((y - 10) / 10)),
        ("'zmf',[10 20]", lambda y: 1 - _smooth((y - 10) / 10)),
        ("'pimf',[0 10 20 30]", lambda y: _smooth(y / 10) * (1 - _smooth((y - 20) / 10))),
        ("'trimf',[10 10 10]", lambda y: 0.0),
    ],
)
def test_the_complement_of_every_shape(shape: str, membership: Callable[[float], float]) -> None:
    data, _ = read("not-in-conclusion.fis", ("'trimf',[20 30 30]", shape))
    assert value(data, x=10) == pytest.approx(centroid(lambda y: 1 - membership(y)), abs=0.02)


def _smooth(t: float) -> float:
    t = max(min(t, 1.0), 0.0)
    return 2 * t * t if t <= 0.5 else 1 - 2 * (1 - t) ** 2


def test_not_leaves_the_other_outputs_of_the_rule_alone() -> None:
    two = "[Output2]\nName='w'\nRange=[0 30]\nNumMFs=1\nMF1='some':'trimf',[0 10 30]\n[Rules]"
    data, _ = read("not-in-conclusion.fis", ("[Rules]", two), ("1, 2 (1)", "1, 2 1 (1)"), ("2, -2 (1)", "2, -2 1 (1)"))
    plain, _ = read("not-in-conclusion.fis", ("[Rules]", two), ("1, 2 (1)", "1, 2 1 (1)"), ("2, -2 (1)", "2, 2 1 (1)"))
    w = [Controller.from_dict(each).evaluate({"x": 8})["w"] for each in (data, plain)]
    assert w[0] == pytest.approx(w[1])


def test_if_no_rule_fires_an_output_is_in_the_middle_of_its_range() -> None:
    data, found = read("nothing-fires.fis")
    assert value(data, x=5) == 15
    assert found == []
    data, _ = read("nothing-fires.fis", ("Name='y'\nRange=[0 30]", "Name='y'\nRange=[-10 30]"))
    assert value(data, x=5) == 10
    sugeno = [
        ("'centroid'", "'wtaver'"),
        ("'trimf',[0 0 10]", "'constant',[3]"),
        ("'trimf',[20 30 30]", "'constant',[4]"),
    ]
    data, _ = read("nothing-fires.fis", *sugeno)
    assert value(data, x=5) == 15


@for_each(
    ("rule", "power", "negated"),
    [
        ("1.05, 1", 0.5, False),
        ("1.2, 1", 2, False),
        ("1.3, 1", 3, False),
        ("1.4, 1", 4, False),
        ("-1.3, 1", 3, True),
        ("-1.2, 1", 2, True),
        ("1.15, 1", 1.5, False),
    ],
)
def test_hedges_of_octave_are_powers(rule: str, power: float, negated: bool) -> None:
    data, found = read("octave-hedges.fis", ("1.2, 1 (1) : 1\n-2.3, 2", f"{rule} (1) : 1\n2, 2"))
    low, high = (0.6**power, 0.4) if not negated else (1 - 0.6**power, 0.4)
    wanted = centroid(lambda y: max(min(low, 1 - y / 30), min(high, y / 30)))
    assert value(data, x=4) == pytest.approx(wanted, abs=0.01)
    assert all(d.code != LOST for d in found)


def test_a_hedge_in_a_conclusion_changes_the_set() -> None:
    data, _ = read("octave-hedges.fis", ("1.2, 1 (1) : 1\n-2.3, 2", "1, 1 (1) : 1\n2, 2.2"))
    wanted = centroid(lambda y: max(min(0.6, 1 - y / 30), min(0.4, (y / 30) ** 2)))
    assert value(data, x=4) == pytest.approx(wanted, abs=0.01)


def test_both_rules_of_octave_are_carried_over() -> None:
    data, found = read("octave-hedges.fis")
    wanted = centroid(lambda y: max(min(0.6**2, 1 - y / 30), min(1 - 0.4**3, y / 30)))
    assert value(data, x=4) == pytest.approx(wanted, abs=0.01)
    assert "a hedge" in found[0].message


def test_a_hedge_of_a_value_is_listed() -> None:
    sugeno = [
        ("'centroid'", "'wtaver'"),
        ("'trimf',[0 0 30]", "'constant',[3]"),
        ("'trimf',[0 30 30]", "'constant',[4]"),
    ]
    _, found = read("octave-hedges.fis", *sugeno, ("1.2, 1", "1, -1.2"))
    assert [(d.code, d.place.line) for d in found if "a hedge" in d.message] == [
        (LOST, 29),
        ("carried-over-differently", 30),
    ]


THEIR_TERMS = "`out` has no range: it gets the range of its terms"
DECLARED = "temperature : REAL; RANGE := ( 100 .. 150 );"


@for_each(
    "declaration",
    [
        DECLARED,
        "temperature : REAL (100 .. 150);",
        "temperature: REAL; RANGE : (100..150);",
        "TEMPERATURE, temperature : REAL; RANGE := (100 .. 150);",
    ],
)
def test_a_range_in_the_declaration_is_read(declaration: str) -> None:
    data, found = read("range-in-declaration.fcl", (DECLARED, declaration))
    assert data["inputs"]["temperature"]["range"] == [100, 150]
    lost = ["`TEMPERATURE` is left out: it has no terms"] if "TEMPERATURE" in declaration else []
    assert [d.message for d in found] == [*lost, THEIR_TERMS]


def test_two_variables_in_one_declaration_are_read() -> None:
    data, found = read("two-in-one-declaration.fcl")
    assert list(data["inputs"]) == ["temperature", "humidity"]
    assert [d.code for d in found] == ["carried-over-differently"] * 3
    data, _ = read("two-in-one-declaration.fcl", ("humidity : REAL;", "humidity : REAL; RANGE := (0 .. 200);"))
    assert [spec["range"] for spec in data["inputs"].values()] == [[0, 200], [0, 200]]


@for_each(
    ("old", "new", "message"),
    [
        ("RANGE := ( 100", "RNAGE := ( 100", "this is not a declaration"),
        (
            "FUZZIFY temperature",
            "FUZZIFY temperature RANGE := (0 .. 9);",
            "the range in the declaration of `temperature` differs",
        ),
        (": REAL;\nEND", ": INT;\nEND", "the type `INT` is read as REAL"),
        (": REAL;\nEND", ": REAL := 5;\nEND", "`:= 5` in a declaration is left out"),
        ("VAR_OUTPUT", "VAR\n a : REAL;\nEND_VAR\nVAR_OUTPUT", "`VAR` is not a section; it and the text after it"),
        (
            "RULEBLOCK No1",
            "OPTIONS\n x;\nEND_OPTIONS\nRULEBLOCK No1",
            "`OPTIONS` is not a section; it and the text after",
        ),
        ("END_FUZZIFY", "METHOD : COG; END_FUZZIFY", "an input can't have `METHOD`"),
        ("METHOD : COG;", "METHOD : COG; METHOD : COA;", "`METHOD` is set twice: the first value is used"),
        ("METHOD : COG;", "METOD : COG;", "an output can't have `METOD : COG`"),
        ("ACT : MIN;", "AKT : MIN;", "this is neither a rule nor an operator"),
        ("ACCU : MAX;", "ACCU : MAXX;", "unknown ACCU `MAXX`"),
        ("SIGM -4", "SIGN -4", "the term `low` of `temperature` is left out"),
    ],
)
def test_unread_parts_of_a_function_block_are_listed(old: str, new: str, message: str) -> None:
    _, found = read("range-in-declaration.fcl", (old, new))
    assert [d.message for d in found if d.message.startswith(message)], [d.message for d in found]


ENGINE = """Engine: e
InputVariable: a
  enabled: true
  range: 0 10
  lock-range: false
  term: low Ramp 10 0
OutputVariable: a
  enabled: true
  range: 0 1
  lock-range: false
  aggregation: Maximum
  defuzzifier: Centroid 100
  default: nan
  lock-previous: false
  term: few Ramp 1 0
RuleBlock: r
  enabled: true
  conjunction: Minimum
  disjunction: Maximum
  implication: Minimum
  activation: General
  rule: if a is low then a is few
"""


def test_an_input_and_an_output_of_an_engine_of_one_name_stay_two() -> None:
    data, found = read_fll("e.fll", ENGINE.encode(), "e")
    assert data["rules"] == ["if a is low then a_2 is few"]
    assert [d.message for d in found] == ["`a` is renamed to `a_2`"]


@for_each(
    ("old", "new", "message"),
    [
        ("lock-range: false", "lock-rang: false", "a variable has no `lock-rang`"),
        ("lock-range: false", "lock-range: tru", "`tru` is neither `true` nor `false`"),
        ("enabled: true\n  con", "enabled: no\n  con", "`no` is neither `true` nor `false`"),
        ("range: 0 10", "range: 0 10\n  range: 0 5", "`range` is set twice: the last value is used"),
        ("conjunction: Minimum", "conjunctoin: Minimum", "a rule block has no `conjunctoin`"),
        ("Engine: e", "Engine: e\nversion: 8", "an engine has no `version`"),
        ("Centroid 100", "Centroid 1e2", "a defuzzifier can't have `1e2`"),
        ("General", "Generl", "unknown activation `Generl`"),
        ("default: nan", "default: non", "`non` is not a number"),
    ],
)
def test_unread_parts_of_an_engine_are_listed(old: str, new: str, message: str) -> None:
    _, found = read_fll("e.fll", ENGINE.replace(old, new, 1).encode(), "e")
    assert message in [d.message for d in found]


POINT = "trapezoid: [1, 1, 1, 1]"


def controller(name: str, old: str = "", new: str = "") -> Controller:
    """Read a controller from an input file with `old` replaced by `new`."""
    text = (INPUTS / name).read_text("utf-8")
    assert old in text
    return Controller.from_dict(yaml.safe_load(text.replace(old, new)))


@for_each(
    ("shape", "wanted"),
    [
        (POINT, 1.0),
        ("triangle: [1, 1, 1]", 1.0),
        ("triangle: [1.0996, 1.1, 1.1004]", 1.1),
        ("rectangle: [2, 2]", 2.0),
        ("trapezoid: [0.7, 0.7, 0.7, 0.7]", 0.7),
        ("discrete: [[1.3, 0], [1.3, 1], [1.3001, 0]]", 1.3),
        ("gaussian: [1, 1.0e-6]", 1.0),
    ],
)
@for_each("method", ["centroid", "bisector", "mean-of-maximum", "smallest-of-maximum", "largest-of-maximum"])
def test_a_set_of_one_point_is_found(shape: str, wanted: float, method: str) -> None:
    found = controller(
        "point-set.yaml",
        f"range: [0, 2], terms: {{Plus100: {{{POINT}}}",
        f"range: [0, 2], defuzzifier: {method}, terms: {{Plus100: {{{shape}}}",
    )
    assert found.evaluate({"E": 12})["Adjust"] == pytest.approx(wanted, abs=1e-9)
    assert found.evaluate({"E": 0})["Adjust"] == 0
    assert found.evaluate_batch({"E": [12.0, 0.0]})["Adjust"].tolist() == pytest.approx([wanted, 0], abs=1e-9)


def test_two_sets_of_one_point_share_by_their_degrees() -> None:
    assert controller("point-set.yaml").evaluate({"E": 8.25})["Adjust"] == pytest.approx(0.5)
    explained = controller("point-set.yaml").explain({"E": 12}).outputs["Adjust"]
    assert (explained.fired, explained.value, max(explained.memberships)) == (True, 1.0, 1.0)


@for_each(
    ("conclusion", "said"),
    [
        ("Tip is not Low", "with 1 minus the degree of the rule"),
        ("Tip is very not Low", "with 1 minus the degree of the rule"),
        ("Tip is any Low", "in full, even if the rule is hardly true"),
        ("Tip is very Low and Tip is High", "applies to `Tip is High` after it"),
        ("Tip is very Low", ""),
        ("Tip is Low", ""),
    ],
)
def test_not_in_a_conclusion_is_a_finding(conclusion: str, said: str) -> None:
    """`not` has FuzzyLite's meaning (docs/decisions/110): a rule that is fully true concludes nothing."""
    text = (INPUTS / "not-low.yaml").read_text("utf-8")
    document, found = parse("fuzzy/tip.yaml", text.replace("Tip is not Low", conclusion).encode())
    assert document is not None
    report = DocumentReport(document)
    built = build_controller(check_schema(document, "controller", report), report, name="tip")
    assert built is not None
    rulebooks.check(built, report)
    hedged = [d for d in report.diagnostics if d.code == "hedged-conclusion"]
    assert [(said in d.message, d.place.line) for d in hedged] == ([(True, 6)] if said else [])
    assert found == []
    if conclusion == "Tip is not Low":
        assert Controller.from_dict(yaml.safe_load(text)).evaluate({"Q": 0})["Tip"] == 0
