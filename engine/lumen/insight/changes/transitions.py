"""The differences between the transitions of two versions of a state."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any

from lumen.expressions.readings import as_written
from lumen.insight.changes.actions import block_changes, paired
from lumen.insight.changes.change import Change, Risk, code, names, seconds
from lumen.language.actions import Expression, Template
from lumen.language.machines import State, Transition

_ROW = "on `hears "
"""The beginning of the trigger that belongs to a row of `hears`."""

PathMapping = Callable[[tuple[str, ...]], tuple[str, ...]]
StateNaming = Callable[[str], str]


def transition_changes(
    old: State, new: State, title: str, file: str, mapped: PathMapping, name: StateNaming
) -> Iterator[Change]:
    """Yield the changes, trigger by trigger; `mapped` converts old paths to new ones, `name` returns a state's name."""
    comparison = _TransitionComparison(title, file, name)
    before = _by_trigger([replace(t, targets=mapped(t.targets), source=new.path) for t in old.transitions])
    after = _by_trigger(list(new.transitions))
    fewer, more = [k for k in before if k not in after], [k for k in after if k not in before]
    for was in list(fewer):
        now = next((k for k in more if _moved(was, k) and _same(before[was], after[k])), None)
        if now:
            fewer.remove(was)
            more.remove(now)
            yield comparison.change(f"{title} {_moved(was, now)}")
    old_rows, new_rows = (
        [key for key in one if key.startswith(_ROW) and key in both] for one, both in ((before, after), (after, before))
    )
    if old_rows != new_rows:
        yield comparison.change(f"{title} tries its rows of `hears` in a different order")
    for trigger in (*before, *more):
        if trigger in fewer:
            yield from (comparison.gone(t, trigger) for t in before[trigger])
        elif trigger in after:
            yield from comparison.candidates(before.get(trigger, []), after[trigger], trigger)


class _TransitionComparison:
    def __init__(self, title: str, file: str, name: StateNaming) -> None:
        self.title, self.file, self.name = title, file, name

    def change(self, sentence: str) -> Change:
        return Change("transition", self.title, sentence, Risk.BEHAVIOR, self.file)

    def candidates(self, old: Sequence[Transition], new: Sequence[Transition], trigger: str) -> Iterator[Change]:
        before, after = ([replace(t, event="") for t in rows] for rows in (old, new))
        for one, other in paired(before, after, lambda t: (t.targets, t.guard)):
            if one is None and other is not None:
                yield self.change(f"{self.title} now {self.leads(other)} {trigger}{_if(other)}")
            elif one is not None and other is None:
                yield self.gone(one, trigger)
            elif one is not None and other is not None:
                yield from self.candidate(one, other, trigger)

    def candidate(self, old: Transition, new: Transition, trigger: str) -> Iterator[Change]:
        if old.targets != new.targets:
            yield self.change(f"{self.title} now {self.leads(new)} {trigger}{_if(new)}, not {self.to(old)}")
        elif old.guard != new.guard:
            condition = f"if {code(new.guard.shown)}" if new.guard else "without a condition"
            yield self.change(f"{self.title} now {self.leads(new)} {trigger} {condition}")
        if old.approve != new.approve:
            how = "now waits for approval" if old.approve is None else "now waits for approval in a different way"
            how = how if new.approve else "no longer waits for approval"
            yield self.change(f"{self.title} {how} {trigger}")
        if old.offer != new.offer:
            how = "now offers" if new.offer else "no longer offers"
            yield self.change(f"{self.title} {how} a language model its transition {trigger}")
        if old.reenter != new.reenter:
            how = "is now left and entered again" if new.reenter else "now stays active"
            yield self.change(f"{self.title} {how} {trigger}")
        yield from block_changes(old.actions, new.actions, self.title, f" {trigger}", self.file)

    def gone(self, transition: Transition, trigger: str) -> Change:
        how = f"goes to {self.to(transition)}" if transition.targets else "does anything"
        return self.change(f"{self.title} no longer {how} {trigger}{_if(transition)}")

    def leads(self, transition: Transition) -> str:
        return f"goes to {self.to(transition)}" if transition.targets else "stays in its state and performs actions"

    def to(self, transition: Transition) -> str:
        return names(self.name(path) for path in transition.targets) or "anywhere"


def _by_trigger(transitions: list[Transition]) -> dict[str, list[Transition]]:
    found: dict[str, list[Transition]] = {}
    for transition in transitions:
        row = _comparable(replace(transition, hears=None)) if transition.hears else transition
        found.setdefault(_trigger(transition), []).append(row)
    return found


def _comparable(value: Any) -> Any:
    """Return a value with its expressions as written.

    Compiled expressions contain the number of a row of `hears`, which changes with the rows before it.
    """
    match value:
        case Expression(source):
            return replace(value, source=as_written(source))
        case Template(text):
            return replace(value, text=as_written(text))
        case tuple():
            return tuple(map(_comparable, value))
        case Mapping():
            return {key: _comparable(one) for key, one in value.items()}
    if is_dataclass(value) and not isinstance(value, type):
        return replace(value, **{each.name: _comparable(getattr(value, each.name)) for each in fields(value)})
    return value


def _moved(was: str, now: str) -> str:
    """Return how a trigger changed, such as `waits 15 s, not 12 s`; empty unless both are delays or rows of `hears`."""
    for begin, verb, quote in (("after ", "waits", ""), (_ROW, "hears", "`")):
        if was.startswith(begin) and now.startswith(begin):
            return f"{verb} {quote}{now.removeprefix(begin)}, not {quote}{was.removeprefix(begin)}"
    return ""


def _trigger(transition: Transition) -> str:
    """Return when a transition is taken, in words that do not depend on the state's name."""
    event = transition.event
    if transition.hears:
        return f"on `{transition.hears.title}`"
    if isinstance(transition.delay, Template):
        return f"after {code(transition.delay.shown)}"
    if transition.delay is not None:
        return f"after {seconds(transition.delay)}"
    if transition.schedule:
        return f"at {transition.schedule.text}"
    if not event:
        return "at once"
    if transition.exact and event.startswith(("done.do.", "done.state.")):
        return "when it is done"
    if transition.exact and event.startswith("error.do."):
        return "when it fails"
    if transition.exact:
        return f"when `{event.split('.', 2)[2]}` {'ends' if event.startswith('done') else 'fails'}"
    return f"on `{event}`"


def _same(old: Sequence[Transition], new: Sequence[Transition]) -> bool:
    return [(t.targets, t.guard, t.actions, t.approve, t.offer) for t in old] == [
        (t.targets, t.guard, t.actions, t.approve, t.offer) for t in new
    ]


def _if(transition: Transition) -> str:
    return f" if {code(transition.guard.shown)}" if transition.guard else ""
