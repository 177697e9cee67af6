"""Files of thousands of states or targets are imported with work that grows in proportion to their size.

A quadratic algorithm needs 15 s for a state with 8,000 events, and 30 s for a transition of 8,000 targets.
test_time_taken.py measures the time.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from lumen.cli.main import main

SMALL, TIMES, SLACK = 100, 5, 2.0
"""A file five times as large may take ten times as much; a quadratic algorithm takes 25 times."""


def scxml(*parts: str) -> str:
    return f'<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0">{"".join(parts)}</scxml>'


def targets(count: int) -> str:
    regions = "".join(f'<state id="p{i}"/>' for i in range(count))
    names = " ".join(f"p{i}" for i in range(count))
    return scxml(f'<parallel id="p">{regions}</parallel><state id="z"><transition event="q" target="{names}"/></state>')


def events(count: int) -> str:
    return json.dumps({"id": "m", "states": {"a": {"on": {f"e{i}": "a" for i in range(count)}}}})


def states(count: int) -> str:
    return json.dumps({"id": "m", "states": {f"s{i}": {"on": {"e": f"s{(i + 1) % count}"}} for i in range(count)}})


def invocations(count: int) -> str:
    return scxml('<state id="a">', '<invoke src="b"/>' * count, "</state>")


def invoking_states(count: int) -> str:
    return scxml(*(f'<state id="a{i}"><invoke src="b"/></state>' for i in range(count)))


SHAPES: dict[str, tuple[str, Callable[[int], str]]] = {
    "a transition of many targets": ("scxml", targets),
    "a state of many events": ("json", events),
    "many states": ("json", states),
    "many invocations": ("scxml", invocations),
    "many states that invoke": ("scxml", invoking_states),
}


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES)
def test_five_times_as_large_takes_five_times_the_calls(shape: str, tmp_path: Path) -> None:
    imported(shape, 10, tmp_path)
    small, large = (calls(lambda count=count: imported(shape, count, tmp_path)) for count in (SMALL, TIMES * SMALL))  # type: ignore[misc]
    assert large < SLACK * TIMES * small


def imported(shape: str, count: int, folder: Path) -> None:
    ending, make = SHAPES[shape]
    file = folder / f"large.{ending}"
    file.write_text(make(count))
    assert main(["import", str(file), "-o", str(folder / "out.yaml")]) in (0, 1)


def calls(do: Callable[[], object]) -> int:
    """Return the number of functions called, in Python and in C: it is the same on every machine."""
    count = 0

    def seen(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(seen)
    try:
        do()
    finally:
        sys.setprofile(None)
    return count


def test_a_rule_of_thousands_of_conditions_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "long.fll"
    rule = " and ".join(["a is t"] * 5_000)
    head = "Engine: e\nInputVariable: a\n  range: 0 1\n  term: t Triangle 0 0.5 1\nOutputVariable: o\n  range: 0 1\n"
    output = "  defuzzifier: Centroid 100\n  term: y Triangle 0 0.5 1\n"
    file.write_text(f"{head}{output}RuleBlock: r\n  rule: if {rule} then o is y\n  rule: if a is t then o is y\n")
    assert main(["import", str(file)]) == 1
    assert "this rule is left out: the rule has more than 200 conditions" in capsys.readouterr().err
