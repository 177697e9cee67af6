"""Snapshots as plain JSON data, for the disk; and their timers on another clock."""

from collections.abc import Callable
from typing import Any, Literal

from lumen.errors import SnapshotError, UsageError
from lumen.interpreters.statechart.deserialization import SNAPSHOT_VERSION
from lumen.interpreters.statechart.json_cursor import plain
from lumen.interpreters.statechart.values import Awaiting, Fork, Position, Snapshot, Timer, Within
from lumen.language.machines import MachineDefinition

TimerPolicy = Literal["deadline", "remaining", "restart"]


def serialize(machine: MachineDefinition, snapshot: Snapshot) -> dict[str, Any]:
    """The snapshot as JSON data that names the machine it belongs to.

    Raises SnapshotError where an event brought something into it that JSON can't hold.
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
        "timers": [plain(timer._asdict(), timer.id) for timer in snapshot.timers],
        "doing": {path: _position(position) for path, position in snapshot.doing.items()},
        "history": {path: list(remembered) for path, remembered in snapshot.history.items()},
        "counters": snapshot.counters._asdict(),
        "generator": snapshot.generator,
        "epoch": snapshot.epoch,
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
    """The snapshot gone on with at `now` [s], the time of its new clock.

    `deadline` leaves every timer its due time: what is past comes at once, at `now`. `remaining` leaves it the time
    that it still had when the snapshot was taken, and `restart` begins its delay anew; in both the clock is another,
    and the time of day goes on from the snapshot's.
    """
    match timing:
        case "deadline":
            return snapshot._replace(at=now)
        case "remaining":
            return _shifted(snapshot, now, now - snapshot.at, lambda timer: timer.due + now - snapshot.at)
        case "restart":
            return _shifted(snapshot, now, now - snapshot.at, lambda timer: now + timer.delay)


def _shifted(snapshot: Snapshot, now: float, later: float, due: Callable[[Timer], float]) -> Snapshot:
    return snapshot._replace(
        at=now,
        epoch=snapshot.epoch - later,
        timers=tuple(timer._replace(due=due(timer)) for timer in snapshot.timers),
        invoked={
            id: child._replace(snapshot=_shifted(child.snapshot, now, later, due))
            for id, child in snapshot.invoked.items()
        },
    )


def _position(position: Position) -> dict[str, Any]:
    match position:
        case Awaiting(id):
            return {"awaiting": id}
        case Within(block, place, inner):
            return {"block": block, "place": place, "inner": _position(inner)}
        case Fork(branches):
            return {"branches": [branch and _position(branch) for branch in branches]}
