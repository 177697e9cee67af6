"""Checks the properties of a run: a safety property at every step, a bounded response at its deadline."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf
from typing import NamedTuple

from lumen.errors import ExpressionError
from lumen.expressions import Scope, compile_guard
from lumen.language.actions import Expression
from lumen.language.machines import MachineDefinition
from lumen.language.nanoseconds import nanoseconds
from lumen.language.properties import Property
from lumen.statechart.values import Snapshot


class Violation(NamedTuple):
    """A property that was violated, and how, in words."""

    property: Property
    how: str


@dataclass
class PropertyMonitor:
    """Checks one property in one run."""

    definition: Property
    machine: MachineDefinition
    since: float | None = None
    """The time when the monitor began to wait for `eventually` [s]; None while it does not wait."""
    begun: bool = False
    """True after the first step."""
    held: bool = False
    """True if `whenever` was true after the last step."""

    def step(self, snapshot: Snapshot) -> Violation | None:
        """Check the property after a macrostep; return the violation, else None."""
        property = self.definition
        if property.always:
            return None if holds(self.machine, property.always, snapshot) else _broken(property, snapshot.at)
        if late := self.elapse(snapshot.at):
            return late
        asked = not self.begun if property.whenever is None else holds(self.machine, property.whenever, snapshot)
        if asked and not self.held and self.since is None:
            self.since = snapshot.at
        self.held, self.begun = asked, True
        if property.eventually and holds(self.machine, property.eventually, snapshot):
            self.since = None
        return None

    @property
    def deadline(self) -> float:
        """Return when `eventually` must be true [s]; infinite while the property does not wait for it."""
        return inf if self.since is None else self.since + self.definition.within

    def elapse(self, now: float) -> Violation | None:
        """Return the violation if the deadline has passed at `now` [s], and stop waiting; else return None."""
        if self.since is None or nanoseconds(now) <= nanoseconds(self.since) + nanoseconds(self.definition.within):
            return None
        since, self.since = self.since, None
        return Violation(self.definition, late(self.definition, since))


def monitors(machine: MachineDefinition, properties: Iterable[Property]) -> list[PropertyMonitor]:
    """Return new monitors, one for each property, for a run that is about to begin."""
    return [PropertyMonitor(property, machine) for property in properties]


def holds(machine: MachineDefinition, condition: Expression, snapshot: Snapshot) -> bool:
    """Return the value of a condition in a snapshot; False if it can't be evaluated."""
    paths = _paths_by_alias(machine)
    names = snapshot.configuration | {paths[name] for name in snapshot.configuration if name in paths}
    scope = Scope(
        context=snapshot.context,
        state={"path": "", "language": snapshot.language, "place": snapshot.place},
        configuration=names.__contains__,
        at=snapshot.at,
        language=snapshot.language,
        phrases=machine.phrases,
        answers=machine.answers,
        epoch=snapshot.epoch,
        lists=machine.lists,
        machine=machine,
    )
    try:
        return compile_guard(condition.source)(scope)
    except ExpressionError:
        return False


def late(property: Property, since: float) -> str:
    """Return the message about a missed deadline; `since` [s] is when the wait began."""
    condition = property.eventually.shown if property.eventually else ""
    return f"`{condition}` did not become true within {property.within:g} s of {since:g} s"


def _broken(property: Property, at: float) -> Violation:
    condition = property.always.shown if property.always else ""
    return Violation(property, f"`{condition}` did not hold at {at:g} s")


def _paths_by_alias(machine: MachineDefinition) -> Mapping[str, str]:
    """Return the path of each state that has an alias; computed on first use and stored with the definition."""
    found: Mapping[str, str] | None = machine.__dict__.get("_paths_by_alias")
    if found is None:
        found = {state.alias: path for path, state in machine.states.items() if state.alias}
        object.__setattr__(machine, "_paths_by_alias", found)  # frozen, but all holders share it
    return found
