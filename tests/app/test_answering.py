"""Answers on a thread of its own: one that fails costs its question."""

from pathlib import Path
from typing import Any

import pytest

from lumen.bus.memory import MemoryBus
from lumen.insight.explaining import RecordedStep
from lumen.journal.journal_folder import JournalFolder
from lumen.journal.journal_writer import JournalWriter
from lumen.language.events import CLOCK_SET, Event
from lumen.language.iso_time import iso_time
from lumen.ports import Message
from lumen.run.answering import AnsweringThread, answer
from lumen.statechart import Machine, initial, step
from tests.waiting import until

DAY = 1_796_000_000.0
"""A date [s since 1970]."""


def test_a_fault_costs_the_question(tmp_path: Path) -> None:
    bus, answers = MemoryBus(), list[Any]()
    bus.subscribe("answers", lambda message: answers.append(message.body))
    thread = AnsweringThread(bus, list, JournalWriter(JournalFolder(tmp_path, 1.0, 1.0)))

    def fault() -> dict[str, Any]:
        raise ZeroDivisionError("ours")

    asked = Message("questions", {}, reply_to="answers")
    thread.answer(asked, fault)
    thread.answer(asked, lambda: {"well": True})
    until(lambda: len(answers) == 2)
    thread.close()
    bus.close()
    assert answers[0]["verdict"] == "refused"
    assert "ours" in answers[0]["reason"]
    assert answers[1] == {"well": True}


def test_a_question_at_the_time_of_an_entry_includes_its_step() -> None:
    """Pages and `lumen why` show times to the millisecond, and steps are between two of them."""
    machine = Machine.from_dict({"id": "m", "states": {"a": {"on": {"face": "b"}}, "b": {"entry": {"say": "Hello"}}}})
    first = RecordedStep(machine, None, initial(machine, epoch=1_796_000_000.0))
    for at in (1.5, 1.5004, 1.50099):
        steps = [
            first,
            RecordedStep(machine, first.step.snapshot, step(machine, first.step.snapshot, Event("face", at=at))),
        ]
        said = answer(steps, "why", "Hello", iso_time(1_796_000_000.0 + at))
        assert said["chain"]


def test_a_question_about_a_time_before_the_clock_was_set_is_about_the_steps_of_that_time() -> None:
    """The clock is set forward and back, as if the machine could not keep pace and its date was corrected then."""
    machine = Machine.from_dict(
        {"id": "m", "states": {"a": {"on": {"face": {"actions": {"say": "Hello {{ event.data }}"}}}}}}
    )
    day = DAY
    steps, dates = [RecordedStep(machine, None, initial(machine, epoch=day))], list[float]()
    for at, epoch in ((10.0, day), (20.0, day + 45.0), (30.0, day - 5.0)):
        for event in (
            Event(CLOCK_SET, {"epoch": epoch, "timezone": ""}, at, CLOCK_SET),
            Event("face", len(dates), at + 1.0),
        ):
            before = steps[-1].step.snapshot
            steps.append(RecordedStep(machine, before, step(machine, before, event)))
        dates.append(epoch + at + 1.0)
    assert dates == [day + 11.0, day + 66.0, day + 26.0]
    for number, date in enumerate(dates):
        said = answer(steps, "why", "Hello", iso_time(date))
        assert f"Hello {number}" in said["what"]


@pytest.mark.parametrize(
    ("told", "asked", "counted"),
    [
        # It sleeps for 14 hours: time of the exhibition stands still.
        ([(0.0, 0.0), (100.0, 0.0), (102.0, 50_400.0), (500.0, 50_400.0)], 18_000.0, 100.0),
        ([(0.0, 0.0), (100.0, 0.0), (102.0, 50_400.0), (500.0, 50_400.0)], 51_000.0, 500.0),
        # The clock was an hour ahead until it was set.
        ([(0.0, 0.0), (20.0, 0.0), (21.0, -3_600.0), (3_500.0, -3_600.0), (4_500.0, -3_600.0)], 300.0, 3_500.0),
        ([(0.0, 0.0), (20.0, 0.0), (21.0, -3_600.0), (3_500.0, -3_600.0), (4_500.0, -3_600.0)], 20.0, 20.0),
        ([(0.0, 0.0), (20.0, 0.0), (21.0, -3_600.0), (30.0, -3_600.0)], 10.0, 0.0),
    ],
)
def test_the_last_step_that_counts_is_that_of_the_time(
    told: list[tuple[float, float]], asked: float, counted: float
) -> None:
    """Each step has a time on the exhibition's clock [s] and the change of its date since the first step [s]."""
    machine = Machine.from_dict(
        {"id": "m", "states": {"a": {"on": {"face": {"actions": {"say": "Hello {{ event.data }}"}}}}}}
    )
    steps = [RecordedStep(machine, None, initial(machine, epoch=DAY))]
    for at, moved in told:
        for event in (Event(CLOCK_SET, {"epoch": DAY + moved, "timezone": ""}, at, CLOCK_SET), Event("face", at, at)):
            before = steps[-1].step.snapshot
            steps.append(RecordedStep(machine, before, step(machine, before, event)))
    assert f"Hello {counted:.0f}" in answer(steps, "why", "Hello", iso_time(DAY + asked))["what"]
