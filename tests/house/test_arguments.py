"""The public modules raise a UsageError that explains wrong arguments."""

import sys
from collections.abc import Callable
from math import inf, nan
from pathlib import Path
from typing import Any

import pytest

from lumen import bus, fuzzy, motion
from lumen.errors import SnapshotError, UsageError
from lumen.statechart import Event, Interpreter, Machine, VirtualClock, initial, step
from tests import ROOT
from tests.tables import for_each

KEPT = ROOT / ".cache/mypy"
"""mypy's cache of the engine for later runs; `make check`, which may run at the same time, has its own."""
MACHINE = Machine.from_dict({"context": {"list": [1]}, "states": {"a": {"on": {"go": "b"}}, "b": None}})
CONTROLLER = fuzzy.Controller.load(ROOT / "fuzzy/head.yaml")
X, *_ = CONTROLLER.inputs
GOOD = dict.fromkeys(CONTROLLER.inputs, 1.0)
MOTION = motion.Motion.load(ROOT / "motions/dance.yaml")


def running() -> Interpreter:
    it = Interpreter(MACHINE)
    it.start()
    return it


def subscribed(*given: Any) -> Any:
    return bus.connect("memory://").subscribe(*given)


WRONG: dict[str, Callable[[], Any]] = {
    "machine from no path": lambda: Machine.load(5),  # type: ignore[arg-type]
    "machine from a path with a zero": lambda: Machine.load("a\0b"),
    "machine from no map": lambda: Machine.from_dict([1]),  # type: ignore[arg-type]
    "machine without a name": lambda: Machine.from_dict({"states": {"a": None}}, name=""),
    "behaviors that are a list": lambda: Machine.from_dict({"states": {"a": None}}, behaviors=[1]),  # type: ignore[arg-type]
    "words that are a list": lambda: Machine.from_dict({"states": {"a": None}}, words=[1]),  # type: ignore[arg-type]
    "interpreter of a dict": lambda: Interpreter({}),  # type: ignore[arg-type, call-overload]
    "interpreter on a number": lambda: Interpreter(MACHINE, 5),  # type: ignore[type-var]
    "observer that is a text": lambda: Interpreter(MACHINE, observe="x"),  # type: ignore[arg-type, call-overload]
    "language that is a number": lambda: Interpreter(MACHINE, language=5).start(),  # type: ignore[arg-type, call-overload]
    "epoch that is none": lambda: Interpreter(MACHINE, epoch=nan).start(),
    "seed that is a text": lambda: Interpreter(MACHINE, seed="x").start(),  # type: ignore[arg-type, call-overload]
    "input that is a list": lambda: Interpreter(MACHINE, input=[1]).start(),  # type: ignore[arg-type, call-overload]
    "event that is a number": lambda: running().send(5),  # type: ignore[arg-type]
    "event without a name": lambda: running().send(""),
    "Event without a name": lambda: running().send(Event("")),
    "event whose name is a number": lambda: running().send(Event(5)),  # type: ignore[arg-type]
    "data that JSON can't hold": lambda: running().send("go", {1, 2}),
    "snapshot that is a list": lambda: Interpreter.restore(MACHINE, [1]),  # type: ignore[arg-type, call-overload]
    "restore of no machine": lambda: Interpreter.restore("x", running().snapshot()),  # type: ignore[arg-type, call-overload]
    "beginning of no machine": lambda: initial("x"),  # type: ignore[arg-type]
    "beginning at no time": lambda: initial(MACHINE, at=nan),
    "step of no machine": lambda: step("x", initial(MACHINE).snapshot, Event("go")),  # type: ignore[arg-type]
    "step from a step": lambda: step(MACHINE, initial(MACHINE), Event("go")),  # type: ignore[arg-type]
    "step with a text": lambda: step(MACHINE, initial(MACHINE).snapshot, "go"),  # type: ignore[arg-type]
    "clock at no time": lambda: VirtualClock(nan),
    "clock that advances by a text": lambda: VirtualClock().advance("1"),  # type: ignore[arg-type]
    "clock that waits for None": lambda: VirtualClock().wait(None),  # type: ignore[arg-type]
    "controller from no path": lambda: fuzzy.Controller.load(5),  # type: ignore[arg-type]
    "controller from a list": lambda: fuzzy.Controller.from_dict([1]),  # type: ignore[arg-type]
    "controller without a name": lambda: fuzzy.Controller.from_dict({}, name=5),  # type: ignore[arg-type]
    "input that is a text": lambda: CONTROLLER.evaluate({**GOOD, X: "80"}),  # type: ignore[dict-item]
    "input that is None": lambda: CONTROLLER.evaluate({**GOOD, X: None}),  # type: ignore[dict-item]
    "inputs that are a list": lambda: CONTROLLER.evaluate([1, 2]),  # type: ignore[arg-type]
    "inputs that are None": lambda: CONTROLLER.evaluate(None),  # type: ignore[arg-type]
    "input that is too large": lambda: CONTROLLER.evaluate({**GOOD, X: 10**400}),
    "previous that is a list": lambda: CONTROLLER.evaluate(GOOD, [1]),  # type: ignore[arg-type]
    "previous that is a text": lambda: CONTROLLER.evaluate(GOOD, {"y": "1"}),  # type: ignore[dict-item]
    "a batch of texts": lambda: CONTROLLER.evaluate_batch({**{key: [1.0] for key in GOOD}, X: ["80"]}),
    "a batch of None": lambda: CONTROLLER.evaluate_batch(None),  # type: ignore[arg-type]
    "explain a text": lambda: CONTROLLER.explain({**GOOD, X: "80"}),  # type: ignore[dict-item]
    "motion from no path": lambda: motion.Motion.load(5),  # type: ignore[arg-type]
    "motion from a list": lambda: motion.Motion.from_dict([1]),  # type: ignore[arg-type]
    "sample at NaN": lambda: MOTION.sample(nan),
    "sample at a text": lambda: MOTION.sample("1"),  # type: ignore[arg-type]
    "start that is a list": lambda: MOTION.sample(0.0, [1]),  # type: ignore[arg-type]
    "start at a text": lambda: MOTION.sample(0.0, {"HeadYaw": "0"}),  # type: ignore[dict-item]
    "bus at a number": lambda: bus.connect(5),  # type: ignore[arg-type]
    "bus of a project by name": lambda: bus.connect("memory://", "tour"),  # type: ignore[arg-type]
    "key that is a number": lambda: bus.connect("memory://").publish(5, {}),  # type: ignore[arg-type]
    "pattern that is a number": lambda: subscribed(5, print),
    "subscriber that can't be called": lambda: subscribed("a.b", 5),
}


@for_each("name", WRONG)
def test_what_it_does_not_take_is_told(name: str) -> None:
    with pytest.raises((UsageError, SnapshotError, bus.BusError)) as caught:
        WRONG[name]()
    assert str(caught.value)


def test_numbers_of_every_kind_are_taken() -> None:
    import numpy as np

    assert CONTROLLER.evaluate(dict.fromkeys(GOOD, np.float32(1.0))) == CONTROLLER.evaluate(GOOD)
    assert MOTION.sample(np.float64(0.5)) == MOTION.sample(0.5)
    assert MOTION.sample(inf) == MOTION.sample(MOTION.duration + 1)


def test_what_is_handed_out_does_not_lead_back_in() -> None:
    it = running()
    it.context["list"].append(9)
    it.send("go").snapshot.context["list"].append(8)
    assert MACHINE.context["list"] == [1]
    assert running().context == {"list": [1]}
    assert it.context["list"] == [1, 8]  # a step holds what it holds


TYPED = '''
from typing import assert_type

from lumen.statechart import Interpreter, Machine, VirtualClock


class Mine:
    def now(self) -> float:
        return 0.0

    def wait(self, until: float) -> None:
        """Nothing waits here."""


machine = Machine.from_dict({"states": {"a": None}})
it = Interpreter(machine)
it.clock.advance(1.0)
assert_type(it, Interpreter[VirtualClock])
assert_type(Interpreter(machine, Mine()).clock, Mine)
Interpreter.restore(machine, it.snapshot()).clock.advance(1.0)
assert_type(Interpreter.restore(machine, it.snapshot(), Mine()).clock, Mine)


def kept() -> Interpreter:
    return it


kept().clock.advance(1.0)
'''


@pytest.mark.process
@pytest.mark.slow
def test_the_clock_of_an_interpreter_has_its_own_type(tmp_path: Path) -> None:
    from mypy import api

    (tmp_path / "typed.py").write_text(TYPED)
    limit = sys.getrecursionlimit()
    try:
        said, errors, code = api.run(["--strict", f"--cache-dir={KEPT}", str(tmp_path / "typed.py")])
    finally:
        sys.setrecursionlimit(limit)  # mypy raises it for the whole process
    assert (code, errors) == (0, ""), said
