"""The three functions that run a behaviour: `initial`, `step` and `due`."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.errors import LumenError, SnapshotError, UsageError
from lumen.interpreters.statechart.chart import Chart
from lumen.interpreters.statechart.doing import awaited
from lumen.interpreters.statechart.plans import Planner
from lumen.interpreters.statechart.run import LIMIT, Run
from lumen.interpreters.statechart.types import fits, type_name
from lumen.interpreters.statechart.values import Snapshot, Step, Timer
from lumen.language.diagnostics import did_you_mean
from lumen.language.events import Event
from lumen.language.machines import Machine


class Program(NamedTuple):
    """A machine compiled."""

    chart: Chart
    planner: Planner


def initial(
    machine: Machine,
    at: float = 0.0,
    input: Mapping[str, Any] | None = None,
    language: str = "",
    *,
    epoch: float = 0.0,
    seed: int = 0,
) -> Step:
    """The first step: the initial states entered at `at` [s].

    `input` gives context keys other first values; raises UsageError where there is no such key, or it holds another
    type. `epoch` is the local time of day at time 0 [s since midnight], `seed` begins the drawing of alternatives.
    """
    program = compiled(machine)
    context = {**machine.context, **_checked(program.chart, input or {})}
    before = Snapshot(frozenset(), context, at, language, generator=seed % 2**32, epoch=epoch)
    run = Run(program.chart, program.planner, before, None, at)
    run.microstep(program.planner.beginning())
    return run.settle()


def step(machine: Machine, snapshot: Snapshot, event: Event) -> Step:
    """One macrostep: `event` and all that follows from it until the next event from outside.

    The robot's answers and the events of `due` are known by their names and ids; those that nobody waits for any
    more change nothing. Time never goes back: an event from the past happens at `snapshot.at`. Raises LumenError
    where the machine never comes to rest, SnapshotError where the snapshot has states that the machine has not.
    """
    chart, planner = compiled(machine)
    name, _, at, sendid = event
    try:
        run = Run(chart, planner, snapshot, event, at if at > snapshot.at else snapshot.at)
    except KeyError as error:
        raise SnapshotError(f"`{machine.id}` has no state `{error.args[0]}`, which is active in the snapshot") from None
    if sendid:
        _elapse(run, event)
    elif ".command." in name and _is_answer(name):
        _answer(run, event)
    else:
        run.take(run.configuration.candidates(name))
    return run.settle()


def due(snapshot: Snapshot) -> Event | None:
    """The timer that ends next, as the event to step with, at its time; None where there is none."""
    if not snapshot.timers:
        return None
    timer = min(snapshot.timers, key=lambda t: t.due)
    return Event(timer.event, timer.data, timer.due, timer.id)


def elapse(machine: Machine, current: Callable[[], Snapshot], until: float) -> Iterator[Step]:
    """The steps of every timer that ends until `until` [s], those set on the way included, in order.

    `current` gives the snapshot to step from: whoever takes a step may have more happen before the next. Raises
    LumenError where there is no end of timers of one time, as of a `send` without delay that answers itself.
    """
    count, last = 0, until
    while (event := due(current())) and event.at <= until:
        count = count + 1 if event.at == last else 1
        last = event.at
        if count > LIMIT:
            raise LumenError(f"`{machine.id}` never comes to rest: `{event.name}` is sent over and over without delay")
        yield step(machine, current(), event)


def compiled(machine: Machine) -> Program:
    """The machine's program, made on first use and kept beside it."""
    program: Program | None = machine.__dict__.get("_program")
    if program is None:
        chart = Chart(machine)
        program = Program(chart, Planner(chart))
        object.__setattr__(machine, "_program", program)  # frozen, and the same for all who hold it
    return program


def _checked(chart: Chart, input: Mapping[str, Any]) -> Mapping[str, Any]:
    for key, value in input.items():
        if key not in chart.checks:
            hint = did_you_mean(key, chart.checks)
            raise UsageError(
                f"`{chart.machine.id}` has no `{key}` in its context to be given" + f": {hint}" * bool(hint)
            )
        if not fits(value, chart.checks[key]):
            raise UsageError(f"`{key}` is {chart.checks[key]} and can't be a {type_name(value)}")
    return input


def _elapse(run: Run, event: Event) -> None:
    """A timer has ended; one that is no longer there has been cancelled."""
    ended = [t for t in run.timers if t.id == event.sendid and t.event == event.name]
    if not ended:
        return
    timer = min(ended, key=lambda t: t.due)
    run.timers = _without(run.timers, timer)
    if timer.kind == "after":
        run.take(run.configuration.timed(timer.event))
    elif timer.kind == "send":
        run.take(run.configuration.candidates(event.name))
    elif timer.id in awaited(run.doing.get(timer.state)):
        run.answered(timer.state, timer.id)


def _without(timers: tuple[Timer, ...], timer: Timer) -> tuple[Timer, ...]:
    index = next(i for i, t in enumerate(timers) if t is timer)
    return timers[:index] + timers[index + 1 :]


def _is_answer(name: str) -> bool:
    kind, _, id = name.partition(".command.")
    return kind in ("done", "error", "cancelled") and id[:1] in ("c", "d") and id[1:].isdecimal()


def _answer(run: Run, event: Event) -> None:
    """What became of a command: the `do` that awaits it goes on or fails; nobody else hears of it."""
    kind, _, id = event.name.partition(".command.")
    data = event.data if isinstance(event.data, Mapping) else {}
    reason = str(data.get("reason", "")) or kind
    owner = next((path for path, position in run.doing.items() if id in awaited(position)), None)
    if owner is not None and kind == "done":
        run.answered(owner, id)
    elif owner is not None:
        node = run.chart.nodes[owner]
        run.begun = ()
        run.collapse(node, id, reason)
    elif kind == "error" and id.startswith("c"):
        run.post(Event("error.communication", {"command": id, "reason": reason}, run.at))
