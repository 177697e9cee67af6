"""Behaviours of many states are checked with work that grows in proportion to their size."""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from lumen.lint import check_files, edges, endless_chains, events, falling, guards, regions
from lumen.lint.instant_chains import MAX_STEPS
from lumen.project.building import draft
from tests.formats.test_large import calls

SMALL, TIMES, SLACK = 100, 5, 2.0
"""A file five times as large may take ten times as much; a quadratic algorithm takes 25 times."""

PROJECT = b"name: x\nbehavior: hello\nlanguages: [en]\nrobot: {name: NAO, model: nao}\n"


def flat(count: int) -> str:
    return "states:\n" + "".join(f"  s{i}: {{on: {{e: s{(i + 1) % count}}}}}\n" for i in range(count))


def one_way_out(count: int) -> str:
    """Return a parallel state that each state in it leaves."""
    text = "states:\n  out: {on: {e: p}}\n  p:\n    type: parallel\n    states:\n"
    for i in range(count):
        text += f"      r{i}: {{initial: a{i}, states: {{a{i}: {{on: {{e: b{i}, x: '#out'}}}}, b{i}: {{}}}}}}\n"
    return text


def into_other_regions(count: int) -> str:
    text = "type: parallel\nstates:\n"
    for i in range(count):
        text += f"  r{i}: {{initial: a, states: {{a: {{on: {{e: '#r{(i + 1) % count}.b'}}}}, b: {{}}}}}}\n"
    return text


def back_and_forth(count: int) -> str:
    """Return two states with many events."""
    states = ((here, ", ".join(f"e{i}: {there}" for i in range(count))) for here, there in ("ab", "ba"))
    return "states:\n" + "".join(f"  {here}: {{on: {{{rows}}}}}\n" for here, rows in states)


SHAPES = {shape.__name__: shape for shape in (flat, one_way_out, into_other_regions, back_and_forth)}


@pytest.mark.slow
@pytest.mark.parametrize("rule", [edges, endless_chains, falling, guards, regions], ids=lambda rule: rule.__name__)
@pytest.mark.parametrize("shape", SHAPES)
def test_five_times_as_large_takes_five_times_the_calls(rule: ModuleType, shape: str) -> None:
    small, large = (work(rule, SHAPES[shape], count) for count in (SMALL, TIMES * SMALL))
    assert large < SLACK * TIMES * small


def work(rule: ModuleType, shape: Callable[[int], str], count: int) -> int:
    """Return the number of calls in which a rule checks a behaviour."""
    project = draft({"lumen.yaml": PROJECT, "behaviors/hello.yaml": shape(count).encode()})
    project.root = Path("/nowhere")
    assert "hello" in project.behaviors
    assert len(project.behaviors["hello"].states) > 2
    return calls(lambda: rule.check(project))


@pytest.mark.slow
def test_events_that_nothing_raises_are_found_in_few_calls() -> None:
    """To compare the events of `raise` with those of `on` once for each event would be cubic."""

    def raising(count: int) -> str:
        raised = "".join(f"      - {{raise: x{i}}}\n" for i in range(count))
        return f"{back_and_forth(count)}  c:\n    entry:\n{raised}"

    small, large = (work(events, raising, count) for count in (SMALL, TIMES * SMALL))
    assert large < TIMES * SLACK * TIMES * small


def test_a_rule_follows_no_event_that_selects_nothing() -> None:
    raised = "".join(f"      - {{raise: x{i}}}\n" for i in range(2 * MAX_STEPS))
    text = f"states:\n  a: {{on: {{go: b}}}}\n  b:\n    entry:\n{raised}    on: {{go: a}}\n"
    project = draft({"lumen.yaml": PROJECT, "behaviors/hello.yaml": text.encode()})
    endless_chains.check(project)
    assert "endless-chain" not in {str(d.code) for d in project.diagnostics}


def test_a_chain_through_an_invoked_behaviour_is_followed_again_when_that_changes() -> None:
    hello = b"initial: one\nstates:\n  one: {invoke: {behavior: short, onDone: two}}\n  two: {after: {0s: one}}\n"
    at_once, later = (f"states: {{wait: {{{way}: end}}, end: {{type: final}}}}\n" for way in ("always", "after: {1s"))
    later = later.replace("1s: end}", "1s: end}}")
    endless = []
    for short in (at_once, later, at_once):
        files = {"lumen.yaml": PROJECT, "behaviors/hello.yaml": hello, "behaviors/short.yaml": short.encode()}
        endless.append("endless-chain" in {str(d.code) for d in check_files(Path("/nowhere"), files)[1]})
    assert endless == [True, False, True]
