"""What runs a behaviour: `initial`, `step`, and for its timers `due` and `elapse`."""

from collections.abc import Callable, Iterator, Mapping
from copy import deepcopy
from math import inf
from operator import itemgetter
from typing import Any

from lumen.errors import LumenError, SnapshotError
from lumen.expressions.wall_clock import zone
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.language.nanoseconds import HALF, in_seconds
from lumen.statechart.command_ids import outer_id
from lumen.statechart.compiled_machine import CompiledMachine, compiled
from lumen.statechart.external_events import process
from lumen.statechart.invocations import open_context
from lumen.statechart.macrostep import enter_machine
from lumen.statechart.microstep import MAX_MICROSTEPS
from lumen.statechart.type_checks import checked
from lumen.statechart.values import Snapshot, Step, Timer
from lumen.upkeep.arguments import need, need_map, need_number, need_text

MAX_RATE = 10_000
"""How many timers may end [1/s]: where each sets others, a tick would have no end."""

_DUE = itemgetter(Timer._fields.index("due_ns"))
_new = tuple.__new__  # a third of the price of Event(…)


def initial(
    machine: MachineDefinition,
    at: float = 0.0,
    input: Mapping[str, Any] | None = None,
    language: str = "",
    *,
    epoch: float = 0.0,
    timezone: str = "",
    seed: int = 0,
) -> Step:
    """The first step: the initial states entered at `at` [s].

    `input` gives context keys other first values; raises UsageError where there is no such key, or it holds another
    type. `epoch` is when time 0 was [s since 1970, in UTC] and `timezone` where the clock on the wall hangs, an
    IANA name (else UsageError); `seed` begins the drawing of alternatives.
    """
    need(machine, MachineDefinition, "the machine to start", "a Machine")
    if input is not None:
        need_map(input, f"the input of `{machine.id}`")
    need_number(at, "`at`")
    need_text(language, "`language`", empty=True)
    need_number(epoch, "`epoch`")
    need(seed, int, "`seed`", "a whole number")
    program = compiled(machine)
    need_text(timezone, "`timezone`", empty=True)
    zone(timezone)
    data = {**deepcopy(dict(machine.context)), **checked(machine.id, program.chart.checks, input or {})}
    before = Snapshot(frozenset(), data, at, language, generator=seed % 2**32, epoch=epoch, timezone=timezone)
    return enter_machine(open_context(program, before, None, at))


def step(machine: MachineDefinition, snapshot: Snapshot, event: Event) -> Step:
    """One macrostep: `event` and all that follows from it until the next event from outside.

    The robot's answers and the events of `due` are known by their names and ids; those that nobody waits for any
    more change nothing. Time never goes back: an event from the past happens at `snapshot.at`. Raises LumenError
    where the machine never comes to rest, SnapshotError where the snapshot has states that the machine has not.
    """
    try:
        program: CompiledMachine = machine.__dict__.get("_compiled") or compiled(machine)
        taken = program.fast_paths.step(snapshot, event)
    except (KeyError, AttributeError, TypeError, ValueError):
        taken = None  # `in_full` fails on the same, and says why
    return taken or in_full(machine, snapshot, event)


def in_full(machine: MachineDefinition, snapshot: Snapshot, event: Event) -> Step:
    """The same by the whole algorithm, for whoever has tried the fast path already."""
    try:
        context = open_context(compiled(machine), snapshot, event, max(snapshot.at, event.at))
    except KeyError as error:
        raise SnapshotError(f"`{machine.id}` has no state `{error.args[0]}`, which is active in the snapshot") from None
    except (AttributeError, TypeError, ValueError):
        need(machine, MachineDefinition, "the machine of a step", "a Machine")
        need(snapshot, Snapshot, "the snapshot of a step", "a Snapshot")
        need(event, Event, "what happens", "an Event")
        need_text(event.name, "the name of an event")
        need_number(event.at, "the time of an event", finite=False)
        raise
    return process(context, event)


def finished(machine: MachineDefinition, snapshot: Snapshot) -> bool:
    """Whether the machine has come to its end (SCXML 3.7.1): no step changes anything any more but the time."""
    return compiled(machine).planner.configuration(snapshot.configuration).finished


def due(snapshot: Snapshot) -> Event | None:
    """The timer that ends next, as the event to step with, at its time; None where there is none.

    Those of invoked behaviours count; of two with the same time, the outer one comes first.
    """
    found = None
    if snapshot.timers:
        timer = min(snapshot.timers, key=_DUE) if len(snapshot.timers) > 1 else snapshot.timers[0]
        found = _new(Event, (timer.event, timer.data, in_seconds(timer.due_ns), timer.id, None))
    for owner, child in snapshot.invoked.items():
        event = due(child.snapshot)
        if event and (found is None or event.at < found.at):
            found = event._replace(sendid=outer_id(event.sendid, owner))
    return found


def waiting(snapshot: Snapshot) -> int:
    """How many timers are set, those of invoked behaviours included."""
    return len(snapshot.timers) + sum(waiting(child.snapshot) for child in snapshot.invoked.values())


def elapse(machine: MachineDefinition, current: Callable[[], Snapshot], until: float) -> Iterator[Step]:
    """The steps of every timer that ends until `until` [s], those set on the way included, in order.

    `current` gives the snapshot to step from: whoever takes a step may have more happen before the next. Raises
    LumenError where there is no end of timers of one time, as of a `send` without delay that answers itself, or where
    they are more than MAX_RATE; those that were set before do not count.
    """
    left, last, soon, steps = MAX_MICROSTEPS, -inf, until + HALF, 0
    while (event := due(current())) and event.at < soon:
        if not steps:
            most = 2 * MAX_MICROSTEPS + waiting(current()) + int(MAX_RATE * (until - event.at))
        left = left - 1 if event.at == last else MAX_MICROSTEPS + waiting(current())
        last, steps = event.at, steps + 1
        if left < 0:
            raise LumenError(f"`{machine.id}` never comes to rest: `{event.name}` is sent repeatedly without delay")
        if steps > most:
            many = f"its timers start more than {MAX_RATE:,} new timers per second, among them `{event.name}`"
            raise LumenError(f"`{machine.id}` never comes to rest: {many}")
        yield step(machine, current(), event)
