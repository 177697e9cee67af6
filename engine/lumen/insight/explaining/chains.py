"""The chain of causes from an effect back to a person, a message, a sensor, a file or the start."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, TypeAlias

from lumen.insight.explaining.conditions import values
from lumen.insight.explaining.effects import Effect, Link, LinkKind, origin
from lumen.insight.explaining.hearing import heard_row
from lumen.insight.explaining.history import OPERATOR_GOTO, StepHistory, ended_timer, machine_within, sets_timer
from lumen.insight.explaining.tracing import Deed, TracedMicrostep
from lumen.insight.explaining.words import awaited, brought, of_command, of_event, of_transition, ordinal, prefix_of
from lumen.language.commands import Command, Start
from lumen.language.diagnostics import Place
from lumen.language.events import HELD, Event
from lumen.language.machines import MachineDefinition, Transition
from lumen.statechart.command_ids import CommandAnswer, answer_of, inner_id
from lumen.statechart.values import Timer

LinkWalk: TypeAlias = Iterator["Link | partial[LinkWalk]"]
"""Links, and at most one continuation at the end, because a chain can be longer than Python's stack allows."""

MAX_LINKS = 2_000
"""The number of links at which the search stops."""
SHOWN_FIRST, SHOWN_LAST = 60, 20
"""The numbers of links that are shown at each end of a long chain, because restarted timers make endless chains."""


def chain(history: StepHistory, effect: Effect) -> list[Link]:
    """Return the links from the effect to the cause; in a long chain one link replaces those in the middle."""
    found: list[Link] = []
    ways: list[partial[LinkWalk]] = [partial(Chain(history).of, effect)]
    while ways and len(found) < MAX_LINKS:
        for one in ways.pop()():
            if isinstance(one, Link):
                found.append(one)
            else:
                ways.append(one)
    if len(found) <= SHOWN_FIRST + SHOWN_LAST:
        return found
    left = found[SHOWN_FIRST:-SHOWN_LAST]
    between = replace(left[0], kind="activity", text=f"… {len(left)} more of this kind", place=None, id="", values={})
    return [*found[:SHOWN_FIRST], between, *found[-SHOWN_LAST:]]


class Chain:
    """The search from an effect back to its cause; each method yields links and the method that continues the search.

    Every link lies in an earlier step than the link before it, or earlier in the same step.
    """

    def __init__(self, history: StepHistory) -> None:
        self.history = history

    def of(self, effect: Effect) -> LinkWalk:
        """Yield the continuation that explains an effect."""
        if effect.command is not None:
            yield partial(self.command, effect.number, effect.command)
        else:
            *ids, name = effect.state.split("/")
            yield partial(self.doing, effect.number, "@".join(reversed(ids)), name)

    def command(self, number: int, command: Command) -> LinkWalk:
        """Yield a command, the action that issued it, and the search for the action's trigger."""
        deed = self.history.deed(number, command)
        text = of_command(command) + self._refusal(number, _id(command))
        if deed is None:
            yield self._link(number, "command", text, id=_id(command))
            yield partial(self.trigger, number, "")
            return
        place = self._place(number, deed.machine, deed.where)
        yield self._link(number, "command", text, place, _id(command))
        yield self._activity(number, deed)
        yield partial(self.because, number, deed)

    def because(self, number: int, deed: Deed) -> LinkWalk:
        """Yield the search for the trigger of an action."""
        if deed.block == "do" and deed.microstep:
            yield partial(self.doing, number, deed.owner, deed.machine.states[deed.state].name, deed.microstep)
        elif deed.microstep:
            yield partial(self.microstep, number, deed.microstep, deed)
        else:
            yield partial(self.trigger, number, deed.owner)

    def doing(self, number: int, owner: str, state: str, until: TracedMicrostep | None = None) -> LinkWalk:
        """Yield the search for the transition or event that, in that step, entered a state or continued its `do`."""
        entered = self.history.trace(number).entering(owner, state, until)
        if entered:
            yield partial(self.microstep, number, entered, state=state)
        else:
            yield partial(self.trigger, number, owner)

    def microstep(self, number: int, step: TracedMicrostep, deed: Deed | None = None, state: str = "") -> LinkWalk:
        """Yield the transition of a microstep that led to an action or a state, and the search for its event."""
        machine, owner = step.moment.machine.chart.definition, step.moment.owner
        taken = _responsible(machine, step, deed, state)
        if taken is None:
            yield partial(self._beginning, number, step)
            return
        node = step.moment.machine.chart.nodes[taken.source]
        text, place = of_transition(machine, taken, owner), self._place(number, machine, taken.where)
        scope = step.moment.scope_of(node)
        found = values(taken.guard, scope)
        if taken.hears:
            row = heard_row(machine, taken, scope)
            text, found = f"{text}: {row.why}" if row.why else text, {**row.caught, **found}
        yield self._link(number, "transition", text, place, values=found)
        if taken.event:
            yield partial(self.event, number, step.moment.event, owner)
            return
        steps = [one for one in self.history.trace(number).microsteps if one.moment.owner == owner]
        before = steps[: steps.index(step)]
        if before:
            yield partial(self.microstep, number, before[-1])
        elif step.moment.event:
            yield partial(self.event, number, step.moment.event, owner)
        else:
            yield partial(self.trigger, number, owner)

    def event(self, number: int, event: Event | None, owner: str) -> LinkWalk:
        """Yield the action that raised an event, or the search for its origin outside the behaviour."""
        deeds = self.history.trace(number).deeds
        raised = next((deed for deed in deeds if deed.what is event), None) if event else None
        if raised is None or event is None:
            yield partial(self.trigger, number, owner)
            return
        kind, _, what = event.name.partition(".")
        thing, _, name = what.partition(".")
        place = self._place(number, raised.machine, raised.where)
        if not raised.where and kind in ("done", "error") and thing == "do":
            yield self._link(
                number, "activity", f"the `do` of {prefix_of(owner)}{name} {_ended(kind)}", values=brought(event)
            )
            until = raised.microstep  # it has no microstep if the `do` has run since an earlier step
            go_on = partial(self.doing, number, owner, name, until)
            yield go_on if until else partial(self.trigger, number, owner)
        elif thing == "invoke" and not raised.where:
            yield self._link(number, "event", f"the behaviour {name} {_ended(kind)}", values=brought(event))
            inner = f"{name}@{owner}" if owner else name
            last = [one for one in self.history.trace(number).microsteps if one.moment.owner == inner]
            before = [one for one in last if one.transitions]
            yield partial(self.microstep, number, before[-1]) if before else partial(self.trigger, number, owner)
        else:
            yield self._link(number, "event", f"raised {of_event(event)}", place, values=brought(event))
            yield partial(self.because, number, raised)

    def trigger(self, number: int, owner: str) -> LinkWalk:
        """Yield the input from outside that caused a step, and the cause of that input."""
        one = self.history.steps[number]
        event = one.step.event
        if event is None:
            reload = one.is_reload
            text = "the files were saved and reloaded during the run" if reload else f"{one.machine.id} begins"
            yield self._link(number, "file" if reload else "start", text)
        elif event.name == OPERATOR_GOTO:
            by = event.data.get("by", "somebody") if isinstance(event.data, dict) else "somebody"
            yield self._link(
                number,
                "person",
                f"{by} moved the behaviour to {event.data['state']} with `lumen goto`",
                values=brought(event),
            )
        elif timer := ended_timer(one.before, event):
            yield partial(self.timer, number, event, timer)
        elif not event.sendid and (answer := answer_of(event)):
            values = brought(event) if answer.kind == "answer" else {}
            yield self._link(number, "event", _answered(answer), id=answer.id, values=values)
            asked = [n for n in self.history.started.get(answer.id, ()) if n < number]
            if asked:
                command = next(c for c in self.history.steps[asked[-1]].step.commands if _id(c) == answer.id)
                yield partial(self.command, asked[-1], command)
        else:
            yield self._link(number, "event", of_event(event), values=brought(event))
            if found := origin(one, event):
                yield self._link(number, found.kind, found.text, id=found.id, values=found.values)

    def timer(self, number: int, event: Event, timer: Timer) -> LinkWalk:
        """Yield the end of a timer, and the search for the action or state that set it."""
        id, owner = inner_id(event.sendid)
        machine = machine_within(self.history.steps[number], owner)
        text, place = f"{event.name}, {timer.delay:g} s after it was sent", None
        if timer.kind != "send":
            state = machine.states[timer.state]
            name = prefix_of(owner) + (state.name or machine.id)
            waited = next((t for t in state.transitions if t.timed and t.event == timer.event), None)
            text = f"{awaited(waited)} in {name}" if waited else f"wait of {timer.delay:g} s in {name}"
            place = self._place(number, machine, waited.where if waited else (*state.where, "do"))
        yield self._link(number, "timer", text, place, event.sendid, {"seconds": timer.delay})
        when = next(
            (n for n in reversed(range(number)) if sets_timer(self.history.steps[n], event.sendid, timer)), None
        )
        if when is None:
            return
        sent = next((d for d in self.history.trace(when).deeds if (d.owner, d.what) == (owner, id)), None)
        if sent:
            place = self._place(when, sent.machine, sent.where)
            yield self._link(when, "activity", f"sends {event.name} after {timer.delay:g} s", place, event.sendid)
            yield partial(self.because, when, sent)
        elif timer.kind != "send":
            yield partial(self.doing, when, owner, machine.states[timer.state].name)

    def _beginning(self, number: int, step: TracedMicrostep) -> LinkWalk:
        """Yield the search for the start of a machine; an invoked machine is started by its host's `invoke`."""
        owner = step.moment.owner
        if not owner:
            yield partial(self.trigger, number, owner)
            return
        id, _, around = owner.partition("@")
        host = machine_within(self.history.steps[number], around)
        states = [state for state in host.states.values() if any(invoke.id == id for invoke in state.invoke)]
        for state in states:
            entered = self.history.trace(number).entering(around, state.name, step)
            if entered or state is states[-1]:
                where = next(invoke.where for invoke in state.invoke if invoke.id == id)
                text = f"{prefix_of(around)}{state.name} invokes {id}"
                yield self._link(number, "activity", text, self._place(number, host, where))
                yield partial(self.doing, number, around, state.name, step)
                return

    def _activity(self, number: int, deed: Deed) -> Link:
        """Return the link with the position of an action: `2nd of 3 in the `do` of greet`."""
        state = deed.machine.states[deed.state]
        name = prefix_of(deed.owner) + (state.name or deed.machine.id)
        if not deed.block:
            return self._link(
                number,
                "activity",
                f"an action of a transition of {name}",
                self._place(number, deed.machine, deed.where),
            )
        steps = getattr(state, deed.block)
        nth = [i for i, placed in enumerate(steps, 1) if deed.where[: len(placed.where)] == placed.where]
        which = f"{ordinal(nth[0])} of {len(steps)} in" if nth and len(steps) > 1 else "in"
        place = self._place(number, deed.machine, (*state.where, deed.block))
        return self._link(number, "activity", f"{which} the `{deed.block}` of {name}", place)

    def _link(
        self,
        number: int,
        kind: LinkKind,
        text: str,
        place: Place | None = None,
        id: str = "",
        values: Any = None,
    ) -> Link:
        one = self.history.steps[number]
        return Link(kind, text, one.step.snapshot.epoch + one.at, place, id, values or {}, number)

    def _refusal(self, number: int, id: str) -> str:
        """Return the reason if a command was refused because the robot is held, as the end of a text; else empty."""
        for one in self.history.steps[number + 1 :] if id else ():
            answer = answer_of(one.step.event) if one.step.event and not one.step.event.sendid else None
            if answer and answer.id == id:
                return f" (refused: {answer.reason})" if answer.reason.endswith(HELD) else ""
        return ""

    def _place(self, number: int, machine: MachineDefinition, where: Any) -> Place | None:
        return self.history.steps[number].place(machine, where)


def _responsible(machine: MachineDefinition, step: TracedMicrostep, deed: Deed | None, state: str) -> Transition | None:
    """Return the transition that most likely ran an action or entered a state; None if the microstep has none."""
    taken = step.transitions
    if deed:
        within = [t for t in taken if not deed.block and deed.where[: len(t.where)] == t.where]
        if within:
            return within[0]
        state = machine.states[deed.state].name
    path = next((s.path for s in machine.states.values() if s.name == state), "")
    leads = [t for t in taken for p in t.targets if path and (_related(p, path))]
    return next(iter([*leads, *(t for t in taken if t.targets), *taken]), None)


def _related(one: str, other: str) -> bool:
    return one == other or one.startswith(f"{other}.") or other.startswith(f"{one}.") or not one


def _id(command: Command) -> str:
    return command.id if isinstance(command, Start) else ""


def _ended(kind: str) -> str:
    return "is done" if kind == "done" else "failed"


def _answered(answer: CommandAnswer) -> str:
    kind, id, reason, data = answer
    if kind == "answer":
        by = data.get("passage") or data.get("source") if isinstance(data, Mapping) else ""
        return f"{id} is answered" + (f" by {by}" if by else "")
    said = {
        "done": "is done",
        "error": "failed",
        "cancelled": "was cancelled",
        "lost": "was deleted from the robot's memory",
    }
    return f"{id} {said[kind]}" + (f": {reason}" if reason != kind else "")
