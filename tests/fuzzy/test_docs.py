"""The figures and claims of docs/fuzzy.md and docs/erratum.md agree with the code."""

import re
from pathlib import Path

import pytest

import lumen
from lumen.fuzzy import Controller
from lumen.fuzzy.formulas import FORMULA_FUNCTIONS
from lumen.language.controllers import ACTIVATIONS, DEFUZZIFIERS, HEDGES, S_NORMS, T_NORMS, TERM_PARAMETERS
from tests.fuzzy.test_signals import FILES

FUZZY = Path("docs/fuzzy.md").read_text()
ERRATUM = Path("docs/research.md").read_text()


def test_every_word_of_the_language_is_there() -> None:
    for word in (*TERM_PARAMETERS, *HEDGES, *T_NORMS, *S_NORMS, *ACTIVATIONS, *DEFUZZIFIERS):
        assert f"`{word}`" in FUZZY or f"{{method: {word}}}" in FUZZY, word
    assert set(FORMULA_FUNCTIONS) <= set(re.findall(r"\w+", FUZZY))


def test_the_examples_are_the_shipped_controller_and_a_tested_one() -> None:
    head, loudness = re.findall(r"```yaml\n(.*?)```", FUZZY, re.DOTALL)
    assert head in Path("fuzzy/head.yaml").read_text()
    assert loudness in FILES["fuzzy/loudness.yaml"]


@pytest.mark.parametrize(("output", "name"), [("AngleX", "FaceXLoc"), ("AngleY", "FaceYLoc")])
def test_the_erratum_s_numbers(output: str, name: str) -> None:
    table = ERRATUM.partition(f"| {output} [deg] at {name}")[2]
    rows = [[cell.strip(" *") for cell in line.split("|")[1:-1]] for line in table.splitlines()[:4]]
    xs = [float(cell.split()[0]) for cell in rows[0][-5:]]
    for row, file in ((rows[2], "examples/erratum/fuzzy/head.yaml"), (rows[3], "fuzzy/head.yaml")):
        controller = Controller.load(file)
        rest = {n: float(v.neutral or 0.0) for n, v in controller.inputs.items()}
        said = [controller.evaluate({**rest, name: x})[output] for x in xs]
        assert said == pytest.approx([float(cell) for cell in row[-5:]], abs=6e-4)


def test_the_erratum_names_what_lint_finds() -> None:
    named = set(re.findall(r"controllers\.md#([\w-]+)", ERRATUM))
    found = [d.code for d in lumen.check("examples/erratum")]
    assert named == set(found)
    assert (len(found), "eight warnings, of four kinds" in ERRATUM) == (8, True)
