"""A part of an installed package: its first fault stops it, and the exhibition continues."""

import logging
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from lumen.feature import Feature, PartRow, described, distribution_of
from lumen.language.commands import Command, Start
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.project.broken_features import faulty, shown
from lumen.run.loop import Observer
from lumen.run.parts.part import Part
from lumen.run.resuming import FreshStart, Resumption
from lumen.run.troubles import RunTrouble
from lumen.statechart import Step

T = TypeVar("T")
_log = logging.getLogger(__name__)


class AddedPart(Part, Observer):
    """A wrapper that passes every call on to `own`, a part made by a row of a package.

    After a fault that part is closed and receives no more calls. `stopped` is then called once with the part's name and
    its package, and with a sentence about the fault. Raises TypeError if `own` is not a valid part.
    """

    def __init__(self, own: Part, feature: Feature, row: PartRow, stopped: Callable[[str, str], None]) -> None:
        if not isinstance(own, Part):
            raise TypeError(f"`{row.make}` returned {shown(own)}, which is no part")
        if not (isinstance(own.needs, tuple | list) and all(isinstance(each, str) for each in own.needs)):
            raise TypeError(f"`needs` of the part is {shown(own.needs)}: write a tuple of names")
        if own.watches and not isinstance(own, Observer):
            kind = type(own).__name__
            raise TypeError(f"the part {kind} watches the behaviour: derive it from Observer, too")
        self.own, self._feature, self._row, self._stopped = own, feature, row, stopped
        self._watcher = own if isinstance(own, Observer) else Observer()
        self.name, self.needs, self.patient, self.watches = own.name, own.needs, own.patient, own.watches
        self._running = True

    @property
    def over(self) -> bool:
        return self._call(lambda: bool(self.own.over), False)

    @property
    def failed(self) -> bool:
        return self._call(lambda: bool(self.own.failed), False)

    @property
    def trouble(self) -> str:
        return self._call(lambda: _line(self.own.trouble), "")

    def begin(self, now: float) -> None:
        self._call(lambda: self.own.begin(now), None)

    def recovered(self, found: Resumption | FreshStart) -> None:
        self._call(lambda: self.own.recovered(found), None)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._call(lambda: self.own.tick(now, changes), None)

    def noticed(self, event: Event) -> None:
        self._call(lambda: self.own.noticed(event), None)

    def quiet_until(self, now: float) -> float:
        return self._call(lambda: _time(self.own.quiet_until(now)), super().quiet_until(now))

    def leap(self, now: float) -> None:
        self._call(lambda: self.own.leap(now), None)

    def use(self, project: Project) -> None:
        self._call(lambda: self.own.use(project), None)

    def interrupt(self) -> bool:
        return self._call(lambda: bool(self.own.interrupt()), False)

    def helpless(self, reason: str) -> None:
        self._call(lambda: self.own.helpless(reason), None)

    def part_stopped(self, part: str) -> None:
        self._call(lambda: self.own.part_stopped(part), None)

    def marking(self) -> str:
        return self._call(lambda: _line(self.own.marking()), "")

    def summary(self) -> Iterator[str]:
        nothing: tuple[str, ...] = ()
        yield from self._call(lambda: tuple(map(_line, self.own.summary())), nothing)

    def close(self) -> None:
        self._call(self.own.close, None)

    def stepped(self, step: Step) -> None:
        self._call(lambda: self._watcher.stepped(step), None)

    def performing(self, command: Command, now: float) -> None:
        self._call(lambda: self._watcher.performing(command, now), None)

    def refused(self, command: Start, reason: str) -> None:
        self._call(lambda: self._watcher.refused(command, reason), None)

    def answered(self, event: Event) -> None:
        self._call(lambda: self._watcher.answered(event), None)

    def troubled(self, trouble: RunTrouble) -> None:
        self._call(lambda: self._watcher.troubled(trouble), None)

    def _call(self, call: Callable[[], T], otherwise: T) -> T:
        """Return the result of a call; return `otherwise` if the part is stopped, or this call stops it."""
        if not self._running:
            return otherwise
        try:
            return call()
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # the package's code may even raise SystemExit
            self._stop(error)
        return otherwise

    def _stop(self, error: BaseException) -> None:
        """Close the part, and report its fault."""
        self._running, self.patient = False, True
        name = f"the part `{self._row.name}` of the package {distribution_of(self._feature)}"
        _log.error("%s is stopped", name, exc_info=error)
        try:
            self.own.close()
        except KeyboardInterrupt:
            raise
        except BaseException as second:
            _log.error("%s can't be closed: %s", name, described(second))
        fault = faulty(self._feature, f"its part `{self._row.name}` is stopped, because it raised {described(error)}")
        self._stopped(name, str(fault))


def _time(value: Any) -> float:
    if isinstance(value, int | float):
        return value
    raise TypeError(f"`quiet_until` returned {shown(value)} instead of a time")


def _line(value: Any) -> str:
    if isinstance(value, str):
        return value
    raise TypeError(f"it returned {shown(value)}, which is no text")
