"""Reads snapshots from JSON data: every part is validated by itself and against the machine."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from lumen.errors import SnapshotError, UsageError
from lumen.expressions.wall_clock import zone
from lumen.language.machines import MachineDefinition, State, StateKind
from lumen.language.nanoseconds import nanoseconds
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.do_actions import (
    AskedQuestion,
    AwaitedCommand,
    CompiledAction,
    ConditionalAction,
    ParallelActions,
    TimedWait,
)
from lumen.statechart.json_cursor import JsonCursor
from lumen.statechart.type_checks import TypeCheck, fits, refusal
from lumen.statechart.values import (
    Awaiting,
    Counters,
    Fork,
    Halted,
    Invoked,
    Position,
    Snapshot,
    Timer,
    Within,
)

SNAPSHOT_VERSION = 1


def deserialize(machine: MachineDefinition, data: Mapping[str, Any]) -> Snapshot:
    """Return the snapshot that `serialize` made of this machine.

    Raises SnapshotError if the data is damaged, of another version, or of another or changed machine.
    """
    try:
        return _snapshot(machine, JsonCursor(data))
    except RecursionError:
        raise SnapshotError("the snapshot is damaged: it is nested too deeply") from None


def _snapshot(machine: MachineDefinition, data: JsonCursor) -> Snapshot:
    if data["version"].data != SNAPSHOT_VERSION:
        raise SnapshotError(
            f"the snapshot has version {data['version'].data}, but this version of Lumen reads {SNAPSHOT_VERSION}"
        )
    if difference := _difference(machine, data["machine"]):
        raise SnapshotError(f"the snapshot does not match `{machine.id}` as it is now: {difference}")
    found = _SnapshotReader(machine, data["configuration"]).read(data)
    if compiled(machine).planner.configuration(found.configuration).finished:  # a finished machine waits for nothing
        return found._replace(timers=(), doing={}, halted={}, invoked={})
    return found


class _SnapshotReader:
    """Reads the parts of a snapshot, given the active states; raises SnapshotError for a part that does not fit."""

    def __init__(self, machine: MachineDefinition, configuration: JsonCursor) -> None:
        self.machine = machine
        self.names = frozenset(configuration.texts())
        if unknown := self.names - {state.name for state in machine.states.values() if state.path}:
            raise SnapshotError(f"`{machine.id}` has no {_list('state', unknown)}")
        for state in machine.states.values():
            if fault := self.fault(state):
                raise configuration.refused(f"can't be: {fault}")

    def read(self, data: JsonCursor) -> Snapshot:
        """Read all fields of a snapshot."""
        return Snapshot(
            configuration=self.names,
            context=self.context(data["context"]),
            at=data["at"].number(),
            language=data["language"].text(),
            timers=tuple(self.timer(row) for row in data["timers"].rows()),
            doing={path: self.position(path, part) for path, part in data["doing"].items()},
            halted={path: self.halted(path, part) for path, part in data.optional("halted")},
            history={path: self.remembered(path, part) for path, part in data["history"].items()},
            counters=Counters(**{key: data["counters"][key].count() for key in Counters._fields}),
            generator=data["generator"].count() % 2**32,
            epoch=data["epoch"].number(),
            place=data["place"].text() if "place" in dict(data.items()) else "",
            output=data["output"].plain() if any(key == "output" for key, _ in data.items()) else None,
            invoked={id: self.invoked(id, part) for id, part in data["invoked"].items()},
            timezone=self.timezone(data),
        )

    def timezone(self, data: JsonCursor) -> str:
        """Read the IANA name of the time zone; empty if older data have none."""
        if not (said := [part for key, part in data.items() if key == "timezone"]):
            return ""
        try:
            zone(name := said[0].text())
        except UsageError as error:
            raise said[0].refused(str(error)) from None
        return name

    def active(self, path: str) -> bool:
        """Return True if the state at that path is active; the root always is."""
        state = self.machine.states.get(path)
        return state is not None and (not path or state.name in self.names)

    def fault(self, state: State) -> str:
        """Return why the active children of a state are inconsistent; empty if they are consistent."""
        children = [self.machine.states[path] for path in state.children]
        active = [child for child in children if child.name in self.names]
        here = f"`{state.name}`"
        if any(child.kind is StateKind.HISTORY for child in active):
            return f"a history state of {here} is active"
        if not self.active(state.path):
            return f"`{active[0].name}` is active without {here} around it" if active else ""
        if state.kind is StateKind.COMPOUND and len(active) != 1:
            return f"{len(active)} states of {here} are active, but only one can be"
        regions = [child for child in children if child.kind is not StateKind.HISTORY]
        if state.kind is StateKind.PARALLEL and len(active) < len(regions):
            return f"active regions of {here}: {len(active)} of {len(regions)}, but all must be active"
        return ""

    def context(self, data: JsonCursor) -> dict[str, Any]:
        """Read the context: exactly the machine's keys, each with a value of its type."""
        checks: Mapping[str, TypeCheck | None] = compiled(self.machine).chart.checks
        found: dict[str, Any] = {key: data[key].plain() for key in self.machine.context}
        for key, part in data.items():
            if key not in found:
                raise part.refused("is not a key of the context")
            if not fits(found[key], checks[key]):
                raise part.refused(refusal(found[key], checks[key]))
        return found

    def timer(self, data: JsonCursor) -> Timer:
        """Read a timer whose state is active."""
        kind, state = data["kind"].text(), data["state"].text()
        if kind not in ("after", "at", "send", "wait"):
            raise data["kind"].refused("should be `after`, `at`, `send` or `wait`")
        if kind != "send" and not self.active(state):
            raise data["state"].refused(f"names `{state}`, which is not active")
        due, delay = nanoseconds(data["due"].number()), nanoseconds(data["delay"].number())
        event, content = data["event"].text(), data["data"].plain()
        if kind == "at" and event not in compiled(self.machine).chart.nodes[state].schedules:
            raise data["event"].refused(f"is not an `at` of `{state}`")
        to = data["to"].text() if any(key == "to" for key, _ in data.items()) else ""
        return Timer(data["id"].text(), due, delay, event, content, state, kind, to)  # type: ignore[arg-type]  # one of four

    def position(self, path: str, data: JsonCursor) -> Within:
        """Read the position of the `do` of an active state."""
        node = compiled(self.machine).chart.nodes.get(path)
        if node is None or not node.do or not self.active(path):
            raise data.refused("is not an active state with a `do`")
        return _within(data, node.do, ("do",))

    def halted(self, path: str, data: JsonCursor) -> Halted:
        """Read the position of a `do` that was left."""
        node = compiled(self.machine).chart.nodes.get(path)
        if node is None or not node.do:
            raise data.refused("is not a state with a `do`")
        return Halted(_within(data["position"], node.do, ("do",)), data["at"].number())

    def remembered(self, path: str, data: JsonCursor) -> tuple[str, ...]:
        """Read the states that a history state remembers."""
        state, paths = self.machine.states.get(path), tuple(data.texts())
        if state is None or state.kind is not StateKind.HISTORY:
            raise data.refused("is not a history state")
        if not (paths and all(self.may_remember(state, each) for each in paths)) or self.exclude(paths):
            raise data.refused(f"remembers {', '.join(paths) or 'nothing'}, which was never active there")
        return paths

    def may_remember(self, history: State, path: str) -> bool:
        """Return True if the history state could remember the state at that path."""
        state = self.machine.states.get(path)
        if state is None or state.kind is StateKind.HISTORY:
            return False
        home = history.parent or ""
        below = path != "" and (not home or path.startswith(f"{home}."))
        return below and not state.children if history.deep else state.parent == home

    def exclude(self, paths: Sequence[str]) -> bool:
        """Return True if two of these states can never be active at the same time."""
        states = self.machine.states
        around = {path for each in paths for path in _upwards(states, each)}
        alone = (state.children for state in states.values() if state.kind is StateKind.COMPOUND)
        return any(len(around.intersection(children)) > 1 for children in alone)

    def invoked(self, id: str, data: JsonCursor) -> Invoked:
        """Read the snapshot of an invoked behaviour."""
        state = data["state"].text()
        machine = self.machine.invoked.get(self.machine.invoked_behavior(state, id))
        if machine is None or not self.active(state):
            raise data.refused(f"was invoked by `{state}`, which is not active or does not invoke that id")
        return Invoked(state, _snapshot(machine, data["snapshot"]), data["commands"].count())


def _upwards(states: Mapping[str, State], path: str | None) -> Iterator[str]:
    while path is not None:
        yield path
        path = states[path].parent


def _within(data: JsonCursor, actions: tuple[CompiledAction, ...], blocks: tuple[str, ...]) -> Within:
    block, place = data["block"].text(), data["place"].count()
    if block not in blocks:
        raise data["block"].refused(f"should be {' or '.join(f'`{name}`' for name in blocks)}")
    if place >= len(actions):
        raise data["place"].refused(f"is {place}, but should be less than {len(actions)}, the number of actions")
    return Within(block, place, _position(data["inner"], actions[place]))  # type: ignore[arg-type]  # one of the blocks


def _position(data: JsonCursor, action: CompiledAction) -> Position:
    match action:
        case AwaitedCommand() | TimedWait():
            return _awaiting(data)
        case ConditionalAction():
            return _within(data, action.block(data["block"].text()), ("then", "else"))
        case ParallelActions(branches):
            rows = data["branches"].rows()
            if len(rows) != len(branches) or all(row.data is None for row in rows):
                raise data["branches"].refused(f"should have a position for each of {len(branches)} branches")
            pairs = zip(rows, branches, strict=True)
            return Fork(tuple(None if row.data is None else _position(row, branch) for row, branch in pairs))
        case AskedQuestion(otherwise=otherwise):
            if "block" in dict(data.items()):
                return _within(data, otherwise, ("else",))
            rows = data["branches"].rows()
            if len(rows) < 3 or all(row.data is None for row in rows):
                raise data["branches"].refused("should contain positions for the answer, its time limit and the text")
            return Fork(tuple(None if row.data is None else _awaiting(row) for row in rows))
    raise data.refused("is a position inside an action that has no inner positions")


def _awaiting(data: JsonCursor) -> Awaiting:
    return Awaiting(data["awaiting"].text(), data["at"].number() if "at" in dict(data.items()) else 0.0)


def _difference(machine: MachineDefinition, other: JsonCursor) -> str:
    id, hash = other["id"].text(), other["hash"].text()
    theirs, their_keys = set(other["states"].texts()), set(other["context"].texts())
    if hash == machine.hash and id == machine.id:
        return ""
    ours, keys = {path for path in machine.states if path}, set(machine.context)
    found = [
        f"it belongs to `{id}`" if id != machine.id else "",
        f"{_list('state', theirs - ours)} is gone" if theirs - ours else "",
        f"{_list('state', ours - theirs)} is new" if ours - theirs else "",
        f"{_list('context key', their_keys - keys)} is gone" if their_keys - keys else "",
        f"{_list('context key', keys - their_keys)} is new" if keys - their_keys else "",
    ]
    same = f"the states are the same, but their content differs ({hash[:8]} then, {machine.hash[:8]} now)"
    return "; ".join(filter(None, found)) or same


def _list(what: str, names: Iterable[str]) -> str:
    shown = sorted(names)
    return f"{what} {', '.join(f'`{name}`' for name in shown[:8])}{', …' if len(shown) > 8 else ''}"
