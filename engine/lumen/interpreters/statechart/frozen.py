"""Snapshots as plain JSON data and back, for the disk; and their timers on another clock."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Literal

from lumen.errors import SnapshotError
from lumen.interpreters.statechart.values import Awaiting, Counters, Fork, Invoked, Position, Snapshot, Timer, Within
from lumen.language.machines import Machine

VERSION = 1

Timing = Literal["deadline", "remaining", "restart"]


def freeze(machine: Machine, snapshot: Snapshot) -> dict[str, Any]:
    """The snapshot as JSON data that names the machine it belongs to."""
    return {
        "version": VERSION,
        "machine": {
            "id": machine.id,
            "hash": machine.hash,
            "states": [path for path in machine.states if path],
            "context": list(machine.context),
        },
        "configuration": [s.name for s in machine.states.values() if s.path and s.name in snapshot.configuration],
        "context": _plain(snapshot.context),
        "at": snapshot.at,
        "language": snapshot.language,
        "timers": [_plain(timer._asdict()) for timer in snapshot.timers],
        "doing": {path: _position(position) for path, position in snapshot.doing.items()},
        "history": {path: list(remembered) for path, remembered in snapshot.history.items()},
        "counters": snapshot.counters._asdict(),
        "generator": snapshot.generator,
        "epoch": snapshot.epoch,
        "invoked": {
            id: {
                "state": child.state,
                "snapshot": freeze(_invoked(machine, child.state, id), child.snapshot),
                "commands": child.commands,
            }
            for id, child in snapshot.invoked.items()
        },
    }


def thaw(machine: Machine, data: Mapping[str, Any]) -> Snapshot:
    """The snapshot that `freeze` made of this machine; raises SnapshotError naming what differs."""
    try:
        if data["version"] != VERSION:
            raise SnapshotError(f"the snapshot is of version {data['version']}, and this Lumen reads {VERSION}")
        if difference := _difference(machine, data["machine"]):
            raise SnapshotError(f"the snapshot is not of `{machine.id}` as it is now: {difference}")
        return _read(machine, data)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise SnapshotError(f"this is not a snapshot, or it is damaged: {type(error).__name__} {error}") from None


def retimed(snapshot: Snapshot, now: float, timing: Timing) -> Snapshot:
    """The snapshot gone on with at `now` [s].

    `deadline` leaves every timer its due time (what is past comes at once), `remaining` the time that it still had,
    and `restart` begins its delay anew.
    """
    match timing:
        case "deadline":
            return snapshot
        case "remaining":
            later = now - snapshot.at
            return _moved(snapshot, now, lambda timer: timer.due + later)
        case "restart":
            return _moved(snapshot, now, lambda timer: now + timer.delay)


def _moved(snapshot: Snapshot, now: float, due: Callable[[Timer], float]) -> Snapshot:
    return snapshot._replace(
        at=now,
        timers=tuple(timer._replace(due=due(timer)) for timer in snapshot.timers),
        invoked={
            id: child._replace(snapshot=_moved(child.snapshot, now, due)) for id, child in snapshot.invoked.items()
        },
    )


def _read(machine: Machine, data: Mapping[str, Any]) -> Snapshot:
    names = frozenset(data["configuration"])
    unknown = names - {state.name for state in machine.states.values() if state.path}
    unknown |= data["doing"].keys() - machine.states.keys()
    if unknown:
        raise SnapshotError(f"`{machine.id}` has no {_list('state', unknown)}")
    return Snapshot(
        configuration=names,
        context=_plain(data["context"]),
        at=float(data["at"]),
        language=str(data["language"]),
        timers=tuple(Timer(**timer) for timer in data["timers"]),
        doing={path: _within(position) for path, position in data["doing"].items()},
        history={path: tuple(remembered) for path, remembered in data["history"].items()},
        counters=Counters(**data["counters"]),
        generator=int(data["generator"]),
        epoch=float(data["epoch"]),
        invoked={
            id: Invoked(
                child["state"],
                thaw(_invoked(machine, child["state"], id), child["snapshot"]),
                int(child["commands"]),
            )
            for id, child in data["invoked"].items()
        },
    )


def _invoked(machine: Machine, state: str, id: str) -> Machine:
    """The machine that a state invokes under that id; raises KeyError where there is none."""
    for invoke in machine.states[state].invoke:
        if invoke.id == id:
            return machine.invoked[invoke.behavior]
    raise KeyError(id)


def _difference(machine: Machine, other: Mapping[str, Any]) -> str:
    if other["hash"] == machine.hash and other["id"] == machine.id:
        return ""
    ours, theirs = {path for path in machine.states if path}, set(other["states"])
    keys, their_keys = set(machine.context), set(other["context"])
    found = [
        f"it is of `{other['id']}`" if other["id"] != machine.id else "",
        f"{_list('state', theirs - ours)} is gone" if theirs - ours else "",
        f"{_list('state', ours - theirs)} is new" if ours - theirs else "",
        f"{_list('context key', their_keys - keys)} is gone" if their_keys - keys else "",
        f"{_list('context key', keys - their_keys)} is new" if keys - their_keys else "",
    ]
    same = f"the states are the same, but what stands in them is not ({other['hash'][:8]} then, {machine.hash[:8]} now)"
    return "; ".join(filter(None, found)) or same


def _list(what: str, names: Iterable[str]) -> str:
    shown = sorted(names)
    return f"{what} {', '.join(f'`{name}`' for name in shown[:8])}{', …' if len(shown) > 8 else ''}"


def _plain(value: Any) -> Any:
    match value:
        case Mapping():
            return {str(key): _plain(item) for key, item in value.items()}
        case list() | tuple():
            return [_plain(item) for item in value]
    return value


def _position(position: Position) -> dict[str, Any]:
    match position:
        case Awaiting(id):
            return {"awaiting": id}
        case Within(block, place, inner):
            return {"block": block, "place": place, "inner": _position(inner)}
        case Fork(branches):
            return {"branches": [branch and _position(branch) for branch in branches]}


def _within(data: Mapping[str, Any]) -> Within:
    return Within(data["block"], data["place"], _thawed(data["inner"]))


def _thawed(data: Mapping[str, Any]) -> Position:
    if "awaiting" in data:
        return Awaiting(data["awaiting"])
    if "branches" in data:
        return Fork(tuple(branch and _thawed(branch) for branch in data["branches"]))
    return _within(data)
