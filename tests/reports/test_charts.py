"""Mistakes in statecharts from bug reports of other systems: lint finds each, and nothing in right ones."""

import re
from pathlib import Path
from typing import Any

import pytest

from lumen.errors import LumenError
from lumen.language.diagnostics import nearest
from lumen.lint import check_files
from lumen.project.yaml_reader import parse
from lumen.statechart import Interpreter, Machine
from tests.tables import for_each

INPUTS = Path(__file__).parent / "inputs" / "charts"


SETTINGS = b"name: Charts\nbehavior: hello\nlanguages: [en]\nrobot: {name: NAO, model: nao}\n"


def lint(hello: str, **others: str) -> list[str]:
    """Return the findings of a small project with that behaviour and others by name."""
    files = {"lumen.yaml": SETTINGS, "behaviors/hello.yaml": hello.encode()}
    files |= {f"behaviors/{name}.yaml": text.encode() for name, text in others.items()}
    found = check_files(INPUTS, files)[1]
    return [f"{d.place.line}:{d.place.column} {d.code}: {d.message} ({d.hint})" for d in found]


def of(name: str) -> str:
    return (INPUTS / name).read_text("utf-8")


def test_a_star_above_the_end_is_found() -> None:
    assert lint(of("star-before-done.yaml")) == [
        "7:13 shadowed-transition: this transition is never taken: the one on line 5 is always taken first"
        " (write `onDone` above `on`, or name the events instead of `*`)"
    ]


@for_each(
    ("state", "found"),
    [
        ('{on: {"*": b}, do: {say: Hi}, onDone: c}', True),
        ('{do: {say: Hi}, onDone: c, on: {"*": b}}', False),
        ("{on: {done: b}, do: {say: Hi}, onDone: c}", True),
        ("{on: {error.*: b}, do: {say: Hi}, onDone: c}", False),
        ("{on: {error.*: b}, do: {say: Hi}, onDone: c, onError: c}", True),
        ('{on: {"*": b}, initial: x, states: {x: {type: final}}, onDone: c}', True),
        ('{on: {"*": b}, invoke: {behavior: quick, onDone: c}}', True),
        ('{on: {"*": {guard: "event.name != \'done.do.a\'", target: b}}, do: {say: Hi}, onDone: c}', False),
        ('{on: {"*": b}, do: {say: Hi}, after: {5s: c}}', False),  # a timer is selected by no name
        ("{on: {after.5s.a: b}, after: {5s: c}}", False),
        ('{initial: invoke, states: {invoke: {on: {"*": "#c"}, do: {say: H}, onDone: x}, x: {on: {e: "#c"}}}}', True),
    ],
)
def test_an_end_below_a_key_that_handles_it(state: str, found: bool) -> None:
    chart = f"initial: a\nstates:\n  a: {state}\n  b: {{after: {{5s: a}}}}\n  c: {{id: c, after: {{5s: a}}}}\n"
    codes = [line.split()[1] for line in lint(chart, quick=of("quick.yaml"))]
    assert ("shadowed-transition:" in codes) == found, codes


@for_each(
    ("name", "message"),
    [
        ("endless-guarded.yaml", "6:59 always-loop: this loop never ends while `context.balance > 300` is false"),
        ("endless-invoke.yaml", "4:44 endless-chain: this loop never ends: `done.invoke.quick` of `work`"),
    ],
)
def test_an_endless_chain_is_found(name: str, message: str) -> None:
    (found,) = lint(of(name), **({"quick": of("quick.yaml")} if "invoke" in name else {}))
    assert found.startswith(message)


INVOKED = {
    "quick": "initial: a\nstates: {a: {type: final}}\n",
    "slow": "initial: a\nstates: {a: {after: {1s: b}}, b: {type: final}}\n",
    "outer": "initial: a\nstates: {a: {invoke: {behavior: quick, onDone: b}}, b: {type: final}}\n",
    "two": "type: parallel\nstates: {a: {states: {x: {type: final}}}, b: {states: {x: {type: final}}}}\n",
}


def endless(states: str) -> list[str]:
    """Return lint's findings on endless chains of these states; `touched` enters `a`, and `c` is quiet."""
    chart = f"initial: c\ncontext: {{n: 0}}\nstates: {{c: {{on: {{touched: a}}}}, {states}}}\n"
    found = lint(chart, **{name: text for name, text in INVOKED.items() if name in states})
    assert not any("this loop never ends" in line for line in found) or not rests(chart), found
    return [line.partition(": ")[2] for line in found if "endless-chain" in line or "always-loop" in line]


def rests(chart: str) -> bool:
    """Return whether the engine comes to rest after the event; more than 100 instant steps are no rest."""
    data = {name: parse(name, text.encode())[0] for name, text in {"chart": chart, **INVOKED}.items()}
    read = {name: document.data for name, document in data.items() if document is not None}
    steps: list[Any] = []

    def observe(step: Any) -> None:
        steps.append(step)
        if len(steps) + len(step.transitions) > 100:
            raise LumenError("there is no rest")

    it = Interpreter(Machine.from_dict(read.pop("chart"), behaviors=read), observe=observe)
    try:
        it.start()
        for _ in range(2):
            it.send("touched")
            it.clock.advance(0.5)
    except LumenError:
        return False
    return True


@for_each(
    ("states", "way"),
    [
        ("a: {entry: {raise: go}, on: {go: b, touched: c}}, b: {entry: {raise: back}, on: {back: a}}",
         "`go` of `a`, `back` of `b`"),
        ("a: {do: {log: x}, onDone: b, on: {touched: c}}, b: {after: {0s: a}}",
         "`done.do.a` of `a`, `after: 0s` of `b`"),
        ("a: {after: {0s: b}}, b: {after: {0s: a}, on: {touched: c}}", "`after: 0s` of `a`, `after: 0s` of `b`"),
        ("a: {after: {0s: b}, do: {say: Hi}, onDone: c}, b: {always: a}", "`after: 0s` of `a`, `always` of `b`"),
        ("a: {do: {send: go}, on: {go: a, touched: c}}", "`go` of `a`"),
        ("a: {do: [{raise: go}, {say: Hi}], on: {go: a, touched: c}}", "`go` of `a`"),
        ("a: {do: {wait: 0s}, on: {done: a, touched: c}}", "`done.do.a` of `a`"),
        ("a: {exit: {raise: go}, entry: {raise: go}, on: {go: a, touched: c}}", "`go` of `a`"),
        ("a: {initial: x, states: {x: {type: final}}, onDone: a, on: {touched: c}}", "`done.state.a` of `a`"),
        ("a: {initial: x, states: {x: {do: {log: y}, onDone: y}, y: {type: final}}, onDone: a, on: {touched: c}}",
         "`done.state.a` of `a`, `done.do.a.x` of `a.x`"),
        ("a: {type: parallel, states: {p: {states: {x: {type: final}}}, q: {states: {x: {type: final}}}}, onDone: a}",
         "`done.state.a` of `a`"),
        ("a: {type: parallel, states: {p: {states: {x: {do: {log: y}, onDone: x}}}, q: {}}, on: {touched: c}}",
         "`done.do.a.p.x` of `a.p.x`"),
        ("a: {type: parallel, states: {p: {entry: {raise: go}}, q: {states: {x: {on: {go: '#b'}}}}}, on: {touched: c}},"
         " b: {id: b, always: a}", "`go` of `a.q.x`, `always` of `b`"),
        ("a: {on: {touched: {actions: {raise: again}}, again: {actions: {raise: again}}, face: c}}", "`again` of `a`"),
        ("a: {invoke: {behavior: quick, onDone: a}, on: {touched: c}}", "`done.invoke.quick` of `a`"),
        ("a: {invoke: {behavior: two, id: w, onDone: a}, on: {touched: c}}", "`done.invoke.w` of `a`"),
        ("a: {invoke: {behavior: quick}, on: {done.invoke.quick: b}}, b: {always: a}",
         "`done.invoke.quick` of `a`, `always` of `b`"),
        ("a: {do: {log: x}, onDone: [{guard: context.n < 4, target: a}, c]}", ""),
        ("a: {do: {log: x}, onDone: [{guard: context.n > 4, target: c}, a], entry: {assign: {n: context.n + 1}}}", ""),
        ("a: {do: {say: x}, onDone: b}, b: {do: {log: x}, onDone: a, on: {touched: c}}", ""),
        ("a: {entry: {raise: go}, on: {go: b}}, b: {on: {go: a, touched: c}}", ""),
        ("a: {entry: {send: {event: go, delay: 1s}}, on: {go: a, touched: c}}", ""),
        ("a: {after: {0s: {actions: {log: once}}}, on: {touched: c}}", ""),
        ("a: {invoke: {behavior: slow, onDone: a}, on: {touched: c}}", ""),
        ("a: {entry: {raise: go}, do: {log: x}, on: {go: b}}, b: {on: {done: a, touched: c}}", ""),
        ("a: {type: parallel, states: {p: {entry: {raise: go}}, q: {on: {go: .y}, initial: x, states: {x: {}, y: {}}}},"
         " on: {touched: c}}", ""),
        ("a: {entry: {raise: out}, initial: x, states: {x: {after: {0s: x}}}, on: {out: c}}", ""),  # left before that
        ("a: {do: {log: x}, onDone: c, on: {go: {actions: {raise: go}}}}", ""),  # left before a `go` comes
        ("a: {after: {0s: c}, initial: x, states: {x: {on: {touched: {}, y: {actions: {raise: y}}}}}}",
         ""),
        ("a: {initial: x, always: b, states: {x: {}}}, b: {initial: y, always: a, states: {y: {}}}",
         ""),  # `endless-always` reports it
    ],
)  # fmt: skip
def test_endless_chains_of_every_make(states: str, way: str) -> None:
    assert [f"never ends: {way} (" in line for line in endless(states)] == ([True] if way else [])


def test_an_always_of_states_with_states_within_is_endless_too() -> None:
    chart = "initial: a\nstates: {a: {always: b, states: {x: {}}}, b: {always: a, states: {y: {}}}}\n"
    assert [line.split()[1] for line in lint(chart) if "this loop never ends" in line] == ["endless-always:"]


def test_an_endless_chain_of_behaviours_within_behaviours_is_found() -> None:
    found = lint(
        "initial: a\nstates: {a: {invoke: {behavior: outer, onDone: a}, on: {touched: b}}, b: {after: {5s: a}}}\n",
        **INVOKED,
    )
    assert any("never ends: `done.invoke.outer` of `a`" in line for line in found)


@for_each(
    ("states", "way"),
    [
        ("a: {always: [{guard: context.n > 3, target: c}, b]}, b: {always: a}",
         "while `context.n > 3` is false: `always` of `a`, `always` of `b`"),
        ("a: {always: [{guard: context.n > 3, target: c}, {guard: context.n <= 3, target: b}]}, b: {always: a}",
         "while `context.n <= 3`: `a` → `b` → `a`"),
        ("a: {entry: {raise: go}, always: {guard: context.n > 3, target: c}, on: {go: a}}",
         "while `context.n > 3` is false: `go` of `a`"),
        ("a: {always: [{guard: context.n > 3, target: c}, {guard: context.n > 2, target: c}, {actions: {raise: go}}]}",
         "while `context.n > 3` and `context.n > 2` are false: `always` of `a`"),
        ("a: {always: [{guard: context.n > 3, target: c}, b]}, b: {exit: {assign: {n: context.n + 1}}, always: a}", ""),
        ("a: {entry: {raise: go}, always: {guard: context.n > 3, target: c}, on: {go: {target: a,"
         " actions: {assign: {n: context.n + 1}}}}}", ""),
        ("a: {always: [{guard: context.n > 3, target: c}, b]}, b: {after: {1s: a}}", ""),
    ],
)  # fmt: skip
def test_endless_chains_while_a_guard_stays_false(states: str, way: str) -> None:
    assert [f"never ends {way} (" in line for line in endless(states)] == ([True] if way else [])


def test_the_error_of_an_endless_chain_names_its_transitions() -> None:
    quick = {"initial": "a", "states": {"a": {"type": "final"}}}
    for name, way in (
        ("endless-invoke.yaml", "the loop is: `done.invoke.quick` of `work`"),
        ("endless-guarded.yaml", "the loop is: `always` of `two`"),
    ):
        document, _ = parse(name, of(name).encode())
        assert document is not None
        it = Interpreter(Machine.from_dict(document.data, behaviors={"quick": quick}))
        it.start()
        with pytest.raises(LumenError, match=re.escape(way)):
            it.send("touched")


def test_a_target_in_another_region_is_found() -> None:
    (found,) = lint(of("other-region.yaml"))
    message = "`demo` is in another region, so all of `hello` is left and restarted"
    assert found.startswith(f"6:103 crosses-regions: {message} (")
    assert "an event that the region of `demo` waits for" in found


@for_each(
    ("way", "found"),
    [
        ("l: {initial: a, states: {a: {on: {touched: b}}, b: {after: {5s: a}}}}", False),
        ('l: {initial: a, states: {a: {on: {touched: {target: ["#b", "#r2"]}}}, b: {id: b, after: {5s: a}}}}', False),
        ('l: {initial: a, states: {a: {on: {touched: "#r2"}}}}', True),
        ('l: {initial: a, on: {touched: "#r2"}, states: {a: {}}}', True),
    ],
)
def test_which_targets_leave_other_regions(way: str, found: bool) -> None:
    right = "r: {initial: r1, states: {r1: {after: {5s: r2}}, r2: {id: r2, after: {5s: r1}}}}"
    codes = [line.split()[1] for line in lint(f"type: parallel\nstates:\n  {way}\n  {right}\n")]
    assert ("crosses-regions:" in codes) == found, codes


def test_reenter_without_a_target_is_found() -> None:
    assert lint(of("reenter-nothing.yaml")) == [
        "7:21 no-effect: `reenter` has no effect without a `target`: the state is not left"
        " (write `target: .` to restart `speak`, or delete `reenter`)"
    ]


@for_each(
    ("state", "found"),
    [
        ("{always: b, do: {say: Hi}, after: {5s: b}}",
         "3:18 no-effect: `do`, `after` have no effect: `always` leaves `a` at once"
         " (give the `always` a `guard`, or delete it)"),
        ("{always: [{guard: context.n > 1, target: a}, b], on: {touched: b}}",
         "3:55 no-effect: `on` has no effect: `always` leaves `a` at once (give the `always` a `guard`, or delete it)"),
        ("{always: {guard: context.n > 1, target: b}, on: {touched: b}}", ""),
        ("{always: b, entry: {log: x}, exit: {log: x}}", ""),
        ("{always: b, initial: x, states: {x: {on: {touched: b}}}, on: {touched: b}}", ""),
    ],
)  # fmt: skip
def test_keys_beside_an_instant_always_are_found(state: str, found: str) -> None:
    lines = lint(f"context: {{n: 0}}\nstates:\n  a: {state}\n  b: {{after: {{5s: a}}}}\n")
    assert [line for line in lines if "no-effect" in line] == ([found] if found else [])


@for_each(
    ("within", "found"),
    [
        ('x: {on: {"*": y}}, y: {on: {"*": x}}', True),
        ('x: {on: {"*": y}}, y: {on: {touched: x}}', False),
        ("x: {on: {done: y}}, y: {initial: z, on: {done.invoke: x}, states: {z: {}}}", True),
        ('x: {on: {"*": {guard: "event.name != \'e\'", target: y}}}, y: {on: {"*": x}}', False),
        ("x: {on: {touched: y}}, y: {type: final}", False),
    ],
)
def test_the_end_of_an_invocation_that_inner_states_handle(within: str, found: bool) -> None:
    chart = (
        f"initial: a\nstates:\n  a: {{invoke: {{behavior: quick, onDone: b}}, initial: x, states: {{{within}}}}}\n"
        "  b: {after: {5s: a}}\n"
    )
    lines = [line for line in lint(chart, quick=of("quick.yaml")) if "shadowed-transition" in line]
    assert [line.partition(" ")[0] for line in lines] == (["3:41"] if found else [])


def test_no_unlike_event_is_proposed() -> None:
    found = lint(of("event-hint.yaml"))
    assert len(found) == 6
    hint = "(declare it under `events:`, or write it as the `event` of a route in lumen.yaml)"
    assert all(line.endswith(hint) for line in found)


@for_each(
    ("word", "names", "meant"),
    [
        ("deactivate", ["done.state"], ""), ("delete", ["left"], ""), ("greating", ["greeting"], "greeting"),
        ("waveing", ["wave"], "wave"), ("tuoched", ["touched"], "touched"), ("visitor_left", ["left"], "left"),
    ],
)  # fmt: skip
def test_a_hint_is_a_name_with_few_letters_changed(word: str, names: list[str], meant: str) -> None:
    assert nearest(word, names) == meant
