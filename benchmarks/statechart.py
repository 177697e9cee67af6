"""Measure the events per second of statecharts: Lumen's, XState's, other Python libraries' and a dict's; CPU time.

    pip install transitions python-statemachine sismic xstate-statemachine
    python benchmarks/statechart.py

Lumen needs none of the other libraries; a missing one is reported as not measured. XState runs on Node; npm installs
its package in a temporary folder. Machine (a) is a ring of 15, 150 or 1,500 states, in which each event enters the next
one. Machine (b), "regions", has three levels, and each event moves both regions of its parallel state. Each event
checks a guard and assigns one context value. In Lumen the guard is an expression of the YAML, and every event gives a
Step while the snapshot before it is unchanged, as with XState's pure transition function. "A visit" is the shipped tour
of 15 states with its `do`, timers, texts and guards, with the events of visit.py.

`grows` is the additional time of one event at 1,500 states compared with 15 [ns]. The control reads one entry of a
table and keeps its content: its growth is the cost of memory that exceeds the processor's first cache.
"""

import platform
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

from fuzzy import processor
from peers import PEERS, Work, xstate
from timing import rate
from visit import tour

from lumen.statechart import Event, Interpreter, Machine, initial, step

SIZES = (15, 150, 1500)
GUARD, COUNT = "context.n < 1000000000", {"assign": {"n": "context.n + 1"}}
Rates = dict[str, float]


def sending(machine: Machine) -> Work:
    """Return Lumen as users have it: an interpreter with its clock, comparable with XState's actor."""
    interpreter = Interpreter(machine)
    interpreter.start()

    def work(count: int) -> int:
        before = interpreter.context["n"]
        for _ in range(count):
            interpreter.send("go")
        return int(interpreter.context["n"] - before)

    return work


def stepping(machine: Machine) -> Work:
    """Return Lumen's pure `step`."""
    go = Event("go")

    def work(count: int) -> int:
        snapshot = initial(machine).snapshot
        for _ in range(count):
            taken = step(machine, snapshot, go)
            snapshot = taken.snapshot
        return int(snapshot.context["n"])

    return work


def ring(size: int) -> Machine:
    """Return machine (a), a ring of that many states."""
    states = {f"s{i}": {"on": {"go": _row(f"s{(i + 1) % size}")}} for i in range(size)}
    return Machine.from_dict({"context": {"n": 0}, "states": states})


def regions() -> Machine:
    """Return machine (b), with two regions."""
    left = {"a": {"on": {"go": _row("b")}}, "b": {"on": {"go": _row("a")}}}
    right = {"a": {"on": {"go": "b"}}, "b": {"on": {"go": "a"}}}
    both = {"type": "parallel", "states": {"left": {"states": left}, "right": {"states": right}}}
    return Machine.from_dict({"context": {"n": 0}, "states": {"both": both}})


def _row(target: str) -> dict[str, Any]:
    return {"target": target, "guard": GUARD, "actions": COUNT}


def dict_ring(size: int) -> Work:
    """Return the upper limit: a table from state and event to a guard, an assignment and the next state."""
    table = {(f"s{i}", "go"): (_below, _plus, f"s{(i + 1) % size}") for i in range(size)}

    def work(count: int) -> int:
        state, context = "s0", {"n": 0}
        for _ in range(count):
            guard, assign, target = table[state, "go"]
            if guard(context):
                state, context = target, assign(context)
        return context["n"]

    return work


def touched_ring(size: int) -> Work:
    """Return the control: as many objects for each state as in Lumen, visited in the same order without any work."""
    names = [frozenset((f"s{i}",)) for i in range(size)]
    sides = [(f"s{i}",) for i in range(size)]
    shared = (("n", _plus, None),)
    table: dict[frozenset[str], Any] = {}
    for i, name in enumerate(names):
        after = (i + 1) % size
        table[name] = (False, _below, True, shared, names[after], sides[i], sides[after], ([i],), None, _plus)

    def work(count: int) -> int:
        at, done = names[0], 0
        for _ in range(count):
            _, _, _, _, at, left, entered, taken, _, _ = table[at]
            kept = (left, entered, taken, at)
            done += len(kept) // 4
        return done

    return work


def _below(context: dict[str, int]) -> bool:
    return context["n"] < 1_000_000_000


def _plus(context: dict[str, int]) -> dict[str, int]:
    return {**context, "n": context["n"] + 1}


def measured(ring: Callable[[int], Work], regions: Callable[[], Work] | None) -> Rates:
    """Return the rates of both machines in one library; without `regions`, only those of rings."""
    rates = {f"{size:,} states": rate(ring(size)) for size in SIZES}
    if regions:
        rates["regions"] = rate(regions())
    return rates


def ours(way: Callable[[Machine], Work]) -> Rates:
    """Return the rates of Lumen."""
    return measured(lambda size: way(ring(size)), lambda: way(regions()))


def main() -> None:
    """Print the table, with the reason for a library that can't be measured."""
    rows: list[tuple[str, Rates | str]] = [("Lumen, Interpreter.send", ours(sending)), ("Lumen, step", ours(stepping))]
    rows += xstate(SIZES)
    for name, package, their_ring, their_regions in PEERS:
        try:
            rows.append((f"{name} {version(package)}", measured(their_ring, their_regions)))
        except ImportError:
            rows.append((name, f"not measured: pip install {package}"))
    rows.append(("plain dict (no regions)", measured(dict_ring, None)))
    rows.append(("control: touch a state's objects", measured(touched_ring, None)))
    print(f"Python {platform.python_version()}, {platform.machine()}, {processor()}; thousands of events per second")
    show(rows)
    print(f"\nLumen, a visit to the shipped tour{rate(tour()) / 1e3:14,.1f}")


def show(rows: list[tuple[str, Rates | str]]) -> None:
    """Print the rates, then each of them relative to XState's."""
    columns = [*(f"{size:,} states" for size in SIZES), "regions"]
    print(f"{'':36}" + "".join(f"{column:>13}" for column in columns) + f"{'grows [ns]':>12}")
    for name, rates in rows:
        if isinstance(rates, str):
            print(f"{name:36} {rates}")
        else:
            cells = "".join(f"{rates[column] / 1e3:13,.1f}" if column in rates else f"{'-':>13}" for column in columns)
            print(f"{name:36}{cells}{1e9 / rates[columns[2]] - 1e9 / rates[columns[0]]:12,.0f}")
    for base, theirs in rows:
        if base.startswith("XState") and not isinstance(theirs, str):
            print(f"\ntimes {base}")
            for name, rates in rows:
                if name != base and not isinstance(rates, str):
                    ratios = (f"{rates[column] / theirs[column]:13.2f}" for column in columns if column in rates)
                    print(f"{name:36}" + "".join(ratios))


if __name__ == "__main__":
    main()
