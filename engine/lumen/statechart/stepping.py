"""The functions that run a behaviour: `initial`, `step`, and `due` and `elapse` for its timers."""

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
"""The greatest rate of timers that end [1/s]: timers that set further timers could make a tick endless."""

_DUE = itemgetter(Timer._fields.index("due_ns"))
_new = tuple.__new__  # saves two thirds of the cost of Event(…)


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
    """Return the first step: the initial states are entered at `at` [s].

    `input` replaces initial values of context keys; raises UsageError if a key does not exist or a value has another
    type. `epoch` is the time of `at` = 0 [s since 1970, UTC]. `timezone` is the IANA name for the wall clock; raises
    UsageError if it is unknown. `seed` initializes the random choice of alternatives.
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
    """Return the macrostep for `event`: everything that follows from it until the next event from outside.

    The robot's answers and the events of `due` are recognized by their names and ids; if nothing waits for them any
    more, they change nothing, except that the failure of a command outside a `do` raises error.communication. Time
    never runs backwards: an event from the past happens at `snapshot.at`. Raises LumenError if the machine never comes
    to rest, or SnapshotError if the snapshot has states that the machine lacks.
    """
    try:
        program: CompiledMachine = machine.__dict__.get("_compiled") or compiled(machine)
        taken = program.fast_paths.step(snapshot, event)
    except (KeyError, AttributeError, TypeError, ValueError):
        taken = None  # `in_full` fails for the same reason, with a better message
    return taken or in_full(machine, snapshot, event)


def in_full(machine: MachineDefinition, snapshot: Snapshot, event: Event) -> Step:
    """Return the same as `step` by the full algorithm, for callers that have tried the fast path already.

    Raises SnapshotError if the machine lacks a state of the snapshot.
    """
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
    """Return True if the machine has ended (SCXML 3.7.1): steps change nothing but the time."""
    return compiled(machine).planner.configuration(snapshot.configuration).finished


def due(snapshot: Snapshot) -> Event | None:
    """Return the event of the timer that ends next, at its time; None if there are no timers.

    Timers of invoked behaviours count; of two timers with the same time, the outer one comes first.
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
    """Return the number of timers, including those of invoked behaviours."""
    return len(snapshot.timers) + sum(waiting(child.snapshot) for child in snapshot.invoked.values())


def elapse(machine: MachineDefinition, current: Callable[[], Snapshot], until: float) -> Iterator[Step]:
    """Yield the steps of all timers that end up to `until` [s], in order, including timers set by these steps.

    `current` returns the snapshot to step from: the caller may process further events between two steps. Raises
    LumenError if timers of one time have no end, such as a `send` without delay that triggers itself, or if new timers
    end at a rate of more than MAX_RATE.
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
