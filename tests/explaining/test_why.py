"""`why` names the causes that matter: without them the event is absent, and without all others it still occurs."""

from collections import Counter

import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings

from lumen.insight.explaining import RecordedStep, StepHistory
from lumen.insight.explaining.chains import chain
from lumen.insight.explaining.dependence import needed
from lumen.insight.explaining.effects import Effect
from lumen.language.commands import Cancel
from lumen.language.events import Event
from lumen.statechart import Machine
from tests.explaining.running import Outcome, inputs, live, outcomes, timed
from tests.statechart.oracle.generating import Data, machine_data

PATIENT = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


def effects(history: StepHistory) -> list[Effect]:
    """Return the last six effects: the last state that each step entered, and its last command."""
    found = []
    for number, one in enumerate(history.steps):
        if not one.before:
            continue
        found += [Effect(number, "", state=name) for name in one.step.entered[-1:]]
        found += [Effect(number, "", c) for c in one.step.commands[-1:] if not isinstance(c, Cancel)]
    return found[-6:]


def last(events: list[Event]) -> float:
    """Return the end of the observation, 1.5 s after the last event [s]."""
    return events[-1].at + 1.5


def all_of(steps: list[RecordedStep]) -> set[Outcome]:
    return {outcome for one in steps for outcome in outcomes(one)}


def check(data: Data, events: list[Event], tally: Counter[str]) -> None:
    """Leave out each event in turn, and compare the outcome with the explanation."""
    machine = Machine.from_dict(data)
    history = StepHistory(live(machine, events, last(events)))
    without = {
        id(event): all_of(live(machine, [e for e in events if e is not event], last(events))) for event in events
    }
    for effect in effects(history):
        links = chain(history, effect)
        assert links
        assert [link.number for link in links] == sorted((link.number for link in links), reverse=True)
        cause = history.steps[links[-1].number].step.event
        wanted = next(o for o in outcomes(history.steps[effect.number]) if not effect.state or o.what == effect.state)
        if effect.command:
            wanted = outcomes(history.steps[effect.number])[-1]
        named = {id(history.steps[number].step.event) for number in needed(history, effect.number)}
        tally["outcomes"] += 1
        if cause is None:
            tally["that began with the start"] += 1
        elif not any(event is cause for event in events):
            tally[f"that end at {links[-1].kind}: {links[-1].text[:40]}"] += 1
        for event in events:
            if event is not cause and id(event) in named:
                continue
            came = wanted in without[id(event)]
            if event is cause:
                tally["gone without the cause"] += not came
                tally["there without the cause"] += came
            else:
                tally["there without what is not named"] += came
                tally["gone without what is not named"] += not came


@pytest.mark.slow
def test_a_few_machines() -> None:
    tally = counted(8)
    assert tally["gone without the cause"] > 5
    assert not tally["there without the cause"] + tally["gone without what is not named"]


@pytest.mark.soak
def test_a_thousand_machines() -> None:
    tally = counted(1_000)
    print("\n" + ", ".join(f"{count:,} {what}" for what, count in sorted(tally.items())))  # noqa: T201
    assert tally["there without the cause"] + tally["gone without what is not named"] <= tally["outcomes"] / 1_000


def counted(machines: int) -> Counter[str]:
    tally = Counter[str]()

    @seed(2015)
    @settings(PATIENT, max_examples=machines, database=None, phases=[Phase.generate])
    @given(machine_data(deeds=True), inputs)
    def everyone(data: Data, happenings: list[tuple[str, object]]) -> None:
        check(data, timed(happenings), tally)

    everyone()
    return tally
