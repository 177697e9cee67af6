"""The ways out of a behaviour's active states: whether each is open now, and why."""

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

from lumen.expressions import Scope
from lumen.expressions.scope import no_draw
from lumen.insight.explaining.conditions import awaits_event, parts, values
from lumen.insight.explaining.hearing import heard_row
from lumen.insight.explaining.words import of_transition, prefix_of, shown
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition, Transition
from lumen.statechart.chart import CompiledTransition
from lumen.statechart.command_ids import outer_id
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.plans import Configuration
from lumen.statechart.values import Snapshot, Timer


class GuardTruth(NamedTuple):
    """A guard and its result at this moment."""

    text: str
    """The guard as written."""
    holds: bool | None
    """The result of the guard; None if it depends on the event."""
    values: Mapping[str, Any]
    """The values that the guard reads, by their names in it."""


class WayOut(NamedTuple):
    """A transition of an active state."""

    owner: str
    """The ids under which its behaviour runs; empty for the outermost."""
    machine: MachineDefinition
    """The machine of that behaviour."""
    transition: Transition
    """The transition."""
    open: bool
    """False if no event can take the transition now."""
    guard: GuardTruth | None
    """The transition's guard at this moment; None without a guard."""
    why: str
    """The condition that prevents the transition or that it waits for, in words."""
    due: float | None = None
    """When the transition's timer ends, on the exhibition's clock [s]; None without a timer."""


class Running(NamedTuple):
    """A running behaviour."""

    owner: str
    """The ids under which the behaviour runs; empty for the outermost."""
    machine: MachineDefinition
    """The behaviour's machine."""
    snapshot: Snapshot
    """The behaviour's snapshot."""
    prefix: str = ""
    """The prefix of the names of the behaviour's states, such as `quiz/`."""
    host: str = ""
    """The path of the state that has invoked the behaviour; empty for the outermost."""


def running(machine: MachineDefinition, snapshot: Snapshot, owner: str = "", host: str = "") -> Iterator[Running]:
    """Yield a behaviour and all behaviours that run within it, each after its host."""
    yield Running(owner, machine, snapshot, prefix_of(owner), host)
    for id, child in snapshot.invoked.items():
        inner = machine.invoked[machine.invoked_behavior(child.state, id)]
        around = prefix_of(owner) + child.state
        yield from running(inner, child.snapshot, outer_id(id, owner) if owner else id, around)


def ways_out(machine: MachineDefinition, snapshot: Snapshot, at: float, event: Event | None = None) -> Iterator[WayOut]:
    """Yield every way out of the states that are active at `at` [s], innermost states first, invoked behaviours last.

    With an `event`, yield only transitions that match the event, evaluated with its data.
    """
    for one in running(machine, snapshot):
        yield from _out_of(one, snapshot, at, event)


def _out_of(one: Running, outermost: Snapshot, at: float, event: Event | None) -> Iterator[WayOut]:
    program = compiled(one.machine)
    configuration = program.planner.configuration(one.snapshot.configuration)
    if configuration.finished:
        return
    asked = _Asked(one, configuration, outermost, at, event)
    for transition, rival in _ranked(configuration, asked):
        if event is None or transition.matches(event.name):
            yield asked.way(transition, rival)


def _ranked(
    configuration: Configuration, asked: "_Asked"
) -> Iterator[tuple[CompiledTransition, CompiledTransition | None]]:
    """Yield each transition of the active states once, with the rival that is always taken instead, or None.

    A rival counts only if each active atomic state below the transition has one.
    """
    rivals: dict[CompiledTransition, CompiledTransition | None] = {}
    for leaf in configuration.leaves:
        sure: list[CompiledTransition] = []
        found = [t for node in (leaf, *leaf.ancestors) for t in node.transitions]
        for transition in sorted(found, key=lambda t: t.is_otherwise):
            rival = next((one for one in sure if _covers(one.definition, transition.definition)), None)
            if rivals.get(transition, rival) is not None or transition not in rivals:
                rivals[transition] = rival
            if asked.truth(transition) is True:
                sure.append(transition)
    yield from rivals.items()


def _covers(one: Transition, other: Transition) -> bool:
    """Return whether every event that selects `other` also selects `one`."""
    if one.timed or other.timed or not one.event or not other.event:
        return one.timed == other.timed and one.event == other.event and one.source == other.source
    prefix = one.event.removesuffix(".*")
    return one.event in ("*", other.event) or (not one.exact and other.event.startswith(f"{prefix}."))


class _Asked:
    """The evaluation of one running behaviour's transitions; each guard is evaluated once."""

    def __init__(
        self, one: Running, configuration: Configuration, outermost: Snapshot, at: float, event: Event | None
    ) -> None:
        self._one, self._at, self._brought = one, at, event
        chart = compiled(one.machine).chart
        self._timers = {(t.state, t.event): t for t in one.snapshot.timers if t.kind in ("after", "at")}
        self._view = (outermost.language, outermost.place)
        seen = {"name": event.name, "data": event.data} if event else None
        self._scope = Scope(
            one.snapshot.context, seen, chart.root.view(*self._view), configuration.known.__contains__, at,
            outermost.language, one.machine.phrases, one.machine.answers, outermost.epoch, outermost.timezone,
            one.machine.lists, no_draw, one.machine,
        )  # fmt: skip
        self._known: dict[CompiledTransition, tuple[GuardTruth | None, str]] = {}

    def truth(self, transition: CompiledTransition) -> bool | None:
        """Return whether a transition's guard holds; None if that depends on the event."""
        guard, why = self._guard(transition)
        hears = transition.definition.hears
        if hears and hears.way != "else" and not why:
            return None
        return not why and (guard.holds if guard else True)

    def way(self, transition: CompiledTransition, rival: CompiledTransition | None) -> WayOut:
        wanted, (guard, why) = transition.definition, self._guard(transition)
        one, timer = self._one, self._timers.get((transition.source.path, transition.definition.event))
        stopped = wanted.timed and timer is None
        if rival and not why:
            why = f"{of_transition(one.machine, rival.definition, one.owner)} goes first"
        elif stopped and not why:
            why = "its timer is not running"
        closed = bool(why) or (not wanted.event and not wanted.timed)
        due = timer.due if timer else None
        return WayOut(
            one.owner, one.machine, wanted, not closed, guard, why or _waits(wanted, timer, guard, self._at), due
        )

    def _guard(self, transition: CompiledTransition) -> tuple[GuardTruth | None, str]:
        """Return the truth of a transition's guard, and why the transition can't be taken; empty if it can."""
        found = self._known.get(transition)
        if found is None:
            found = self._known[transition] = self._looked_at(transition)
        return found

    def _looked_at(self, transition: CompiledTransition) -> tuple[GuardTruth | None, str]:
        wanted, guard = transition.definition, transition.definition.guard
        scope = self._scope._replace(state=transition.source.view(*self._view))
        if wanted.hears and self._brought:
            row = heard_row(self._one.machine, wanted, scope)
            if row.fate not in ("taken", "guard"):
                return None, row.why
        if guard is None:
            return None, ""
        named = bool(wanted.event) and not wanted.timed
        later = _awaiting(guard.source) if named and not self._brought else ()
        looked = parts(guard, scope)
        open_parts = later if len(later) == len(looked) else (any(later),) * len(looked)
        false = [part for part, waits in zip(looked, open_parts, strict=True) if not waits and not part.holds]
        truth = False if false else None if any(open_parts) else True
        why = ""
        if false:
            seen = ", ".join(f"{name} is {shown(value)}" for name, value in false[0].values.items())
            why = f"{false[0].text} is false" + (f": {false[0].error or seen}" if false[0].error or seen else "")
        return GuardTruth(guard.shown, truth, values(guard, scope)), why


@lru_cache(maxsize=8192)
def _awaiting(source: str) -> tuple[bool, ...]:
    return awaits_event(source)


def _waits(wanted: Transition, timer: Timer | None, guard: GuardTruth | None, at: float) -> str:
    if timer:
        return f"in {max(0.0, timer.due - at):.0f} s"
    if wanted.exact:
        return "when that is done" if wanted.event.startswith("done.") else "when that fails"
    if not wanted.event:
        return "taken at the next event"
    when = f"when it {wanted.hears.title}" if wanted.hears else f"when {wanted.event} comes"
    if guard and guard.holds is None:
        return f"{when} and {guard.text}"
    return when if wanted.event != "*" else "when anything comes"
