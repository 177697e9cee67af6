"""Converts snapshots to plain JSON data, and moves their timers to another clock."""

from collections.abc import Callable
from typing import Any, Literal

from lumen.errors import SnapshotError, UsageError
from lumen.language.machines import MachineDefinition
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.deserialization import SNAPSHOT_VERSION
from lumen.statechart.json_cursor import plain
from lumen.statechart.values import Awaiting, Fork, Halted, Position, Snapshot, Timer, Within

TimerPolicy = Literal["deadline", "remaining", "restart"]


def serialize(machine: MachineDefinition, snapshot: Snapshot) -> dict[str, Any]:
    """Return the snapshot as JSON data that identifies its machine.

    Raises SnapshotError if the snapshot holds a value from an event that is not JSON data.
    """
    try:
        return _data(machine, snapshot)
    except UsageError as error:
        raise SnapshotError(f"the snapshot of `{machine.id}` can't be written: {error}") from None


def _data(machine: MachineDefinition, snapshot: Snapshot) -> dict[str, Any]:
    return {
        "version": SNAPSHOT_VERSION,
        "machine": {
            "id": machine.id,
            "hash": machine.hash,
            "states": [path for path in machine.states if path],
            "context": list(machine.context),
        },
        "configuration": [s.name for s in machine.states.values() if s.path and s.name in snapshot.configuration],
        "context": plain(snapshot.context, "context"),
        "at": snapshot.at,
        "language": snapshot.language,
        "timers": [_timer(timer) for timer in snapshot.timers],
        "doing": {path: _position(position) for path, position in snapshot.doing.items()},
        "halted": {path: {"position": _position(p), "at": at} for path, (p, at) in snapshot.halted.items()},
        "history": {path: list(remembered) for path, remembered in snapshot.history.items()},
        "counters": snapshot.counters._asdict(),
        "generator": snapshot.generator,
        "epoch": snapshot.epoch,
        "place": snapshot.place,
        "timezone": snapshot.timezone,
        "output": plain(snapshot.output, "output"),
        "invoked": {
            id: {
                "state": child.state,
                "snapshot": _data(
                    machine.invoked.get(machine.invoked_behavior(child.state, id), machine), child.snapshot
                ),
                "commands": child.commands,
            }
            for id, child in snapshot.invoked.items()
        },
    }


def retimed(snapshot: Snapshot, now: float, timing: TimerPolicy) -> Snapshot:
    """Return the snapshot, to be continued at `now` [s] on its new clock.

    `deadline` keeps the due time of every timer: overdue ones end at once, at `now`. `remaining` keeps the time that
    each timer had left, and `restart` begins its delay anew; with both, time in the snapshot stops meanwhile, so its
    `epoch` moves along and its time of day continues from there. An `at` keeps its time of day.
    """
    match timing:
        case "deadline":
            return snapshot._replace(at=now)
        case "remaining":
            later = nanoseconds(now) - nanoseconds(snapshot.at)
            return _shifted(snapshot, now, now - snapshot.at, lambda timer: timer.due_ns + later)
        case "restart":
            later = nanoseconds(now) - nanoseconds(snapshot.at)
            return _shifted(
                snapshot,
                now,
                now - snapshot.at,
                lambda t: t.due_ns + later if t.kind == "at" else nanoseconds(now) + t.delay_ns,
            )


def paused(snapshot: Snapshot, away: float) -> Snapshot:
    """Return the snapshot after a pause of `away` [s], in which its commands made no progress."""
    return snapshot._replace(
        doing={path: moved(position, away) for path, position in snapshot.doing.items()},
        invoked={id: child._replace(snapshot=paused(child.snapshot, away)) for id, child in snapshot.invoked.items()},
    )


def _shifted(snapshot: Snapshot, now: float, later: float, due: Callable[[Timer], int]) -> Snapshot:
    return snapshot._replace(
        at=now,
        epoch=snapshot.epoch - later,
        timers=tuple(timer._replace(due_ns=due(timer)) for timer in snapshot.timers),
        doing={path: moved(position, later) for path, position in snapshot.doing.items()},
        halted={path: Halted(moved(p, later), at + later) for path, (p, at) in snapshot.halted.items()},
        invoked={
            id: child._replace(snapshot=_shifted(child.snapshot, now, later, due))
            for id, child in snapshot.invoked.items()
        },
    )


def moved(position: Within, later: float) -> Within:
    """Return the position with the start of each wait moved later by `later` [s]."""
    return position._replace(inner=_moved(position.inner, later))


def _moved(position: Position, later: float) -> Position:
    match position:
        case Awaiting(_, at):
            return position._replace(at=at + later)
        case Within():
            return moved(position, later)
        case Fork(branches):
            return Fork(tuple(branch and _moved(branch, later) for branch in branches))


def _timer(timer: Timer) -> dict[str, Any]:
    """Return a timer with times in [s], as everywhere in a snapshot."""
    id, _, _, event, data, state, kind, to = timer
    return {
        "id": id,
        "due": timer.due,
        "delay": timer.delay,
        "event": event,
        "data": plain(data, id),
        "state": state,
        "kind": kind,
    } | ({"to": to} if to else {})


def _position(position: Position) -> dict[str, Any]:
    match position:
        case Awaiting(id, at):
            return {"awaiting": id, "at": at}
        case Within(block, place, inner):
            return {"block": block, "place": place, "inner": _position(inner)}
        case Fork(branches):
            return {"branches": [branch and _position(branch) for branch in branches]}
