"""Everything that happens in the shipped stories has a cause, and everything else a reason."""

from collections import Counter

import pytest

import lumen
from lumen.errors import UsageError
from lumen.insight.explaining import RecordedStep, StepHistory
from lumen.insight.explaining.answers import why_not
from lumen.insight.explaining.chains import chain
from lumen.insight.explaining.effects import Effect
from lumen.insight.explaining.outlook import ways_out
from lumen.language.commands import Cancel

ENDS = {"person", "message", "start", "event"}


def played(story: str, project: str) -> list[RecordedStep]:
    with lumen.open(project, story=story) as exhibition:
        exhibition.run()
        return exhibition.history()


def check(story: str, tally: Counter[str], project: str = ".") -> None:
    steps = played(story, project)
    history = StepHistory(steps)
    for number, one in enumerate(steps):
        done = [Effect(number, "", command) for command in one.step.commands if not isinstance(command, Cancel)]
        for effect in (*done, *(Effect(number, "", state=name) for name in one.step.entered)):
            last = chain(history, effect)[-1]
            assert last.kind in ENDS
            assert last.kind != "event" or last.text == "the robot detected it"
            tally[f"end at a {last.kind}"] += 1
    for state in steps[-1].machine.states.values():
        try:
            reasons = why_not(steps, state.name).reasons if state.path else ()
        except UsageError:
            continue
        for reason in reasons:
            tally[f"{reason.because}{'' if reason.change else ' without a change'}"] += 1


@pytest.mark.slow
def test_a_visit_that_is_not_understood() -> None:
    tally = Counter[str]()
    check("not_understood", tally)
    assert tally["end at a person"] > 10
    assert tally["guard"]
    assert not tally["guard without a change"]


@pytest.mark.slow
def test_a_tour_of_which_no_author_wrote_the_guards() -> None:
    """In `for`, these stories wait for conditions in words, which are not expressions."""
    tally = Counter[str]()
    check("visit", tally, "examples/museum")
    assert tally["end at a person"] > 10
    assert tally["guard"]


def test_ways_out_of_a_for_are_told_in_its_words() -> None:
    told = set[str]()
    for one in played("visit", "examples/museum")[::5]:
        told |= {way.guard.text for way in ways_out(one.machine, one.step.snapshot, one.at) if way.guard}
    assert "there is a next exhibit" in told


@pytest.mark.soak
def test_all_of_them() -> None:
    tally = Counter[str]()
    for story in lumen.load(".").stories:
        check(story, tally)
    print("\n" + ", ".join(f"{count:,} {what}" for what, count in sorted(tally.items())))  # noqa: T201
    assert tally["guard without a change"] <= 0.05 * tally["guard"]
