"""Statecharts from files and dicts, and a thin shell that runs one; `lumen.statechart` offers both classes."""

from collections.abc import Callable, Mapping
from copy import deepcopy
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Self, overload

from lumen.clock.virtual import VirtualClock
from lumen.errors import UsageError
from lumen.language import machines
from lumen.language.events import Event
from lumen.language.nanoseconds import HALF
from lumen.ports import Clock
from lumen.project.plain import derived
from lumen.project.standalone import machine_from_dict, machine_from_file
from lumen.statechart import (
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
)
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.json_cursor import plain
from lumen.statechart.stepping import in_full
from lumen.statechart.values import Timer
from lumen.upkeep.arguments import need, need_map, need_methods, need_path, need_text

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    C = TypeVar("C", bound=Clock, default=VirtualClock)
else:
    from typing import TypeVar

    C = TypeVar("C", bound=Clock)  # only type checkers need the default: Python has it from 3.13 on

_new = tuple.__new__  # half the cost of Event(…)
_SOON = 2 * HALF
"""Timers that end within this time end now [s]."""


def _unobserved(_: Step) -> None:
    """Ignore a step: the default observer."""


class Machine(machines.MachineDefinition):
    """A statechart on its own, without a project around it."""

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the machine in a file; machines that it invokes are in the same folder, words in `words/` below it.

        Functions are in `../functions/`. Raises UsageError if a file can't be read, ProjectError if the files have
        mistakes.
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
        """Return the machine in a dict with the structure of a file; raise ProjectError if it has mistakes.

        `behaviors` are those that it may invoke, by name, each a dict like `data`; `words` are the words files.
        """
        need_text(name, "the name of a machine")
        need_map(data, "the data of a machine")
        for others, what in ((behaviors, "`behaviors`"), (words, "`words`")):
            if others is not None:
                need_map(others, what)
        return cls._derived(machine_from_dict(data, name, behaviors or {}, words or {}), {})

    @classmethod
    def _derived(cls, machine: machines.MachineDefinition, known: dict[str, Self]) -> Self:
        """Return the machine as an object of this class, with the machines that it invokes; each is made once."""
        for name, other in machine.invoked.items():
            if name not in known:
                known[name] = cls._derived(other, known)
        made = derived(cls, replace(machine, invoked={name: known[name] for name in machine.invoked}))
        compiled(made)  # callers expect to wait when they make a machine, but not when they start it
        return made


class Interpreter(Generic[C]):
    """A machine that runs on a clock. The type parameter is the type of `clock`; the default is a virtual clock.

    `observe` is called with every step, in order; it may call `send`. With a virtual clock everything happens within
    `start`, `send` and `clock.advance`; with another clock call `wake` at the time `next_due`. The other options are
    those of `initial`. Before `start`, the methods `send`, `wake` and `snapshot` and all properties raise UsageError.
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
        observe: Callable[[Step], None] = _unobserved,
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
        observe: Callable[[Step], None] = _unobserved,
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
        observe: Callable[[Step], None] = _unobserved,
    ) -> None:
        need(machine, machines.MachineDefinition, "the argument `machine`", "a Machine")
        if clock is not None:
            need_methods(clock, Clock, "a clock")
        if not callable(observe):
            raise UsageError(f"`observe` must be a function, which {observe!r} is not")
        self.machine = machine
        kept: Any = VirtualClock() if clock is None else clock
        self.clock = kept
        self._options: dict[str, Any] = {
            "input": input, "language": language, "epoch": epoch, "timezone": timezone, "seed": seed,
        }  # fmt: skip
        self._observe = observe
        self._snapshot: Snapshot | None = None
        self._timers, self._next = tuple[Timer, ...](), inf
        self._quick = compiled(machine).fast_paths.step
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
        observe: Callable[[Step], None] = _unobserved,
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
        observe: Callable[[Step], None] = _unobserved,
    ) -> "Interpreter[C]": ...

    @classmethod
    def restore(
        cls,
        machine: machines.MachineDefinition,
        snapshot: Mapping[str, Any],
        clock: Any = None,
        timers: TimerPolicy = "deadline",
        *,
        observe: Callable[[Step], None] = _unobserved,
    ) -> "Interpreter[Any]":
        """Return an interpreter that continues from a `snapshot()`; raise SnapshotError if that is of another machine.

        Without a clock, time continues from the snapshot. `timers` determines when running timers end: `deadline` at
        their old time, for a clock that continues the old one (overdue timers end at once); `remaining` after the time
        that they had left at the snapshot; `restart` after their whole delay.
        """
        if timers not in ("deadline", "remaining", "restart"):
            raise UsageError(f"`timers` can't be `{timers}`: write `deadline`, `remaining` or `restart`")
        need(machine, machines.MachineDefinition, "the argument `machine`", "a Machine")
        thawed = deserialize(machine, snapshot)
        it = cls(machine, VirtualClock(thawed.at) if clock is None else clock, observe=observe)
        it._snapshot = retimed(thawed, it.clock.now(), timers)
        it.wake()
        return it

    def start(self) -> Step:
        """Enter the initial states. Raises UsageError if called twice, or if `input` does not fit."""
        if self._snapshot is not None:
            raise UsageError("the interpreter is already started")
        self._options["input"] = plain(self._options["input"], "input")
        first = self._take(initial(self.machine, at=self.clock.now(), **self._options))
        self.wake()
        return first

    def send(self, event: str | Event, data: Any = None) -> Step:
        """Process an event now, after everything that is due; return its step.

        Raises UsageError if `data` is not JSON data, because a snapshot could not hold it.
        """
        name, sendid, cause = event, "", None
        if isinstance(event, Event):
            name, data, _, sendid, cause = event
        elif type(event) is not str:
            need(event, (str, Event), "an event", "its name, or an Event")
        if not name or type(name) is not str:
            need_text(name, "the name of an event")
        if data is not None:
            data = plain(data, "event.data")
        now, at = self._snapshot, self.clock.now()
        if now is None or now.timers is not self._timers or now.invoked or self._next < at + _SOON:
            self.wake()
            now, at = self._now, self.clock.now()
        sent = _new(Event, (name, data, at, sendid, cause))
        try:
            taken = self._quick(now, sent)
        except Exception:  # nothing has happened yet: `in_full` fails for the same reason, with a message
            taken = None
        if taken is None:
            taken = in_full(self.machine, now, sent)
        now = self._snapshot = taken.snapshot
        if self._observe is not _unobserved:
            self._observe(taken)
            now = self._now  # the observer may send
        if now.timers is not self._timers or now.invoked:
            self.wake()
        return taken

    def wake(self) -> None:
        """Process everything that is due."""
        now, at = self._snapshot or self._now, self.clock.now()
        if now.timers is not self._timers:
            self._timers, self._next = now.timers, min((timer.due for timer in now.timers), default=inf)
        if now.invoked or self._next < at + _SOON:
            for taken in elapse(self.machine, lambda: self._now, at):
                self._take(taken)

    def next_due(self) -> float | None:
        """Return when the next timer ends [s]; None if there are no timers."""
        event = due(self._snapshot) if self._snapshot else None
        return event.at if event else None

    @property
    def done(self) -> bool:
        """Whether the machine has ended: it accepts no more events."""
        return finished(self.machine, self._now)

    @property
    def output(self) -> Any:
        """The output of the final state in which the machine has ended; None before, or without an output."""
        return deepcopy(self._now.output)

    @property
    def configuration(self) -> frozenset[str]:
        """The active states except the root, each by its alias if it has one, otherwise by its path."""
        return self._now.configuration

    @property
    def context(self) -> dict[str, Any]:
        """A copy of the context, which the caller may change."""
        return deepcopy(dict(self._now.context))

    def snapshot(self) -> dict[str, Any]:
        """Return everything needed to continue elsewhere, as JSON data; its time `at` is the clock's present time [s].

        Raises SnapshotError if the context holds a value from an event that is not JSON.
        """
        now = self._now
        return serialize(self.machine, now._replace(at=max(now.at, self.clock.now())))

    @property
    def _now(self) -> Snapshot:
        if self._snapshot is None:
            raise UsageError("the interpreter is not started: call `start` first")
        return self._snapshot

    def _take(self, taken: Step) -> Step:
        self._snapshot = taken.snapshot
        self._observe(taken)
        return taken
