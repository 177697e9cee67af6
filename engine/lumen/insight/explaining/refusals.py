"""Why a transition was not taken: its state, its event or its guard prevented it; and a change that would help."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from lumen.errors import LumenError
from lumen.expressions import Scope, parse_expression
from lumen.insight.explaining.changes import ProposedChange, StepSituation
from lumen.insight.explaining.conditions import GuardPart, first_false
from lumen.insight.explaining.hearing import HeardRow, heard_row
from lumen.insight.explaining.history import OPERATOR_GOTO, StepHistory, within
from lumen.insight.explaining.searching import Happens, literals_in, smallest_change, taken
from lumen.insight.explaining.tracing import Moment
from lumen.insight.explaining.words import awaited, of_transition, prefix_of
from lumen.insight.exploration.samples import samples
from lumen.language.diagnostics import Place
from lumen.language.events import Event, robot_events
from lumen.language.machines import MachineDefinition, Transition
from lumen.statechart.chart import CompiledTransition
from lumen.statechart.direct_entry import entered_directly
from lumen.statechart.stepping import due
from lumen.statechart.values import Snapshot
from lumen.talk.hearing import said_in
from lumen.talk.sample_sentences import of_row

Because = Literal["inactive", "no-event", "preempted", "unheard", "guard"]
ORDER: tuple[Because, ...] = ("guard", "unheard", "preempted", "no-event", "inactive")
MAX_SAMPLES = 40
"""The maximum number of samples of an event's data that are tried."""


@dataclass(frozen=True, slots=True)
class Reason:
    """Why one way did not lead to the goal."""

    because: Because
    """The kind of reason."""
    text: str
    """The reason in words."""
    at: float
    """The time of the decision [s since 1970, in UTC]."""
    place: Place | None = None
    """The place in the files of the guard or transition; None if unknown."""
    false: GuardPart | None = None
    """The first part of the guard that was not true; None if the guard is not the reason."""
    change: ProposedChange | None = None
    """The smallest change found after which the goal would have happened; None if none was found.

    The change is proved by taking the step again.
    """
    note: str = ""
    """Why there is no change; empty if there is one."""
    number: int = -1
    """The number of the recorded step that decided against the goal, or of the last one."""

    def to_json(self) -> dict[str, Any]:
        """Return an entry of `reasons` in the output of `lumen why-not --format json`."""
        false = {"text": self.false.text, "values": dict(self.false.values)} if self.false else None
        return {
            "because": self.because,
            "text": self.text,
            "file": self.place.file if self.place else None,
            "line": self.place.line if self.place else None,
            "false": false,
            "change": dict(self.change) if self.change else None,
            "note": self.note,
        }


class TransitionRefusals:
    """Explains why single transitions were not taken in the steps from number `first` on.

    `goal` is the state that they should enter; empty if the question is about an action.
    """

    def __init__(self, history: StepHistory, first: int, goal: str = "") -> None:
        self.history, self.first, self.goal = history, first, goal

    def of(self, owner: str, machine: MachineDefinition, transition: Transition) -> Reason:
        """Return the nearest reason: the last decision about the transition, else the condition that it waits for."""
        for number in reversed(range(self.first, len(self.history.steps))):
            for moment in reversed(self.history.trace(number).moments):
                if moment.owner != owner or moment.machine.chart.definition is not machine:
                    continue
                found = next((t for group in moment.groups for t in group if t.definition is transition), None)
                if found and not self._was_taken(number, moment, transition):
                    return self._decided(number, moment, found)
        return self._waits(owner, machine, transition)

    def _was_taken(self, number: int, moment: Moment, transition: Transition) -> bool:
        steps = self.history.trace(number).microsteps
        return any(step.moment is moment and transition in step.transitions for step in steps)

    def _decided(self, number: int, moment: Moment, found: CompiledTransition) -> Reason:
        """Return the reason for an examined transition: its guard was false, or another transition was taken."""
        one, wanted, machine = self.history.steps[number], found.definition, moment.machine.chart.definition
        scope = moment.scope_of(found.source)
        false = first_false(wanted.guard, scope) if wanted.guard else None
        row = heard_row(machine, wanted, scope) if wanted.hears else None
        if row:
            false = _dropped(row, false, scope)
        rival = None if false else self._rival(number, moment, found)
        around = next((group for group in moment.groups if found in group), ())
        earlier = tuple(t.definition for t in around[: around.index(found)])
        rivals = (*earlier, *((rival,) if rival and rival not in earlier else ()))
        change = None
        if one.before is not None and one.is_decided:
            situation = StepSituation(one.before, one.step.event, moment.owner)
            happens = taken(one.machine, moment.owner, wanted, self.goal)
            change = smallest_change(moment, found.source, wanted, rivals, situation, happens)
        text = of_transition(machine, wanted, moment.owner)
        after = f"{text}; {moment.event.name} came" if moment.event else text
        at = one.step.snapshot.epoch + one.at
        if false:
            unheard = row is not None and row.fate != "guard"
            why = false.error if unheard else f"{false.text} was false" + (f" ({false.error})" if false.error else "")
            place = one.place(machine, wanted.guard.where if wanted.guard and not unheard else wanted.where)
            note = "" if change else _no_change(false)
            because: Because = "unheard" if unheard else "guard"
            return Reason(because, f"{after}, but {why}", at, place, false, change, note, number)
        place = one.place(machine, rival.where) if rival else None
        who = (
            f"{of_transition(machine, rival, moment.owner)} was taken instead"
            if rival
            else "another transition was taken instead"
        )
        if row and not rival:
            who = "a behaviour that this state invokes listens too"
        note = "" if change else "no other value of the event or the context was found that would select it"
        return Reason("preempted", f"{after}, {who}", at, place, None, change, note, number)

    def _rival(self, number: int, moment: Moment, found: CompiledTransition) -> Transition | None:
        """Return the transition that was taken instead, if possible one of the same candidates; else None."""
        taken_then = [t for s in self.history.trace(number).microsteps if s.moment is moment for t in s.transitions]
        group = next((group for group in moment.groups if found in group), ())
        own = [t.definition for t in group]
        return next((t for t in taken_then if t in own), next(iter(taken_then), None))

    def _waits(self, owner: str, machine: MachineDefinition, transition: Transition) -> Reason:
        """Return the reason for a transition that was not examined: its state is inactive, or no event came."""
        last = self.history.steps[-1]
        snapshot, inner = last.step.snapshot, within(last.step.snapshot, owner)
        source, text = machine.states[transition.source], of_transition(machine, transition, owner)
        place, at = last.place(machine, transition.where), last.step.snapshot.epoch + last.at
        name = prefix_of(owner) + (source.name or machine.id)
        if inner is None:
            return Reason(
                "inactive", f"{text}: {prefix_of(owner)[:-1]} is not running", at, place, note="it is not invoked"
            )
        happens = taken(last.machine, owner, transition, self.goal)
        if not source.path or source.name in inner.configuration:
            change = _coming(machine, transition, StepSituation(snapshot, None, owner), happens, owner)
            what = _awaited(inner, transition)
            note = "" if change else _no_event(transition)
            return Reason("no-event", f"{text}: {what}", at, place, change=change, note=note)
        change = None
        entered = None if owner else _standing_in(machine, snapshot, source.name, transition, self.goal)
        if entered is True:
            change = {"state": source.name}
        elif isinstance(entered, Snapshot):
            more = _coming(machine, transition, StepSituation(entered, None, owner), happens, owner)
            change = {"state": source.name, **more} if more else None
        note = "" if change else f"the behaviour must be in {name} first"
        return Reason("inactive", f"{text}: {name} was not active", at, place, change=change, note=note)


def _coming(
    machine: MachineDefinition, wanted: Transition, standing: StepSituation, happens: Happens, owner: str
) -> ProposedChange | None:
    """Return the event with its data, or the time to wait, that would select the transition; None if none was found."""
    change: dict[str, Any]
    if wanted.timed:
        event = due(standing.snapshot)
        if event is None or not happens(standing._replace(event=event)):
            return None
        return {"wait": round(event.at - standing.snapshot.at, 3)}
    inner = within(standing.snapshot, owner)
    for name in _names(machine, wanted.event):
        schema = machine.events.get(name, robot_events().get(name))
        trees = [parse_expression(wanted.guard.source)] if wanted.guard else []
        context = inner.context if inner else {}
        tried: Iterable[Any] = samples(machine, schema, trees, context)
        if wanted.hears:
            literals = literals_in(wanted.guard)
            tried = ({"result": text} for text in of_row(machine, wanted.hears, context, literals))
        for _, data in zip(range(MAX_SAMPLES), tried, strict=False):
            change = {"event": name, **_fields(data)}
            if happens(standing.edited(change)):
                return change
    return None


def _dropped(row: HeardRow, false: GuardPart | None, scope: Scope) -> GuardPart | None:
    """Return the false part of a row of `hears`: its guard, or the search for its phrases; None if both are true."""
    if row.fate == "guard":
        return false
    if row.fate in ("taken", "better row"):
        return None
    return GuardPart(row.row.title, False, {"event.data.result": said_in(scope.event)}, row.why)


def _fields(data: Any) -> Mapping[str, Any]:
    if isinstance(data, Mapping):
        return {f"event.data.{key}": value for key, value in data.items()}
    return {} if data is None else {"event.data": data}


def _names(machine: MachineDefinition, descriptor: str) -> Iterator[str]:
    """Yield the names of events that match a descriptor and can come from outside; none if the engine raises them."""
    if descriptor.startswith(("done.", "error.")) or not descriptor:
        return
    prefix = descriptor.removesuffix("*").removesuffix(".")
    known = [n for n in (*machine.events, *robot_events()) if not prefix or n == prefix or n.startswith(f"{prefix}.")]
    yield from ([prefix] if prefix and prefix not in known else [])
    yield from (known or ([] if prefix else ["anything"]))


def _standing_in(
    machine: MachineDefinition, snapshot: Snapshot, state: str, wanted: Transition, goal: str
) -> Snapshot | bool:
    """Return the snapshot after entering that state; True if that reaches the goal, False if it is impossible."""
    try:
        step = entered_directly(machine, snapshot, state, Event(OPERATOR_GOTO, {"state": state}, snapshot.at))
    except LumenError:
        return False
    if any(one is wanted for one in step.transitions) and (not goal or goal in step.entered):
        return True
    return step.snapshot if state in step.snapshot.configuration else False


def _awaited(inner: Snapshot, transition: Transition) -> str:
    if transition.timed:
        timer = next((t for t in inner.timers if t.event == transition.event and t.state == transition.source), None)
        return f"its timer ends in {timer.due - inner.at:.1f} s" if timer else "its timer is not running"
    if transition.event.startswith("done."):
        return "it is not done yet"
    if transition.event.startswith("error."):
        return "nothing failed"
    return f"no `{transition.event}` came" if transition.event else "nothing has happened since it became possible"


def _no_event(transition: Transition) -> str:
    if transition.timed:
        return "other timers end first, or its guard is false at that time"
    if transition.event.startswith(("done.", "error.")):
        return f"the behaviour itself causes its event: {awaited(transition)}"
    return "no data for that event was found that would select it"


def _no_change(false: GuardPart) -> str:
    changing = [text for text in false.values if text.startswith(("context.", "event.data", "heard."))]
    if not changing:
        return "it does not depend on the event's data or on the context"
    return f"no other value of {', '.join(changing)} was found that would have selected it"
