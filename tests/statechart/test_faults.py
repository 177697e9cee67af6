"""Mistakes in a machine are reported with their place; no content of a dict or a file causes a traceback."""

from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import LumenError, ProjectError, UsageError
from lumen.statechart import Event, Machine, initial, step
from tests.tables import for_each

FAULTS: dict[str, tuple[str, str, str, str]] = {
    "unknown sibling": ("states: {idle: {on: {go: gret}}, greet: }", "unknown-state", "gret", "did you mean `greet`?"),
    "child without its dot": (
        "states: {a: {on: {go: b}, states: {b: }}}",
        "unknown-state",
        "b}",
        "`b` is a child state: write `.b`",
    ),
    "state elsewhere": ("states: {a: {on: {go: c}}, b: {states: {c: }}}", "unknown-state", "c}}", "`#b.c`"),
    "unknown id": ("states: {a: {id: one, on: {go: '#on'}}}", "unknown-state", "'#on'", "`#one`"),
    "second of a list": ("states: {a: {on: {go: {target: [a, x]}}}}", "unknown-state", "x]", ""),
    "initial": ("initial: c\nstates: {a: , b: }", "unknown-state", "c\n", ""),
    "initial elsewhere": (
        "states: {a: {initial: '#b', states: {c: }}, b: }",
        "not-within",
        "'#b'",
        "it has `c`",
    ),
    "history of another": (
        "states: {a: {states: {h: {type: history, target: '#b'}, c: }}, b: }",
        "not-within",
        "'#b'",
        "",
    ),
    "duplicate id": ("states: {a: {id: x}, b: {id: x}}", "duplicate-id", "x}}", ""),
    "id like a path": ("states: {a: , b: {id: a}}", "duplicate-id", "a}}", ""),
    "after": ("states: {a: {after: {20: a}}}", "bad-duration", "20", "20s"),
    "wait": ("states: {a: {do: {wait: 2 sec}}}", "bad-duration", "2 sec", "`2s`"),
    "delay": ("states: {a: {entry: {send: {event: x, delay: soon}}}}", "bad-duration", "soon", ""),
    "wait outside do": ("states: {a: {entry: {wait: 2s}}}", "only-in-do", "wait", "`send`"),
    "parallel outside do": ("states: {a: {exit: [{parallel: [{say: x}]}]}}", "only-in-do", "parallel", "`do`"),
    "targets of one region": (
        "states: {a: {on: {go: {target: [b, c]}}}, b: , c: }",
        "conflicting-targets",
        "[b, c]",
        "regions",
    ),
    "final with transitions": ("states: {a: {type: final, on: {go: a}}}", "misplaced-key", "on:", ""),
    "history with actions": ("states: {a: , h: {type: history, entry: {say: x}}}", "misplaced-key", "entry", ""),
    "target of an ordinary state": ("states: {a: {target: a}}", "misplaced-key", "target", "`on`"),
    "initial of a parallel": ("type: parallel\ninitial: a\nstates: {a: }", "misplaced-key", "initial", ""),
    "empty compound": ("states: {a: {type: parallel}}", "no-states", "a:", "`states`"),
    "onDone without do": ("states: {a: {onDone: a}}", "never-done", "onDone", "`do`"),
    "endless always": ("states: {a: {always: {actions: {log: x}}}}", "endless-always", "{actions", "`guard`"),
    "syntax": ("states: {a: {on: {go: {guard: 1 + , target: a}}}}", "expression-syntax", "", ""),
    "context key": (
        "context: {asked: 0}\nstates: {a: {entry: {assign: {askd: 1}}}}",
        "unknown-context-key",
        "askd",
        "`asked`",
    ),
    "key in an expression": (
        "context: {asked: 0}\nstates: {a: {always: {guard: context.askd > 1, target: a}}}",
        "unknown-context-key",
        "askd",
        "`asked`",
    ),
    "key in a text": (
        "context: {asked: 0}\nstates: {a: {entry: {say: 'I say {{ context.askd }}'}}}",
        "unknown-context-key",
        "askd",
        "`asked`",
    ),
    "state in In": ("states: {abc: {always: {guard: \"In('abd')\", target: abc}}}", "unknown-state", "", "`abc`"),
    "type of no key": ("types: {x: {type: string}}\nstates: {a: }", "unknown-context-key", "x:", ""),
    "renamed": ("renamed: {x: b}\nstates: {a: }", "unknown-state", "b}", ""),
    "onReload": ("states: {a: {onReload: c}, b: }", "unknown-state", "c}", ""),
    "invoke": ("states: {a: {invoke: {behavior: quiz}}}", "unknown-behavior", "quiz", ""),
    "invoke of itself": (
        "states: {a: {invoke: {behavior: tour}}}",
        "invoke-cycle",
        "tour",
        "use a state instead of `invoke`",
    ),
    "two verbs": ("states: {a: {entry: {say: x, play: y}}}", "one-verb", "", ""),
    "unknown verb": ("states: {a: {entry: {sai: x}}}", "unknown-key", "sai", "`say`"),
}


@for_each("name", FAULTS)
def test_a_fault_is_told_at_its_word(name: str, tmp_path: Path) -> None:
    text, code, word, hint = FAULTS[name]
    file = tmp_path / "tour.yaml"
    file.write_text(text)
    with pytest.raises(ProjectError) as caught:
        Machine.load(file)
    [found] = caught.value.diagnostics
    line = text.splitlines()[found.place.line - 1] + "\n"
    assert found.code == code
    assert line[found.place.column - 1 :].startswith(word)
    assert hint in found.hint


def test_all_faults_are_told_together(tmp_path: Path) -> None:
    file = tmp_path / "tour.yaml"
    file.write_text("states:\n  a: {on: {go: x}, after: {soon: a}}\n  b: {entri: {say: 1}}\n  c: {on: {go: b}}\n")
    with pytest.raises(ProjectError) as caught:
        Machine.load(file)
    assert [(d.code, d.place.line) for d in sorted(caught.value.diagnostics, key=lambda d: d.place)] == [
        ("unknown-state", 2),
        ("bad-duration", 2),
        ("unknown-key", 3),
    ]


def test_a_dict_names_the_path_in_place_of_a_line() -> None:
    with pytest.raises(ProjectError) as caught:
        Machine.from_dict({"states": {"a": {"on": {"go": "b"}}}})
    assert caught.value.diagnostics[0].place.file == "machine (states.a.on.go)"


def test_a_missing_file_is_a_usage_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no such file"):
        Machine.load(tmp_path / "tour.yaml")


def test_an_endless_chain_ends_in_an_error_that_names_the_states() -> None:
    machine = Machine.from_dict({"states": {"a": {"on": {"go": "b"}}, "b": {"always": "c"}, "c": {"always": "b"}}})
    with pytest.raises(LumenError, match=r"never comes to rest.*`b`, `c`"):
        step(machine, initial(machine).snapshot, Event("go"))


def test_an_endless_chain_names_the_states_of_its_loop_and_not_those_before() -> None:
    way = {f"way{i}": {"always": f"way{i + 1}"} for i in range(20)}
    states = {"a": {"on": {"go": "way0"}}, **way, "way20": {"always": "b"}, "b": {"always": "c"}, "c": {"always": "b"}}
    machine = Machine.from_dict({"states": states})
    with pytest.raises(LumenError, match="goes through `b`, `c`; "):
        step(machine, initial(machine).snapshot, Event("go"))


def test_nesting_without_end_is_a_diagnostic() -> None:
    data: dict[str, Any] = {"states": {"a": None}}
    for _ in range(200):
        data = {"states": {"a": data}}
    with pytest.raises(ProjectError) as caught:
        Machine.from_dict(data)
    assert "too-large" in {d.code for d in caught.value.diagnostics}


@pytest.mark.slow
def test_a_dict_that_holds_itself_is_a_diagnostic() -> None:
    data: dict[str, Any] = {"states": {"a": None}}
    data["states"].update({"b": data, "c": data})
    with pytest.raises(ProjectError) as caught:
        Machine.from_dict(data)
    assert "too-large" in {d.code for d in caught.value.diagnostics}


@pytest.mark.slow
def test_ten_thousand_states_run() -> None:
    count = 10_000
    states = {f"s{i}": {"on": {"go": f"s{(i + 1) % count}"}} for i in range(count)}
    machine = Machine.from_dict({"states": states})
    snapshot = initial(machine).snapshot
    assert step(machine, snapshot, Event("go")).entered == ("s1",)


@pytest.mark.slow
def test_a_thousand_regions_run() -> None:
    regions = {f"r{i}": {"states": {"a": {"on": {"go": "b"}}, "b": None}} for i in range(1_000)}
    machine = Machine.from_dict({"type": "parallel", "states": regions})
    taken = step(machine, initial(machine).snapshot, Event("go"))
    assert len(taken.entered) == 1_000


WORDS = [
    "id", "context", "initial", "states", "type", "on", "always", "after", "entry", "do", "exit", "onDone", "target",
    "guard", "actions", "history", "output", "events", "types", "phrases", "answers", "units", "a", "b", "2s", "say",
    "assign", "send", "if", "then", "parallel", "wait", "onReload", "renamed", "play", "look", "walk", "invoke",
]  # fmt: skip
SCALARS = st.one_of(
    st.none(), st.booleans(), st.integers(-3, 3), st.floats(), st.sampled_from([*WORDS, ".a", "#a", "1 +", "{{ x }}"])
)
TREES = st.recursive(
    SCALARS, lambda t: st.lists(t, max_size=3) | st.dictionaries(st.sampled_from(WORDS), t, max_size=4), max_leaves=30
)


@pytest.mark.slow
@settings(max_examples=100, deadline=None)
@given(TREES, TREES)
def test_any_data_is_a_machine_or_a_project_error(top: Any, inner: Any) -> None:
    for data in (top, {"states": {"a": inner, "b": top}}, {"states": {"a": {"on": {"go": inner}, "do": top}}}):
        with suppress(LumenError):  # a machine may be sound and go round for ever
            initial(Machine.from_dict(data))
