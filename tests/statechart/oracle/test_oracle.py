"""The interpreter against the second reading of Appendix D: every step of every machine is the same."""

from collections import Counter
from typing import Any

import pytest
from hypothesis import HealthCheck, given, seed, settings

from lumen.errors import LumenError
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.statechart import Snapshot, Step, due, initial, step
from tests.statechart.oracle.algorithm import Oracle
from tests.statechart.oracle.content import RestlessError
from tests.statechart.oracle.generating import Event as Happening
from tests.statechart.oracle.generating import happenings, machines

BUSY = settings(deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


def compare(machine: MachineDefinition, events: list[Happening | None], tally: Counter[str]) -> None:
    """Run both side by side; raise AssertionError at the first step in which they differ."""
    tally["machines"] += 1
    oracle, snapshot = None, None
    for happening in [None, *events]:
        event = happened(snapshot, happening)
        ours = by_lumen(machine, snapshot, event)
        oracle = by_the_book(machine, oracle, event if happening or not due_in(oracle) else None)
        if ours is None or oracle is None:
            assert (ours, oracle) == (None, None), "only one of them comes to rest"
            tally["machines without rest"] += 1
            return
        assert of_lumen(ours) == of_the_book(oracle)
        snapshot = ours.snapshot
        tally["macrosteps"] += 1
        tally["transitions"] += len(ours.transitions)
        tally["commands"] += len(ours.commands)
        if not oracle.running:
            tally["machines that ended"] += 1


def happened(snapshot: Snapshot | None, happening: Happening | None) -> Event:
    """Return the event of a happening: for None the next timer, or else an event from outside."""
    at = snapshot.at if snapshot else 0.0
    if happening is None:
        return (snapshot and due(snapshot)) or Event("b.c", None, at)
    return Event(*happening, at + 0.05)


def by_lumen(machine: MachineDefinition, snapshot: Snapshot | None, event: Event) -> Step | None:
    """Return the step after repeating it, so that specialized functions, if any, compute it; None if it never rests."""
    try:
        return initial(machine) if snapshot is None else [step(machine, snapshot, event) for _ in range(3)][-1]
    except LumenError as error:
        if "never comes to rest" not in str(error):
            raise
        return None


def due_in(oracle: Oracle | None) -> bool:
    return oracle is not None and bool(oracle.world.timers)


def by_the_book(machine: MachineDefinition, oracle: Oracle | None, event: Event | None) -> Oracle | None:
    """Return the oracle after the event, or after its own next timer."""
    try:
        if oracle is None:
            return Oracle(machine)
        if event is None:
            oracle.tick()
        else:
            oracle.happen(event)
        return oracle
    except RestlessError:
        return None


def of_lumen(taken: Step) -> dict[str, Any]:
    snapshot = taken.snapshot
    return {
        "exited": list(taken.exited),
        "entered": list(taken.entered),
        "transitions": [id(t) for t in taken.transitions],
        "commands": list(taken.commands),
        "raised": [shown(event) for event in taken.raised],
        "configuration": snapshot.configuration,
        "context": snapshot.context,
        "at": snapshot.at,
        "history": {path: set(kept) for path, kept in snapshot.history.items()},
        "timers": [(t.event, t.due, t.data, t.state) for t in snapshot.timers],
        "output": snapshot.output,
    }


def of_the_book(oracle: Oracle) -> dict[str, Any]:
    world = oracle.world
    assert len(world.configuration) == len({s.path for s in world.configuration}), "a state is active twice"
    return {
        "exited": oracle.exited,
        "entered": oracle.entered,
        "transitions": [id(t) for t in oracle.taken],
        "commands": world.commands,
        "raised": [shown(event) for event in world.raised],
        "configuration": {s.name for s in world.configuration if s.path},
        "context": world.context,
        "at": world.at,
        "history": {path: {s.path for s in kept} for path, kept in world.history.items()},
        "timers": [(t.event, t.due, t.data, t.state or "") for t in world.timers],
        "output": oracle.output,
    }


def shown(event: Event) -> tuple[Any, ...]:
    """Return an event without the reason of a fault, whose words are the interpreter's own."""
    data = {"where": event.data["where"]} if event.name == "error.execution" else event.data
    return event.name, data, event.at


@pytest.mark.slow
@seed(2015)
@settings(BUSY, max_examples=150)
@given(machines(), happenings)
def test_a_hundred_and_fifty_machines(machine: MachineDefinition, events: list[Happening | None]) -> None:
    compare(machine, events, Counter())


@pytest.mark.soak
def test_twenty_thousand_machines() -> None:
    tally = Counter[str]()
    for thousand in range(20):

        @seed(thousand)
        @settings(BUSY, max_examples=1_000)
        @given(machines(), happenings)
        def everyone(machine: MachineDefinition, events: list[Happening | None]) -> None:
            compare(machine, events, tally)

        everyone()
    print("\nthe same:", ", ".join(f"{count:,} {what}" for what, count in tally.items()))  # noqa: T201
    assert tally["machines"] >= 20_000
