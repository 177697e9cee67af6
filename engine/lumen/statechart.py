"""Statecharts from files and dicts, and a thin shell that runs one: `Machine`, `initial`, `step`, `Interpreter`."""

from collections.abc import Callable, Mapping
from copy import deepcopy
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Self, overload

from lumen.clocks.virtual import VirtualClock
from lumen.errors import UsageError
from lumen.interpreters.arguments import need, need_map, need_path, need_text
from lumen.interpreters.statechart import (
    Snapshot,
    Step,
    TimerPolicy,
    deserialize,
    due,
    elapse,
    finished,
    initial,
    retimed,
    serialize,
    step,
)
from lumen.interpreters.statechart.json_cursor import plain
from lumen.language import machines
from lumen.language.events import Event
from lumen.loading.derived import derived
from lumen.loading.standalone import machine_from_dict, machine_from_file
from lumen.ports import Clock

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    C = TypeVar("C", bound=Clock, default=VirtualClock)
else:
    from typing import TypeVar

    C = TypeVar("C", bound=Clock)  # a default is for who checks types: Python has it from 3.13 on

__all__ = ["Event", "Interpreter", "Machine", "Snapshot", "Step", "VirtualClock", "due", "initial", "step"]


class Machine(machines.MachineDefinition):
    """A statechart on its own, without a project around it."""

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """The machine in a file; behaviours that it invokes stand beside it, words files in `words/`.

        Raises UsageError where a file can't be read, ProjectError for what they say.
        """
        return cls._derived(machine_from_file(need_path(path)), {})

    @classmethod
    def from_dict(
        cls,
        data: Mapping[str, Any],
        name: str = "machine",
        behaviors: Mapping[str, Mapping[str, Any]] | None = None,
        words: Mapping[str, Mapping[str, Any]] | None = None,
    ) -> Self:
        """The machine that a dict of the file's shape describes; raises ProjectError.

        `behaviors` are those that it may invoke, each a dict of its own, by their names; `words` the words files.
        """
        need_text(name, "the name of a machine")
        need_map(data, "the data of a machine")
        for others, what in ((behaviors, "`behaviors`"), (words, "`words`")):
            if others is not None:
                need_map(others, what)
        return cls._derived(machine_from_dict(data, name, behaviors or {}, words or {}), {})

    @classmethod
    def _derived(cls, machine: machines.MachineDefinition, known: dict[str, Self]) -> Self:
        """The same machine in this class, and those that it invokes, each of which is made once."""
        for name, other in machine.invoked.items():
            if name not in known:
                known[name] = cls._derived(other, known)
        return derived(cls, replace(machine, invoked={name: known[name] for name in machine.invoked}))


class Interpreter(Generic[C]):
    """A machine that runs on a clock, whose type `clock` has: `Interpreter` alone is one on a virtual clock.

    `observe` is shown every step in the order taken; it may `send`. With a virtual clock (the default) everything
    happens within `start`, `send` and `clock.advance`; with another clock call `wake` when `next_due` has come.
    The other options are those of `initial`.
    """

    clock: C

    @overload
    def __init__(
        self: "Interpreter[VirtualClock]",
        machine: machines.MachineDefinition,
        clock: None = None,
        *,
        input: Mapping[str, Any] | None = None,
        language: str = "",
        epoch: float = 0.0,
        timezone: str = "",
        seed: int = 0,
        observe: Callable[[Step], None] = lambda _: None,
    ) -> None: ...

    @overload
    def __init__(
        self,
        machine: machines.MachineDefinition,
        clock: C,
        *,
        input: Mapping[str, Any] | None = None,
        language: str = "",
        epoch: float = 0.0,
        timezone: str = "",
        seed: int = 0,
        observe: Callable[[Step], None] = lambda _: None,
    ) -> None: ...

    def __init__(
        self,
        machine: machines.MachineDefinition,
        clock: Any = None,
        *,
        input: Mapping[str, Any] | None = None,
        language: str = "",
        epoch: float = 0.0,
        timezone: str = "",
        seed: int = 0,
        observe: Callable[[Step], None] = lambda _: None,
    ) -> None:
        need(machine, machines.MachineDefinition, "what an interpreter runs", "a Machine")
        if clock is not None and not (callable(getattr(clock, "now", None)) and callable(getattr(clock, "wait", None))):
            raise UsageError(f"a clock has `now` and `wait`, which {clock!r} has not")
        if not callable(observe):
            raise UsageError(f"`observe` is called with each step, which {observe!r} can't be")
        self.machine = machine
        kept: Any = VirtualClock() if clock is None else clock
        self.clock = kept
        self._options: dict[str, Any] = {
            "input": input, "language": language, "epoch": epoch, "timezone": timezone, "seed": seed,
        }  # fmt: skip
        self._observe = observe
        self._snapshot: Snapshot | None = None
        if isinstance(self.clock, VirtualClock):
            self.clock.attach(self)

    @overload
    @classmethod
    def restore(
        cls,
        machine: machines.MachineDefinition,
        snapshot: Mapping[str, Any],
        clock: None = None,
        timers: TimerPolicy = "deadline",
        *,
        observe: Callable[[Step], None] = lambda _: None,
    ) -> "Interpreter[VirtualClock]": ...

    @overload
    @classmethod
    def restore(
        cls,
        machine: machines.MachineDefinition,
        snapshot: Mapping[str, Any],
        clock: C,
        timers: TimerPolicy = "deadline",
        *,
        observe: Callable[[Step], None] = lambda _: None,
    ) -> "Interpreter[C]": ...

    @classmethod
    def restore(
        cls,
        machine: machines.MachineDefinition,
        snapshot: Mapping[str, Any],
        clock: Any = None,
        timers: TimerPolicy = "deadline",
        *,
        observe: Callable[[Step], None] = lambda _: None,
    ) -> "Interpreter[Any]":
        """The interpreter that gave this `snapshot()`, going on; raises SnapshotError where it was of another machine.

        Without a clock, time goes on where it stood. `timers` keep their `deadline`, for a clock that goes on counting
        as the old one did (what is past comes at once); the time `remaining` to them when the snapshot was taken; or
        `restart` with their whole delay.
        """
        if timers not in ("deadline", "remaining", "restart"):
            raise UsageError(f"timers can't be `{timers}`: write `deadline`, `remaining` or `restart`")
        need(machine, machines.MachineDefinition, "what an interpreter runs", "a Machine")
        thawed = deserialize(machine, snapshot)
        it = cls(machine, VirtualClock(thawed.at) if clock is None else clock, observe=observe)
        it._snapshot = retimed(thawed, it.clock.now(), timers)
        it.wake()
        return it

    def start(self) -> Step:
        """Enter the initial states. Raises UsageError when repeated, or where `input` does not fit."""
        if self._snapshot is not None:
            raise UsageError("the interpreter has been started already")
        self._options["input"] = plain(self._options["input"], "input")
        first = self._take(initial(self.machine, at=self.clock.now(), **self._options))
        self.wake()
        return first

    def send(self, event: str | Event, data: Any = None) -> Step:
        """Let an event happen now, after everything that is due; the step it made.

        Raises UsageError where `data` is no JSON data: a snapshot could not hold it.
        """
        need(event, (str, Event), "an event", "its name, or an Event")
        name, data, _, sendid = Event(event, data) if isinstance(event, str) else event
        need_text(name, "the name of an event")
        data = plain(data, "event.data")
        self.wake()
        taken = self._take(step(self.machine, self._now, Event(name, data, self.clock.now(), sendid)))
        self.wake()
        return taken

    def wake(self) -> None:
        """Let everything happen that is due."""
        for taken in elapse(self.machine, lambda: self._now, self.clock.now()):
            self._take(taken)

    def next_due(self) -> float | None:
        """When the next timer ends [s]."""
        event = due(self._snapshot) if self._snapshot else None
        return event.at if event else None

    @property
    def done(self) -> bool:
        """Whether the machine has come to its end: it hears nothing any more."""
        return finished(self.machine, self._now)

    @property
    def output(self) -> Any:
        """The output of the final state in which the machine has come to its end; None before, or without one."""
        return deepcopy(self._now.output)

    @property
    def configuration(self) -> frozenset[str]:
        """The active states but the root, by alias where there is one, else by path."""
        return self._now.configuration

    @property
    def context(self) -> dict[str, Any]:
        """What the machine remembers: a copy, which is the caller's."""
        return deepcopy(dict(self._now.context))

    def snapshot(self) -> dict[str, Any]:
        """Everything needed to go on elsewhere, as JSON data; its time `at` [s] is the clock's now.

        Raises SnapshotError where an event brought something into the context that JSON can't hold.
        """
        now = self._now
        return serialize(self.machine, now._replace(at=max(now.at, self.clock.now())))

    @property
    def _now(self) -> Snapshot:
        if self._snapshot is None:
            raise UsageError("start the interpreter first")
        return self._snapshot

    def _take(self, taken: Step) -> Step:
        self._snapshot = taken.snapshot
        self._observe(taken)
        return taken
