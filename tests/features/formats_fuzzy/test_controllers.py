"""Fuzzy controllers of other tools: what comes across, what is listed and where, and files that mean harm."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.cli.main import main
from lumen.features.formats_fuzzy.fcl import read_fcl
from lumen.features.formats_fuzzy.fis import read_fis
from lumen.features.formats_fuzzy.fll import read_fll, write_fll
from lumen.features.formats_fuzzy.fll.infix_formulas import Trouble, read_formula, write_formula
from lumen.fuzzy import Controller
from lumen.fuzzy.arithmetic import NUMBERS
from lumen.fuzzy.formulas import formula
from lumen.project.formats.conversion_findings import ForeignFileError, dotted
from tests.tables import for_each

FIS = """[System]
Name='tipper'
Type='mamdani'
AndMethod='prod'
OrMethod='probor'
ImpMethod='min'
AggMethod='max'
DefuzzMethod='centroid'
[Input1]
Name='the service'
Range=[0 10]
NumMFs=2
MF1='poor':'gaussmf',[1.5 0]
MF2='good':'gbellmf',[2 4 9]
[Input2]
Name='food'
Range=[0 10]
NumMFs=2
MF1='rancid':'trapmf',[0 0 1 3]
MF2='fine':'smf',[4 9]
[Output1]
Name='tip'
Range=[0 30]
NumMFs=2
MF1='cheap':'trimf',[0 5 10]
MF2='generous':'trimf',[20 25 30]
[Rules]
1 1, 1 (1) : 2
2 -1, 2 (0.5) : 1
0 2, 2 (1) : 1
"""

FCL = """(* of the norm's appendix *)
FUNCTION_BLOCK tipper
VAR_INPUT service : REAL; food : REAL; END_VAR
VAR_OUTPUT tip : REAL; END_VAR
FUZZIFY service
  TERM poor := (0, 1) (4, 0);
  TERM good := (4, 0) (9, 1);
  RANGE := (0 .. 9);
END_FUZZIFY
FUZZIFY food
  TERM rancid := trape 0 0 1 3;
  TERM fine := (3, 0) (9, 1);
  RANGE := (0 .. 9);
END_FUZZIFY
DEFUZZIFY tip
  TERM cheap := 5;
  TERM generous := 25;
  METHOD : COGS; // singletons
  DEFAULT := NC;
  RANGE := (0 .. 30);
END_DEFUZZIFY
RULEBLOCK first
  OR : ASUM;
  ACT : MIN;
  RULE 1 : IF service IS poor OR food IS rancid THEN tip IS cheap;
  RULE 2 : IF service IS good AND NOT food IS rancid THEN tip IS generous WITH 0.5;
END_RULEBLOCK
END_FUNCTION_BLOCK
"""

JFUZZY = """/* an example: FUZZIFY nothing */
FUNCTION_BLOCK tipper VAR_INPUT service : REAL; END_VAR VAR_OUTPUT tip : REAL; END_VAR
FUZZIFY service TERM poor := gauss 2 1; TERM good := TRAPE 1 4 6 9; END_FUZZIFY // {'poor', 'good'}

DEFUZZIFY tip TERM cheap := TRIAN 0 5 10; TERM dear := (20, 0) (30, 1) (30, 0); METHOD : COG; END_DEFUZZIFY
RULEBLOCK No1
  RULE 1 : IF service IS poor THEN tip IS cheap;
  RULE 2 : IF service IS good THEN tip IS dear;
END_RULEBLOCK END_FUNCTION_BLOCK
"""

FLL = """Engine: e
InputVariable: a
  range: 0.000 10.000
  term: low Triangle -inf 0 4
  term: very Triangle 3 5 nan
  term: high Ramp 4 8 0.5
OutputVariable: b
  range: 0 1
  defuzzifier: Centroid 100
  default: nan
  term: few Function lt(x, 0.5) * (1 - x) + sin(pi()) ^ 2
  term: many Function bessel(x)
RuleBlock: first
  enabled: true
  conjunction: none
  activation: Highest 2
  rule: if a is low then b is few with 0.500
  rule: if a is hihg then b is few
  rule: if a is high or then b is few
RuleBlock: second
  enabled: false
  rule: if a is low then b is few
"""

Read = Callable[[str, bytes, str], tuple[dict[str, Any], list[Any]]]


def said(read: Read, text: str) -> tuple[dict[str, Any], list[str]]:
    data, found = read("file", text.encode(), "file")
    return data, [f"{d.place.line}:{d.place.column} {d.message}" for d in found]


def test_a_system_of_matlab() -> None:
    data, found = said(read_fis, FIS)
    assert found == ["10:1 `the service` is renamed to `the_service`"]
    assert data["operators"] == {"conjunction": "algebraic-product", "disjunction": "algebraic-sum"}
    assert data["inputs"]["the_service"]["terms"] == {"poor": {"gaussian": [0, 1.5]}, "good": {"bell": [9, 2, 4]}}
    assert data["rules"] == [
        "if the_service is poor or food is rancid then tip is cheap",
        "if the_service is good and food is not rancid then tip is generous with 0.5",
        "if food is fine then tip is generous",
    ]
    assert Controller.from_dict(data).evaluate({"the_service": 9, "food": 9})["tip"] == pytest.approx(25, abs=0.1)


def test_a_function_block_of_the_norm() -> None:
    """A norm given alone implies its dual: with ASUM for OR, AND is the product."""
    data, found = said(read_fcl, FCL)
    assert found == []
    assert data["operators"] == {"conjunction": "algebraic-product", "disjunction": "algebraic-sum"}
    tip = data["outputs"]["tip"]
    assert (tip["defuzzifier"], tip["lock-previous"]) == ("weighted-average", True)
    controller = Controller.from_dict(data)
    assert controller.evaluate({"service": 9, "food": 3})["tip"] == 25
    assert controller.evaluate({"service": 4, "food": 9}, {"tip": 7.0})["tip"] == 7
    assert controller.evaluate({"service": 2, "food": 2})["tip"] == 5


def test_a_function_block_as_jfuzzylogic_writes_it() -> None:
    """It has comments, jFuzzyLogic's shapes, and no RANGE: the range reaches from the first term's begin to the last
    one's end.
    """
    data, found = said(read_fcl, JFUZZY)
    assert found == [
        "3:1 `service` has no range: it gets the range of its terms",
        "5:1 ACCU is missing: the conclusions about `tip` are combined by their maximum",
        "5:1 `tip` has no range: it gets the range of its terms",
    ]
    assert (data["inputs"]["service"]["range"], data["outputs"]["tip"]["range"]) == ([-2, 9], [0, 30])
    assert Controller.from_dict(data).evaluate({"service": 0})["tip"] == pytest.approx(5, abs=1e-3)


def test_what_rounding_left_is_zero() -> None:
    """MATLAB writes 1.665e-16 for a 0 that was dragged there."""
    data, _ = said(read_fis, FIS.replace("[1.5 0]", "[1.5 1.665e-16]"))
    assert data["inputs"]["the_service"]["terms"]["poor"] == {"gaussian": [0, 1.5]}
    Controller.from_dict(data)


def test_a_rule_of_matlab_without_an_output_has_no_conclusion() -> None:
    data, found = said(read_fis, f"{FIS}1 1, 0 (1) : 1\n1 1, 9 (1) : 1\n")
    assert found[1:] == [
        "31:1 this rule has no conclusion",
        "32:1 this rule refers to a term that does not exist",
    ]
    assert data["rules"] == said(read_fis, FIS)[0]["rules"]


@for_each("norm", ["algebraic", "bounded", "drastic", "einstein", "hamacher"])
def test_the_norms_of_octave(norm: str) -> None:
    """All norms of its fuzzy-logic-toolkit are read, for `and` and `or`, implication and aggregation."""
    product = f"{norm}_{'difference' if norm == 'bounded' else 'product'}"
    text = FIS.replace("AndMethod='prod'", f"AndMethod='{product}'").replace(
        "OrMethod='probor'", f"OrMethod='{norm}_sum'"
    )
    text = text.replace("ImpMethod='min'", f"ImpMethod='{product}'").replace(
        "AggMethod='max'", f"AggMethod='{norm}_sum'"
    )
    data, found = said(read_fis, text)
    assert found == ["10:1 `the service` is renamed to `the_service`"]
    both = (product.replace("_", "-"), f"{norm}-sum")
    assert tuple(data["operators"].values()) == (*both, *both)
    assert 0 <= Controller.from_dict(data).evaluate({"the_service": 9, "food": 9})["tip"] <= 30


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (JFUZZY.replace("DEFUZZIFY tip", "FUZZIFY tip").replace("METHOD : COG;", ""), "no output is left"),
        (
            JFUZZY.replace("TRIAN 0 5 10", "FUNCTION thing * 2").replace("(20, 0) (30, 1) (30, 0)", "TRIAN 9 8 7"),
            "5:15: nothing is written: no output is left (the term `cheap` of `tip` is left out",
        ),
        (JFUZZY.replace("METHOD : COG", "METHOD : COGS"), "would become a file with an error at `"),
    ],
)
def test_what_we_could_not_load_is_not_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, words: str
) -> None:
    (tmp_path / "tip.fcl").write_text(text)
    assert main(["import", str(tmp_path / "tip.fcl"), "-o", str(tmp_path / "tip.yaml")]) == 2
    assert words in (told := capsys.readouterr().err)
    assert told.count("\n") == 1
    assert not (tmp_path / "tip.yaml").exists()


def test_what_an_engine_can_not_bring_is_listed_at_its_words() -> None:
    data, found = said(read_fll, FLL)
    assert found == [
        "5:9 the term `very` of `a` is left out: a parameter is not a number",
        "12:23 this formula is left out: there is no function `bessel` with 1 argument",
        "18:17 this rule is left out: unknown name `hihg`",
        "19:25 this rule is left out: expected the name of an input here, not `then`",
        "21:12 a rule block that is switched off is left out",
    ]
    assert data["outputs"]["b"]["terms"] == {"few": {"function": "(x < 0.5) * (1 - x) + pow(sin(pi), 2)"}}
    assert data["operators"] == {"activation": {"method": "highest", "rules": 2}}
    assert data["rules"] == ["if a is low then b is few with 0.5"]


def test_rule_blocks_of_an_engine_have_names_that_are_told_apart() -> None:
    blocks = "".join(f"RuleBlock: {name}\n  rule: if a is low then b is few\n" for name in ("near by", "near,by", ""))
    data, _ = said(read_fll, FLL.partition("RuleBlock: first")[0] + blocks)
    assert list(data["blocks"]) == ["near_by", "near_by_", "block3"]


@pytest.mark.parametrize(("read", "text"), [(read_fis, FIS), (read_fcl, FCL), (read_fll, FLL)])
def test_import_export_import_is_a_fixed_point(read: Read, text: str) -> None:
    data = read("file", text.encode(), "file")[0]
    first = write_fll(Controller.from_dict(data), dotted("x"))[0]
    again = read_fll("file", first.encode(), "file")[0]
    assert again == data
    assert write_fll(Controller.from_dict(again), dotted("x"))[0] == first


def test_what_an_engine_can_not_say_is_listed() -> None:
    data = {
        "inputs": {"größe": {"range": [0, 1], "terms": {"a-b": {"ramp": [0, 1]}}}},
        "outputs": {"c": {"range": [0, 1], "default": 0, "terms": {"f": {"function": "x < 0.5 ? x : 1 - x"}}}},
        "rules": ["if größe is a-b then c is f", "if not (größe is a-b or größe is a-b) then c is f"],
    }
    text, found = write_fll(Controller.from_dict(data), dotted("x"))
    assert [d.severity for d in found].count("error") == 1
    assert {d.message.split(" ")[0] for d in found} == {"FuzzyLite", "`größe`", "`a-b`", "the"}
    again = Controller.from_dict(read_fll("x", text.encode(), "x")[0])
    assert again.evaluate({"gr_e": 0.5}) == pytest.approx(Controller.from_dict(data).evaluate({"größe": 0.5}))


def test_formulas_there_and_back() -> None:
    for theirs, value in {
        "2 ^ 3 ^ 2": 512, "-2 ^ 2": -4, "~x + 1": -1, "8 - 3 - 2": 3, "max(x, 1) % 2": 0, "gt(x, 1) and !(x or 0)": 0,
        "1 - le(x, 2) / 2": 0.5, "fabs(.-3)": 3, "2 ** 3": 8, "1e2 * .5": 50,
    }.items():  # fmt: skip
        ours = read_formula(theirs, {})
        assert isinstance(ours, str), (theirs, ours)
        assert formula(NUMBERS, ours, ())(2.0, ()) == value, (theirs, ours)
        assert read_formula(write_formula(ours, {})[0], {}) == ours


@settings(max_examples=60)
@given(st.text(alphabet="x12.+-*/^!~(), ltand", max_size=30))
def test_no_formula_breaks_the_reader(text: str) -> None:
    assert isinstance(read_formula(text, {}), str | Trouble)


@settings(max_examples=40, deadline=None)
@given(st.data())
@pytest.mark.parametrize(("read", "text"), [(read_fis, FIS), (read_fcl, FCL), (read_fll, FLL)])
def test_no_file_breaks_a_reader(read: Read, text: str, data: st.DataObject) -> None:
    """Lines are dropped, doubled and cut, and bytes of any kind are inserted."""
    lines = text.encode().splitlines(keepends=True)
    for _ in range(data.draw(st.integers(1, 4))):
        i = data.draw(st.integers(0, len(lines) - 1))
        cut = data.draw(st.integers(0, len(lines[i])))
        lines[i] = data.draw(st.sampled_from([b"", lines[i] * 2, lines[i][:cut], data.draw(st.binary(max_size=9))]))
    try:
        found = read("file", b"".join(lines), "file")[0]
    except ForeignFileError:
        return
    assert set(found) <= {"description", "inputs", "outputs", "rules", "operators", "blocks"}


@for_each(
    ("name", "content", "words"),
    [
        ("a.fll", b"", "no variables"),
        ("a.fll", b"\xff\xfe", "not UTF-8 text"),
        ("a.fll", b"a: b\n" * 30_000, "more than 20,000 lines"),
        ("a.fcl", b"FUZZIFY", "no output is left"),
        ("a.fcl", b"nothing", "no FUZZIFY"),
        ("a.fis", b"\x00" * 50, "no [Input1]"),
        ("a.fcl", b"FUZZIFY a\n" + b"(*" * 100_000, "no output is left"),
        ("a.fcl", b"FUZZIFY a TERM x := " + b"(0,1) " * 20_000 + b";", "no output is left"),
        (
            "a.fis",
            b"[Input1]\nRange=[0 1e999]\nMF1='a':'trimf',[1 2]\n[Rules]\n1e99, 1 (nan) : 1\n",
            "no output is left",
        ),
        (
            "a.fll",
            b"InputVariable: a\n range: 1e309 nan\n term: b Function " + b"(" * 5000 + b"\n",
            "no output is left",
        ),
    ],
)
def test_a_hostile_file_is_a_line_not_a_traceback(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, content: bytes, words: str
) -> None:
    (tmp_path / name).write_bytes(content)
    code = main(["import", str(tmp_path / name)])
    assert code == 2
    assert words in capsys.readouterr().err


def test_the_commands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "tipper.fis").write_text(FIS)
    assert main(["import", str(tmp_path / "tipper.fis"), "-o", str(tmp_path / "tipper.yaml")]) == 0
    assert Controller.load(tmp_path / "tipper.yaml").evaluate({"the_service": 9, "food": 9})
    assert main(["export", "fll", "-o", str(tmp_path / "head.fll")]) == 0
    assert "the controller's bindings are left out" in capsys.readouterr().err
    assert main(["import", str(tmp_path / "head.fll"), "-o", str(tmp_path / "head.yaml")]) == 0
    point = {"FaceXLoc": 80.0, "FaceYLoc": 60.0}
    assert Controller.load(tmp_path / "head.yaml").evaluate(point) == Controller.load("fuzzy/head.yaml").evaluate(point)
    assert main(["export", "fll", "hed"]) == 2
    assert "did you mean `head`?" in capsys.readouterr().err
