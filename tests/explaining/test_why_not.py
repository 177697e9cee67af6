"""`why_not` proposes changes that work: the event happens with the change; without a change it gives a reason."""

from collections import Counter
from contextlib import suppress

import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings

from lumen.errors import LumenError, UsageError
from lumen.insight.explaining import RecordedStep
from lumen.insight.explaining.answers import why_not
from lumen.insight.explaining.changes import StepSituation
from lumen.insight.explaining.refusals import Reason
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.statechart import Machine, Snapshot, due, step
from lumen.statechart.direct_entry import entered_directly
from tests.explaining.running import inputs, live, timed
from tests.statechart.oracle.generating import Data, machine_data

PATIENT = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
MOST = 4
"""The number of states of a machine to explain."""


def happens(machine: MachineDefinition, steps: list[RecordedStep], reason: Reason, state: str) -> bool:
    """Return whether the state is entered after the reason's proposed change."""
    assert reason.change
    one = steps[reason.number]
    decided = reason.because in ("guard", "preempted")
    snapshot: Snapshot = one.before if decided and one.before else one.step.snapshot
    event = one.step.event if decided else None
    if first := reason.change.get("state"):
        entered = entered_directly(machine, snapshot, first, Event("x", None, snapshot.at))
        if state in entered.entered and len(reason.change) == 1:
            return True
        snapshot = entered.snapshot
    situation = StepSituation(snapshot, event).edited(reason.change)
    happening = due(situation.snapshot) if "wait" in reason.change else situation.event
    assert happening
    return state in step(machine, situation.snapshot, happening).entered


def check(data: Data, events: list[Event], tally: Counter[str]) -> None:
    machine = Machine.from_dict(data)
    steps = live(machine, events, events[-1].at + 0.2)
    for state in [s.name for s in machine.states.values() if s.path and s.kind != "history"][:MOST]:
        with suppress(UsageError):
            for reason in why_not(steps, state).reasons if steps else ():
                tally[reason.because] += 1
                assert reason.change or reason.note
                if not reason.change:
                    tally[f"{reason.because} without a change"] += 1
                    continue
                with suppress(LumenError):
                    works = happens(machine, steps, reason, state)
                    tally["changes that work" if works else "changes that do not"] += 1


@pytest.mark.slow
def test_a_few_machines() -> None:
    tally = counted(10)
    assert tally["changes that work"] > 5
    assert not tally["changes that do not"]


@pytest.mark.soak
def test_a_thousand_machines() -> None:
    tally = counted(1_000)
    print("\n" + ", ".join(f"{count:,} {what}" for what, count in sorted(tally.items())))  # noqa: T201
    assert tally["changes that work"] >= 0.95 * (tally["changes that work"] + tally["changes that do not"])


def counted(machines: int) -> Counter[str]:
    tally = Counter[str]()

    @seed(2015)
    @settings(PATIENT, max_examples=machines, database=None, phases=[Phase.generate])
    @given(machine_data(deeds=True), inputs)
    def everyone(data: Data, happenings: list[tuple[str, object]]) -> None:
        check(data, timed(happenings), tally)

    everyone()
    return tally
