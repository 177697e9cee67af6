"""A behaviour's memory, translated from an old machine to a new one: context, timers, history."""

from collections.abc import Mapping
from itertools import combinations
from typing import Any, NamedTuple

from lumen.insight.migration.placing import Identity
from lumen.language.actions import Template
from lumen.language.machines import ForEach, MachineDefinition, StateKind
from lumen.language.nanoseconds import nanoseconds
from lumen.language.shared import SHARED
from lumen.statechart.chart import Chart, StateNode
from lumen.statechart.computed_timers import computed_delay
from lumen.statechart.execution_context import ExecutionContext
from lumen.statechart.history import History
from lumen.statechart.schedule_timers import schedule_timer
from lumen.statechart.state_sets import EntrySet, StateSets
from lumen.statechart.type_checks import fits, type_name
from lumen.statechart.values import Halted, Timer

_LIST = "lists."


def carried_round(old: MachineDefinition, new: MachineDefinition, loop: ForEach, value: Mapping[str, Any]) -> Any:
    """Return the value of a `for` key under the new machine: the same entries in their new form.

    Removed entries are skipped, except the current one. A list that is not in `lists` can't be compared, so the value
    stays the same.
    """
    name = loop.each.source.strip().removeprefix(_LIST)
    before, after = list(old.lists.get(name, ())), list(new.lists.get(name, ()))
    if not loop.each.source.strip().startswith(_LIST) or before == after:
        return value
    entry, left = value.get("entry"), value.get("left")
    kept = [now for one in left or () if (now := _now(one, before, after)) is not None]
    return {"entry": _now(entry, before, after) or entry, "left": kept}


def _now(entry: Any, before: list[Any], after: list[Any]) -> Any:
    """Return an old entry's form in the new list: the entry itself if it is still there, else the new one at its index.

    The result is None if there is no new entry at that index.
    """
    if entry in after or entry not in before:
        return entry if entry in after else None
    place = before.index(entry)
    return after[place] if place < len(after) and after[place] not in before else None


class CarriedContext(NamedTuple):
    """The context under the new machine, and a sentence for each value that could not be kept."""

    context: Mapping[str, Any]
    notes: tuple[str, ...]


def carried_shared(new: Chart, values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the values that robots share; each key that still exists keeps its value if it has the key's type."""
    common = dict(new.definition.context[SHARED])
    for key in common.keys() & values.keys():
        if fits(changed := {**common, key: values[key]}, new.checks[SHARED]):
            common = changed
    return common


def context(old: Chart, new: Chart, values: Mapping[str, Any], identity: Identity) -> CarriedContext:
    """Return the new context: a key that still exists keeps its value if the type fits, else the initial value."""
    first, names = new.definition.context, identity.keys()
    kept = {key: values[was] for key, was in names.items() if was in values and fits(values[was], new.checks[key])}
    if new.definition.shared and isinstance(common := values.get(SHARED), Mapping):
        kept[SHARED] = carried_shared(new, common)
    for state in new.definition.states.values():
        if (loop := state.for_each) and loop.key in kept:
            kept[loop.key] = carried_round(old.definition, new.definition, loop, kept[loop.key])
    notes = [
        f"`{key}` starts again with its first value: it was a {type_name(values[was])} and is now {new.checks[key]}"
        for key, was in names.items()
        if was in values and key not in kept
    ]
    gone = values.keys() - names.values()
    notes += [
        f"`{key}` is forgotten" for key in values if key in gone and values[key] != old.definition.context.get(key)
    ]
    return CarriedContext({**first, **kept}, tuple(notes))


def halted(halted: Mapping[str, Halted], old: Chart, new: Chart) -> dict[str, Halted]:
    """Return the interrupted positions of each `do` whose actions are unchanged."""
    return {
        path: where
        for path, where in halted.items()
        if path in new.nodes and old.definition.states[path].do == new.definition.states[path].do
    }


def timers(
    timers: tuple[Timer, ...], kept: Mapping[StateNode, StateNode], context: ExecutionContext
) -> tuple[Timer, ...]:
    """Return the timers that continue with their deadlines, in their order, then new ones of `after` and `at`.

    If the delay of an `after` was changed, it counts from when the old timer was set. A computed delay is computed
    again, in the new machine's `context`, if it is new or its text was changed.
    """
    images = {node.path: image for node, image in kept.items()}
    going: dict[int, Timer] = {}
    fresh: list[Timer] = []
    for node, image in kept.items():
        pending = {i: t for i, t in enumerate(timers) if t.kind == "after" and t.state == node.path}
        were = _delays(node)
        for event, said, known in _afters(node, image):
            place = next((i for i, t in pending.items() if not known or were.get(t.event) == said), None)
            timer = None if place is None else pending.pop(place)
            if known:
                if place is not None and timer:
                    going[place] = timer._replace(id=event, event=event, state=image.path)
                continue
            delay = said if isinstance(said, int) else computed_delay(context, image, image.computed[event])
            if delay is None:
                continue
            if place is not None and timer:
                due = timer.due_ns - timer.delay_ns + delay
                going[place] = Timer(event, due, delay, event, None, image.path, "after")
            else:
                fresh.append(Timer(event, nanoseconds(context.at) + delay, delay, event, None, image.path, "after"))
        awaited = {node.schedules[t.event]: i for i, t in enumerate(timers) if t.kind == "at" and t.state == node.path}
        for event, schedule in image.schedules.items():
            if (place := awaited.pop(schedule, None)) is not None:
                going[place] = timers[place]._replace(id=event, event=event, state=image.path)
            elif made := schedule_timer(context, image, event):
                fresh.append(made)
    for i, timer in enumerate(timers):
        if timer.kind not in ("after", "at"):
            going[i] = timer._replace(state=images[timer.state].path) if timer.kind == "wait" else timer
    return (*(timer for _, timer in sorted(going.items())), *fresh)


def _delays(node: StateNode) -> dict[str, int | Template]:
    """Return the delays of a state's `after` by their events: [ns], or a template that computes them."""
    return {**dict(node.afters), **{event: after.delay for event, after in node.computed.items()}}


def _afters(node: StateNode, image: StateNode) -> list[tuple[str, int | Template, bool]]:
    """Return the events and delays of a new state's `after`, and whether each delay is unchanged; those come first."""
    before = list(_delays(node).values())
    found = []
    for event, delay in _delays(image).items():
        if known := delay in before:
            before.remove(delay)
        found.append((event, delay, known))
    return sorted(found, key=lambda row: not row[2])


def history(old: History, new: Chart, identity: Identity) -> dict[str, tuple[str, ...]]:
    """Return the content of each history state that still exists: its states, or the nearest surviving ones."""
    found = {}
    for path, remembered in old.items():
        name = identity.state(path)
        node = new.nodes[name] if name else None
        if node and node.kind is StateKind.HISTORY and (states := _recalled(node, remembered, new, identity)):
            found[node.path] = tuple(state.path for state in states)
    return found


def _recalled(history: StateNode, remembered: tuple[str, ...], new: Chart, identity: Identity) -> list[StateNode]:
    """Return the states that a history restores in the new chart, as if entered; empty if they exclude each other."""
    home = history.parent
    assert home is not None  # only the document has no parent
    assert history.state is not None  # only a state can be a history
    nodes = list(dict.fromkeys(node for path in remembered if (node := _nearest(path, home, new, identity))))
    if not nodes or not all(_together(*pair) for pair in combinations(nodes, 2)):
        return []
    entered = EntrySet()
    StateSets(new, {}).reach(nodes, entered)
    within = [node for node in entered if node.lies_below(home)]
    kept = [n for n in within if not n.children] if history.state.deep else [n for n in within if n.parent is home]
    return sorted(kept, key=lambda node: node.index)


def _nearest(path: str, home: StateNode, new: Chart, identity: Identity) -> StateNode | None:
    while path:
        found = new.nodes.get(identity.state(path) or "")
        if found and found.lies_below(home) and found.kind is not StateKind.HISTORY:
            return found
        path = path.rpartition(".")[0]
    return None


def _together(one: StateNode, other: StateNode) -> bool:
    """Return whether two states can be active simultaneously."""
    if one.lies_below(other) or other.lies_below(one):
        return True
    return next(a for a in one.ancestors if other.lies_below(a)).kind is StateKind.PARALLEL
