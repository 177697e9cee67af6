"""The two questions about a history: `why` and `why_not`."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from lumen.errors import UsageError
from lumen.insight.explaining.chains import chain
from lumen.insight.explaining.dependence import directly_needed
from lumen.insight.explaining.effects import Link, effect
from lumen.insight.explaining.history import RecordedStep, StepHistory
from lumen.insight.explaining.names import KnownNames, state_named
from lumen.insight.explaining.refusals import ORDER, Reason, TransitionRefusals
from lumen.insight.explaining.ways import deeds, unreached, ways
from lumen.insight.explaining.words import of_event
from lumen.language.iso_time import iso_time
from lumen.statechart.nesting import active_names

LOOKED_BACK = 60.0
"""The period before the moment in question that `why_not` searches for decisions [s]."""


@dataclass(frozen=True, slots=True)
class WhyAnswer:
    """The causes of one effect, which `lumen why` prints."""

    what: str
    """The effect in words."""
    at: float
    """The time of the effect [s since 1970, in UTC]."""
    links: tuple[Link, ...]
    """The chain of causes: the effect first, its cause last."""
    needs: tuple[Link, ...] = ()
    """Earlier steps, besides those of the chain, without which the effect would not have happened.

    They entered the states that were active, or set the values that were read. Only these steps, and those that they
    need in turn, made a difference.
    """

    def to_json(self) -> dict[str, Any]:
        """Return the object that `lumen why --format json` prints."""
        chain, needs = ([link.to_json() for link in links] for links in (self.links, self.needs))
        return {"what": self.what, "at": iso_time(self.at), "chain": chain, "needs": needs}


@dataclass(frozen=True, slots=True)
class WhyNotAnswer:
    """Why something did not happen; the reason nearest to success comes first."""

    what: str
    at: float
    """The time up to which the subject of the question did not happen [s since 1970, in UTC]."""
    reasons: tuple[Reason, ...]

    def to_json(self) -> dict[str, Any]:
        """Return the object that `lumen why-not --format json` prints."""
        return {"what": self.what, "at": iso_time(self.at), "reasons": [reason.to_json() for reason in self.reasons]}


def why(steps: Iterable[RecordedStep], what: str = "", until: float | None = None) -> WhyAnswer:
    """Return why `what` last happened up to `until` [s, on the exhibition's clock]; None means the end of the steps.

    `what` is a text that was said (or some of its words), a state, a motion, the id of a command, or empty for the last
    thing that happened. Raises UsageError, with a hint, if `what` did not happen.
    """
    history = _history(steps, until)
    found = effect(history, what)
    links = tuple(chain(history, found))
    one = history.steps[found.number]
    return WhyAnswer(found.what, one.step.snapshot.epoch + one.at, links, tuple(_needs(history, found.number, links)))


def _needs(history: StepHistory, number: int, links: tuple[Link, ...]) -> Iterator[Link]:
    """Yield a link for each needed step, newest first, except the first step and those that the chain names."""
    named = {link.number for link in links}
    for earlier in sorted(set(directly_needed(history, number)) - named - {0}, reverse=True):
        step = history.steps[earlier].step
        entered = f"entered {', '.join(step.entered)}" if step.entered else "changed the context"
        by = f": {of_event(step.event)}" if step.event else ""
        yield Link("event", f"{entered}{by}", step.snapshot.epoch + step.snapshot.at, number=earlier)


def why_not(
    steps: Iterable[RecordedStep], what: str, until: float | None = None, back: float = LOOKED_BACK
) -> WhyNotAnswer:
    """Return the reasons why a state, a motion or a text did not happen, one for each way that would have led to it.

    Decisions are searched for in the last `back` [s] before `until` [s, on the exhibition's clock]; None is the time of
    the last step. Raises UsageError, with a hint, if nothing is named `what`, if the journal has no steps from that
    time, or if the state is active then.
    """
    history = _history(steps, until)
    if not history.steps:
        raise UsageError("the journal has no entries from that time: choose another time with `--at`")
    last = history.steps[-1]
    end = last.at if until is None else until
    first = next((n for n, one in enumerate(history.steps) if one.at >= end - back), len(history.steps) - 1)
    machine, known = last.machine, KnownNames(last)
    state = state_named(machine, what)
    if state and state in active_names(last.step.snapshot):
        raise UsageError(f"the behaviour is in `{state}` at that time: run `lumen why {what}`")
    found = ways(machine, what)
    if not found and not state and not any(deeds(machine, what)):
        raise UsageError(_nothing_leads_there(known, what))
    refusals = TransitionRefusals(history, first, state)
    reasons = [*(refusals.of(w.owner, w.machine, w.transition) for w in found), *_in_activities(history, what, state)]
    reasons.sort(key=lambda reason: (ORDER.index(reason.because), -reason.at))
    return WhyNotAnswer(what, last.step.snapshot.epoch + end, tuple(reasons))


def _history(steps: Iterable[RecordedStep], until: float | None) -> StepHistory:
    return StepHistory([one for one in steps if until is None or one.at <= until])


def _in_activities(history: StepHistory, what: str, state: str) -> Iterator[Reason]:
    if not state:
        for deed in deeds(history.steps[-1].machine, what):
            if deed.block == "do" and (reason := unreached(history, deed)):
                yield reason


def _nothing_leads_there(known: KnownNames, what: str) -> str:
    if what in known.motions:
        return f"no behaviour plays `{what}`: add `play: {what}` to one"
    return f"there is no state, motion or text `{what}`: {known.near(what)}"
