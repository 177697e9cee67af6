"""`why` names what matters: without the cause it did not happen, and without what is not named it did."""

from collections import Counter

import pytest
from hypothesis import HealthCheck, given, settings

from lumen.interpreters.explaining import StepHistory
from lumen.interpreters.explaining.chains import chain
from lumen.interpreters.explaining.dependence import needed
from lumen.interpreters.explaining.effects import Effect
from lumen.language.commands import Cancel
from lumen.language.events import Event
from lumen.statechart import Machine
from tests.explaining.running import inputs, live, outcomes, timed
from tests.statechart.oracle.generating import Data, machine_data

PATIENT = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


def effects(history: StepHistory) -> list[Effect]:
    """The last state that each step entered, and the last thing that it did."""
    found = []
    for number, one in enumerate(history.steps):
        if not one.before:
            continue
        found += [Effect(number, "", state=name) for name in one.step.entered[-1:]]
        found += [Effect(number, "", c) for c in one.step.commands[-1:] if not isinstance(c, Cancel)]
    return found[-6:]


def check(data: Data, events: list[Event], tally: Counter[str]) -> None:
    """Flip each input, and compare what comes of it with what was said."""
    machine = Machine.from_dict(data)
    history = StepHistory(live(machine, events))
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
        for event in events:
            if event is not cause and id(event) in named:
                continue
            other = live(machine, [e for e in events if e is not event], seconds=1.5 + 0.5 * (event is events[-1]))
            came = any(wanted in outcomes(one) for one in other)
            if event is cause:
                tally["gone without the cause"] += not came
                tally["there without the cause"] += came
            else:
                tally["there without what is not named"] += came
                tally["gone without what is not named"] += not came


@pytest.mark.soak
def test_a_thousand_machines() -> None:
    tally = Counter[str]()

    @settings(PATIENT, max_examples=1_000, database=None)
    @given(machine_data(deeds=True), inputs)
    def everyone(data: Data, happenings: list[tuple[str, object]]) -> None:
        check(data, timed(happenings), tally)

    everyone()
    print("\n" + ", ".join(f"{count:,} {what}" for what, count in sorted(tally.items())))  # noqa: T201
