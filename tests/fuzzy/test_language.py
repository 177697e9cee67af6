"""Short forms of controller files, and their formulas; every fault is reported at its word."""

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.errors import LumenError, ProjectError
from lumen.fuzzy import Controller
from lumen.fuzzy.arithmetic import NUMBERS, arrays
from lumen.fuzzy.formulas import FORMULA_FUNCTIONS, formula
from lumen.project.controllers import build_controller
from lumen.project.document_report import DocumentReport
from lumen.project.schema import check_schema, load_schema
from lumen.project.yaml_reader import parse
from tests.tables import for_each

TABLE = """inputs:
  a: {range: [0, 10]}
outputs:
  c: {range: [0, 10], default: 0}
  d: {range: [0, 10], default: 0, defuzzifier: weighted-average, terms: {f: {function: "c + a * 2"}}}
terms:
  gaussian:
    Low: {a: [0, 3], c: [0, 3]}
    High: {a: [10, 3], c: [10, 3]}
rules:
  - if a is Low then c is Low
  - if a is High then c is High and d is f
"""


def found(text: str) -> list[str]:
    document, _ = parse("f.yaml", text.encode())
    assert document
    report = DocumentReport(document)
    build_controller(check_schema(document, "controller", report), report, name="f")
    places = [(d.place, d.code) for d in report.diagnostics]
    lines = text.splitlines()
    return [f"{code} {lines[p.line - 1][p.column - 1 : p.end_column - 1]}" for p, code in places]


def test_the_shipped_table_says_what_each_variable_says_at_length() -> None:
    short, long = Controller.load("fuzzy/head.yaml"), Controller.load("tests/fuzzy/at_length.yaml")
    assert (short.inputs, short.outputs, short.rules) == (long.inputs, long.outputs, long.rules)
    assert (short.input_bindings, short.output_bindings, short.tracking) == (
        long.input_bindings,
        long.output_bindings,
        long.tracking,
    )


def test_the_shipped_controller_fits_on_one_screen() -> None:
    with open("fuzzy/head.yaml") as file:
        assert len(file.readlines()) <= 50


@for_each(
    ("old", "new", "expected"),
    [
        ("Low: {a: [0, 3]", "Low: {b: [0, 3]", ["unknown-variable b"]),
        ("Low: {a: [0, 3]", "Low: {a: [0, -3]", ["not-positive -3"]),
        ("Low: {a: [0, 3]", "Low: {a: [0]", ["wrong-parameters [0]"]),
        ("Low: {a: [0, 3]", "Low: {a: [.nan, 3]", ["not-a-number .nan"]),
        ("  gaussian:\n    Low", "  gausian:\n    Low", ["unknown-key gausian"]),
        ("a: {range: [0, 10]}", "a: {range: [0, 10], terms: {Low: {ramp: [9, 2]}}}", ["two-shapes a"]),
        (
            "    High: {a: [10, 3], c: [10, 3]}",
            "    High: {a: [10, 3], c: [10, 3]}\n  constant: {Mid: {c: 3}}",
            ["term-without-set c"],
        ),
        ("c + a * 2", "c + e * 2", ["unknown-name e"]),
        ("c + a * 2", "d + a", ["unknown-name d"]),
        ("c + a * 2", "sine(a)", ["unknown-function sine"]),
        ("c + a * 2", "max(a)", ["wrong-argument-count max"]),
        ("c + a * 2", "c + ", ["expression-syntax  "]),
        ("c + a * 2", "c + 'a'", ["type-mismatch 'a'"]),
        ("c + a * 2", "c.a", ["type-mismatch c"]),
        ("[0, 10], default: 0, defuzz", "[10, 0], default: 0, defuzz", ["empty-range [10, 0]"]),
        ("  c: {range", "  e: {range: [0, 10]}\n  c: {range", ["missing-key e"]),
    ],
)
def test_a_fault_in_the_table_or_a_formula_is_shown_at_its_word(old: str, new: str, expected: list[str]) -> None:
    assert TABLE.count(old) == 1
    assert found(TABLE.replace(old, new)) == expected


def test_the_schema_s_own_examples_are_sound() -> None:
    """The loader accepts each example of a term or table in the schema."""
    schema = load_schema("controller")
    for kind, spec in schema["$defs"]["term"]["properties"].items():
        for example in spec.get("examples", ()):
            weighted = kind in ("constant", "linear") or "inputX" in str(example)
            inputs = {"inputX": {"range": [0, 10]}, "b": {"range": [0, 1]}}
            output = {"range": [0, 10], "default": 0, "defuzzifier": "weighted-average" if weighted else "centroid"}
            data = {
                "inputs": inputs,
                "outputs": {"c": {**output, "terms": {"t": {kind: example}}}},
                "rules": ["if inputX is any then c is t"],
            }
            Controller.from_dict(json.loads(json.dumps(data)))


def test_a_formula_without_a_value_is_silence_never_a_number() -> None:
    data: dict[str, Any] = {
        "inputs": {"a": {"range": [-1, 1]}},
        "outputs": {"c": {"range": [-9, 9], "defuzzifier": "weighted-sum", "terms": {"f": {"function": "sin(a) / a"}}}},
        "rules": ["if a is any then c is f"],
    }
    with pytest.raises(LumenError, match="no rule for `c` fires at a = 0"):
        Controller.from_dict(data).evaluate({"a": 0})
    data["outputs"]["c"]["default"] = 4
    silent = Controller.from_dict(data)
    assert silent.evaluate({"a": 0}) == {"c": 4}
    assert silent.evaluate_batch({"a": [0, 1e-9, 1]})["c"] == pytest.approx([4, 1, np.sin(1)])


def test_what_is_infinite_counts_as_silence() -> None:
    data = {
        "inputs": {"a": {"range": [0, 1], "terms": {}}},
        "outputs": {
            "c": {"range": [0, 1], "default": 7, "defuzzifier": "weighted-sum", "terms": {"l": {"linear": [1]}}}
        },
        "rules": ["if a is any then c is l"],
    }
    controller = Controller.from_dict(data)
    assert controller.evaluate({"a": float("inf")}) == {"c": 7}
    assert controller.evaluate_batch({"a": [float("inf"), 0.5]})["c"] == pytest.approx([7, 0.5])


FORMULAS = [
    "x + a", "x - a * b", "a / b", "-x % 2", "a < b", "a <= b == (x > 0)", "a != b && b >= x", "!(a > 1) || x < 0",
    "a > 0 ? sqrt(a) : 1 / b", "x > 0 && 1 / x > 0.5 ? 1 : 0", "pow(a, b)", "min(a, max(b, x))", "atan2(a, b) + pi",
    *(f"{name}({', '.join('ab'[:count])})" for name, count in FORMULA_FUNCTIONS.items()),
]  # fmt: skip
number = st.one_of(st.floats(-20, 20), st.sampled_from([0.0, 1.0, -1.0, 2.0]))


@given(st.sampled_from(FORMULAS), st.lists(st.tuples(number, number, number), min_size=1, max_size=6))
def test_a_formula_is_the_same_on_numbers_and_arrays(text: str, points: list[tuple[float, float, float]]) -> None:
    one, many = formula(NUMBERS, text, ("a", "b")), formula(arrays(), text, ("a", "b"))
    x, a, b = np.array(points).T
    single = [one(x, (a, b)) for x, a, b in points]
    assert many(x, (a, b)) == pytest.approx(single, rel=1e-9, abs=1e-9, nan_ok=True)


def test_a_long_chain_of_signs_is_refused_not_crashed_on() -> None:
    with pytest.raises(ProjectError, match="levels"):
        Controller.from_dict(
            {
                "inputs": {"a": {"range": [0, 1], "terms": {"t": {"function": "-" * 300 + "x"}}}},
                "outputs": {"c": {"range": [0, 1], "terms": {"t": {"ramp": [0, 1]}}}},
                "rules": ["if a is t then c is t"],
            }
        )
