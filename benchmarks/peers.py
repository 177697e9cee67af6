"""The same two machines in other statechart libraries, in the style of their documentation.

Each `work(count)` restarts the machine, sends that many events and returns the context value that every event
increments.
"""

import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.guarded import run_guarded

Work = Callable[[int], int]
MOST = 1_000_000_000


class Model:
    """The model of `transitions`, with a guard and an assignment as methods."""

    n = 0

    def below(self) -> bool:
        """Return True while the count is below its limit."""
        return self.n < MOST

    def plus(self) -> None:
        """Increment the count."""
        self.n += 1


def transitions_ring(size: int) -> Work:
    """Return a ring in `transitions`."""
    from transitions import Machine

    names = [f"s{i}" for i in range(size)]
    rows = [["go", name, names[(i + 1) % size], "below", None, "plus"] for i, name in enumerate(names)]
    return _transitions(Machine, names, rows, "s0")


def transitions_regions() -> Work:
    """Return two regions in `transitions`."""
    from transitions.extensions import HierarchicalMachine

    regions = [{"name": side, "children": ["a", "b"], "initial": "a"} for side in ("left", "right")]
    states = [{"name": "both", "parallel": regions}]
    turns = (("a", "b"), ("b", "a"))
    rows = [["go", f"both_left_{one}", f"both_left_{other}", "below", None, "plus"] for one, other in turns]
    rows += [["go", f"both_right_{one}", f"both_right_{other}"] for one, other in turns]
    return _transitions(HierarchicalMachine, states, rows, "both")


def _transitions(kind: Any, states: Any, rows: Any, start: str) -> Work:
    model = Model()
    machine = kind(model, states=states, transitions=rows, initial=start, auto_transitions=False)

    def work(count: int) -> int:
        model.n = 0
        machine.set_state(start if kind.__name__ == "Machine" else ["both_left_a", "both_right_a"])
        for _ in range(count):
            model.go()  # type: ignore[attr-defined]
        return model.n

    return work


def statemachine_ring(size: int) -> Work:
    """Return a ring in `python-statemachine`."""
    states: dict[str, Any] = {f"s{i}": {"on": {"go": [_turn(f"s{(i + 1) % size}")]}} for i in range(size)}
    return _statemachine(states, "s0")


def statemachine_regions() -> Work:
    """Return two regions in `python-statemachine`."""
    left = {"la": {"initial": True, "on": {"go": [_turn("lb")]}}, "lb": {"on": {"go": [_turn("la")]}}}
    right = {"ra": {"initial": True, "on": {"go": [{"target": "rb"}]}}, "rb": {"on": {"go": [{"target": "ra"}]}}}
    states: dict[str, Any] = {
        "both": {"parallel": True, "states": {"left": {"states": left}, "right": {"states": right}}}
    }
    return _statemachine(states, "both")


def _turn(target: str) -> dict[str, str]:
    return {"target": target, "cond": "below", "on": "plus"}


def _statemachine(states: dict[str, Any], start: str) -> Work:
    from statemachine.io import create_machine_class_from_definition

    states[start]["initial"] = True
    made: Any = create_machine_class_from_definition("Made", states=states)

    def work(count: int) -> int:
        model = Model()
        machine = made(model=model)
        for _ in range(count):
            machine.send("go")
        return model.n

    return work


def sismic_ring(size: int) -> Work:
    """Return a ring in `sismic`."""
    states = [{"name": f"s{i}", "transitions": [_guarded(f"s{(i + 1) % size}")]} for i in range(size)]
    return _sismic({"name": "root", "initial": "s0", "states": states})


def sismic_regions() -> Work:
    """Return two regions in `sismic`."""
    left = [{"name": "la", "transitions": [_guarded("lb")]}, {"name": "lb", "transitions": [_guarded("la")]}]
    right = [
        {"name": one, "transitions": [{"event": "go", "target": other}]} for one, other in (("ra", "rb"), ("rb", "ra"))
    ]
    regions = [{"name": "left", "initial": "la", "states": left}, {"name": "right", "initial": "ra", "states": right}]
    return _sismic({"name": "root", "initial": "both", "states": [{"name": "both", "parallel states": regions}]})


def _guarded(target: str) -> dict[str, str]:
    return {"event": "go", "target": target, "guard": f"n < {MOST}", "action": "n = n + 1"}


def _sismic(root: dict[str, Any]) -> Work:
    from sismic.interpreter import Interpreter
    from sismic.io.datadict import import_from_dict

    chart = import_from_dict({"statechart": {"name": "made", "preamble": "n = 0", "root state": root}})

    def work(count: int) -> int:
        interpreter = Interpreter(chart)
        interpreter.execute()
        for _ in range(count):
            interpreter.queue("go").execute_once()
        return int(interpreter.context["n"])

    return work


def port_ring(size: int) -> Work:
    """Return a ring in `xstate-statemachine`."""
    states = {f"s{i}": {"on": {"GO": _named(f"s{(i + 1) % size}")}} for i in range(size)}
    return _port({"initial": "s0", "states": states})


def port_regions() -> Work:
    """Return two regions in `xstate-statemachine`."""
    left = {"a": {"on": {"GO": _named("b")}}, "b": {"on": {"GO": _named("a")}}}
    right = {"a": {"on": {"GO": "b"}}, "b": {"on": {"GO": "a"}}}
    regions = {"left": {"initial": "a", "states": left}, "right": {"initial": "a", "states": right}}
    return _port({"initial": "both", "states": {"both": {"type": "parallel", "states": regions}}})


def _named(target: str) -> dict[str, Any]:
    return {"target": target, "guard": "below", "actions": ["plus"]}


def _port(config: dict[str, Any]) -> Work:
    from xstate_statemachine import MachineLogic, SyncInterpreter, create_machine

    def plus(_: Any, context: dict[str, int], *__: Any) -> None:
        context["n"] += 1

    logic: Any = MachineLogic(guards={"below": lambda context, _: context["n"] < MOST}, actions={"plus": plus})
    machine = create_machine({"id": "made", "context": {"n": 0}, **config}, logic=logic)

    def work(count: int) -> int:
        service = SyncInterpreter(machine).start()
        for _ in range(count):
            service.send("GO")
        return int(service.context["n"])

    return work


PEERS: list[tuple[str, str, Callable[[int], Work], Callable[[], Work]]] = [
    ("transitions", "transitions", transitions_ring, transitions_regions),
    ("python-statemachine", "python-statemachine", statemachine_ring, statemachine_regions),
    ("sismic", "sismic", sismic_ring, sismic_regions),
    ("xstate-statemachine", "xstate-statemachine", port_ring, port_regions),
]
"""Name, package, and the functions that make the two machines."""


def xstate(sizes: Sequence[int]) -> list[tuple[str, dict[str, float] | str]]:
    """Return XState's rates on Node: of its pure transition function, of its internals, and of an actor."""
    ways = {"pure": "XState, pure", "scoped": "XState, one scope", "actor": "XState, actor"}
    if not (shutil.which("node") and shutil.which("npm")):
        return [(name, "not measured: there is no Node here") for name in ways.values()]
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder) / "xstate.mjs"
        script.write_text(Path(__file__).with_name("xstate.mjs").read_text())
        try:
            for command in (["npm", "init", "-y"], ["npm", "install", "--no-audit", "--no-fund", "xstate@5"]):
                run_guarded(command, cwd=folder, check=True, capture_output=True, timeout=120)
            arguments = ["node", script.name, *map(str, sizes)]
            said = run_guarded(arguments, cwd=folder, check=True, capture_output=True, timeout=600, text=True).stdout
        except (subprocess.SubprocessError, OSError) as error:
            reason = f"not measured: {type(error).__name__} of {error.cmd[0] if hasattr(error, 'cmd') else 'npm'}"
            return [(name, reason) for name in ways.values()]
    found = json.loads(said)
    return [(f"{name} {found['version']}, Node {found['node']}", found[way]) for way, name in ways.items()]
