"""pyfuzzylite as an oracle, for its own examples and for each word of the language by itself.

The only difference: if pyfuzzylite returns NaN or infinity, Lumen returns the default value or raises an error.
"""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from random import Random
from typing import Any

import fuzzylite as fl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import LumenError
from lumen.features.formats_fuzzy.fll import read_fll, write_fll
from lumen.fuzzy import Controller
from lumen.fuzzy.arithmetic import NUMBERS
from lumen.fuzzy.memberships import membership
from lumen.fuzzy.norms import norm
from lumen.fuzzy.program import hedged
from lumen.fuzzy.weighted import INVERSE_MEMBERSHIPS, value
from lumen.language.controllers import (
    DEFUZZIFIERS,
    HEDGES,
    INTEGRAL_DEFUZZIFIERS,
    S_NORMS,
    T_NORMS,
    TERM_PARAMETERS,
    Term,
)
from lumen.project.formats.conversion_findings import dotted
from tests.scanning import matching
from tests.tables import for_each

EXAMPLES = matching(Path(fl.__file__).parent / "examples", "**/*.fll")
EDGES = {"binary": 1, "arc": 1}
"""The number of parameters at which memberships are compared, if not all: their falling arc has a gap at its end."""
factories = fl.settings.factory_manager


def camel(word: str) -> str:
    return "".join(part.capitalize() for part in word.split("-"))


def theirs(engine: Any, inputs: Mapping[str, float]) -> dict[str, float]:
    with np.errstate(all="ignore"):
        for variable in engine.input_variables:
            variable.value = inputs[variable.name]
        engine.process()
    return {variable.name: float(np.squeeze(variable.value)) for variable in engine.output_variables}


def compared(ours: Controller, engine: Any, points: list[dict[str, float]]) -> Iterator[tuple[float, float]]:
    """Yield each output of both engines; if theirs is not finite, ours must raise instead."""
    previous: dict[str, float] = {}
    for point in points:
        expected = theirs(engine, point)
        try:
            previous = ours.evaluate(point, previous)
        except LumenError:
            assert not all(map(math.isfinite, expected.values()))
            continue
        yield from ((previous[name], value) for name, value in expected.items())


def agree(ours: Controller, engine: Any, points: list[dict[str, float]]) -> int:
    """Compare all outputs to within 1e-6 and return their number."""
    pairs = list(compared(ours, engine, points))
    assert [mine for mine, _ in pairs] == pytest.approx([other for _, other in pairs], abs=1e-6)
    return len(pairs)


def example(file: Path) -> tuple[Mapping[str, Any], list[Any], Controller, Any, list[dict[str, float]]]:
    """Return an example of the package: our data and findings, both engines, and 50 points in its ranges."""
    data, found = read_fll(str(file), file.read_bytes(), file.stem)
    engine, draw = fl.FllImporter().from_file(file), Random(file.stem)
    points = [
        {v.name: draw.uniform(float(v.minimum), float(v.maximum)) for v in engine.input_variables} for _ in range(50)
    ]
    return data, found, Controller.from_dict(data), engine, points


def test_the_package_carries_its_examples() -> None:
    assert len(EXAMPLES) == 61


@for_each("file", EXAMPLES, ids=lambda file: "/".join(file.parts[-3:]))
def test_an_example_of_the_package(file: Path) -> None:
    data, found, controller, engine, points = example(file)
    assert {d.message for d in found if d.severity == "error"} <= {"the range of `theta` is empty"}
    assert agree(controller, engine, points) >= 40
    again = {**read_fll(str(file), write_fll(controller, dotted("x"))[0].encode(), file.stem)[0]}
    assert plain(again) == plain(data)


def plain(data: Mapping[str, Any]) -> dict[str, Any]:
    """Drop the descriptions from a controller's data, because FuzzyLite's files cannot store them."""
    variables = {
        side: {name: {k: v for k, v in spec.items() if k != "description"} for name, spec in data[side].items()}
        for side in ("inputs", "outputs")
    }
    return {**{k: v for k, v in data.items() if k != "description"}, **variables}


number = st.floats(-50, 50).map(lambda x: round(x, 3))
width = st.floats(0.05, 30).map(lambda x: round(x, 3))


def shaped(kind: str) -> st.SearchStrategy[tuple[float, ...]]:
    """Return a strategy for the parameters of a kind of term, in our order, which is FuzzyLite's."""
    names = TERM_PARAMETERS[kind]
    ascending = st.lists(number, min_size=len(names), max_size=len(names), unique=True).map(sorted).map(tuple)
    match kind:
        case "triangle" | "trapezoid" | "pi-shape" | "s-shape" | "z-shape" | "rectangle":
            return ascending
        case "gaussian" | "spike" | "cosine":
            return st.tuples(number, width)
        case "gaussian-product":
            return st.tuples(number, width, number, width)
        case "bell":
            return st.tuples(number, width, width)
        case "sigmoid":
            return st.tuples(number, st.floats(-9, 9).filter(lambda s: abs(s) > 0.01))
        case "sigmoid-difference" | "sigmoid-product":
            return st.tuples(number, width, width, number)
        case "binary":
            return st.tuples(number, st.sampled_from([math.inf, -math.inf]))
        case "discrete":
            points = st.lists(number, min_size=2, max_size=5, unique=True).map(sorted)
            return points.map(lambda xs: tuple(v for i, x in enumerate(xs) for v in (x, (i * 0.37) % 1)))
    return st.lists(number, min_size=2, max_size=2, unique=True).map(tuple)


@settings(max_examples=15, deadline=None)
@given(st.data(), st.lists(st.floats(-100, 100), min_size=1, max_size=8), st.sampled_from([1.0, 0.4]))
@pytest.mark.parametrize("kind", [kind for kind in TERM_PARAMETERS if kind not in ("constant", "linear", "function")])
def test_a_term(kind: str, data: st.DataObject, xs: list[float], height: float) -> None:
    parameters = data.draw(shaped(kind))
    other = factories.term.construct(camel(kind), name="t")
    other.configure(" ".join(map(repr, (*parameters, height))))
    mine = membership(NUMBERS, Term("t", kind, parameters, height))
    with np.errstate(all="ignore"):
        for x in (*xs, *parameters[: EDGES.get(kind)]):
            expected = float(other.membership(x))  # NaN at the very edges of a semi-ellipse
            assert mine(x) == pytest.approx(0.0 if math.isnan(expected) else expected, abs=1e-6), x
        assert math.isfinite(mine(math.inf))
        assert math.isfinite(mine(-math.inf))


@settings(max_examples=15, deadline=None)
@given(st.data(), st.floats(0.01, 0.99), st.sampled_from([1.0, 0.4]))
@pytest.mark.parametrize("kind", sorted(set(INVERSE_MEMBERSHIPS) - {"arc"}))
def test_a_term_read_backwards(kind: str, data: st.DataObject, part: float, height: float) -> None:
    parameters = data.draw(shaped(kind))
    other = factories.term.construct(camel(kind), name="t")
    other.configure(" ".join(map(repr, (*parameters, height))))
    degree = part * height
    found = value(NUMBERS, Term("t", kind, parameters, height))(degree, ())
    assert found == pytest.approx(float(other.tsukamoto(degree)), rel=1e-9, abs=1e-9)


degree = st.one_of(st.floats(0, 1), st.sampled_from([0.0, 0.25, 0.5, 1.0]))


@settings(max_examples=25, deadline=None)
@given(degree, degree)
@pytest.mark.parametrize("name", [*T_NORMS, *S_NORMS])
def test_a_norm(name: str, a: float, b: float) -> None:
    factory = factories.tnorm if name in T_NORMS else factories.snorm
    with np.errstate(all="ignore"):
        expected = float(factory.construct(camel(name)).compute(a, b))
    assert norm(NUMBERS, name)(a, b) == pytest.approx(0.0 if math.isnan(expected) else expected, abs=1e-12)


@settings(max_examples=25, deadline=None)
@given(degree)
@pytest.mark.parametrize("hedge", HEDGES)
def test_a_hedge(hedge: str, x: float) -> None:
    assert hedged(NUMBERS, (hedge,), x) == pytest.approx(float(factories.hedge.construct(hedge).hedge(x)), abs=1e-12)


ACTIVATED = ("General", "First 2 0.1", "Last 2 0.1", "Highest 2", "Lowest 2", "Proportional", *(
    f"Threshold {comparison} 0.5" for comparison in ("<", "<=", "==", "!=", ">=", ">")))  # fmt: skip
ENGINE = """Engine: e
InputVariable: a
  range: 0 10
  term: low Gaussian 1 3.1
  term: mid Triangle 2 5 8
  term: high Gaussian 9 3.3
InputVariable: b
  range: 0 10
  term: low Ramp 9 1
  term: high SShape 2 9
OutputVariable: c
  range: -3 8
  aggregation: {aggregation}
  defuzzifier: {defuzzifier}
  default: 4
{terms}RuleBlock:
  conjunction: {conjunction}
  disjunction: {disjunction}
  implication: {implication}
  activation: {activation}
  rule: if a is low and b is very high then c is small with 0.9
  rule: if a is mid or (b is low and a is not high) then c is medium
  rule: if a is somewhat high then c is big
  rule: if b is extremely low or a is seldom low then c is small
  rule: if a is mid and b is any then c is big with 0.3
"""
SETS = "  term: small Gaussian -2 1.5\n  term: medium Triangle 0 2 6\n  term: big ZShape 3 7\n"
VALUES = "  term: small Constant -2\n  term: medium Linear 0.3 -0.2 1\n  term: big Function sin(a) + b ^ 2 / 50\n"
BACKWARDS = "  term: small Ramp 4 -3\n  term: medium Sigmoid 1 2\n  term: big SShape 2 8\n"


def both(**words: str) -> tuple[Controller, Any]:
    usual = {"aggregation": "Maximum", "conjunction": "Minimum", "disjunction": "Maximum", "implication": "Minimum",
             "activation": "General", "defuzzifier": "Centroid 200", "terms": SETS}  # fmt: skip
    text = ENGINE.format(**usual | words)
    data, found = read_fll("e.fll", text.encode(), "e")
    assert not found
    return Controller.from_dict(data), fl.FllImporter().from_string(text)


def spread(count: int, low: float = 0.0, high: float = 10.0) -> list[dict[str, float]]:
    draw = Random(count)
    return [{"a": draw.uniform(low, high), "b": draw.uniform(low, high)} for _ in range(count)]


@for_each("activation", ACTIVATED)
def test_an_activation(activation: str) -> None:
    assert agree(*both(activation=activation), spread(30)) == 30


@for_each("method", DEFUZZIFIERS)
def test_a_defuzzifier(method: str) -> None:
    terms = SETS if method in INTEGRAL_DEFUZZIFIERS else VALUES
    resolution = " 200" if method in INTEGRAL_DEFUZZIFIERS else ""
    assert agree(*both(defuzzifier=camel(method) + resolution, terms=terms), spread(30)) == 30


@pytest.mark.parametrize("method", ["WeightedAverage", "WeightedSum"])
def test_terms_read_backwards_in_a_controller(method: str) -> None:
    """Every term needs a weight: a term without one counts nothing in Lumen, and makes pyfuzzylite's output NaN."""
    assert agree(*both(defuzzifier=method, terms=BACKWARDS, aggregation="Maximum"), spread(30, 2.1, 7.9)) == 30


@for_each("name", T_NORMS)
def test_a_t_norm_in_a_controller(name: str) -> None:
    assert agree(*both(conjunction=camel(name), implication=camel(name)), spread(10)) == 10


@for_each("name", S_NORMS)
def test_an_s_norm_in_a_controller(name: str) -> None:
    disjunction = "AlgebraicSum" if name == "unbounded-sum" else camel(name)
    assert agree(*both(disjunction=disjunction, aggregation=camel(name)), spread(10)) == 10
