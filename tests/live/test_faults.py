"""A fault of ours leaves the old bundle running (test_steps has them all); a bundle that fails is taken back."""

from typing import Any

import pytest

from lumen.errors import BusError, LumenError
from lumen.insight.migration import MigrationDelay, MigrationPlan
from lumen.language.events import Event
from lumen.run import runtime
from tests.live.shows import Here, Live

SORRY, PARDON = 'en: "I am sorry, I did not understand that."', 'en: "Come again, please?"'


def fail(*_: Any, **__: Any) -> Any:
    raise ZeroDivisionError("a fault of ours")


@pytest.mark.slow
def test_a_fault_leaves_the_old_bundle_running(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    before = live.show.loop.project
    with monkeypatch.context() as patched:
        patched.setattr(Here, "load", fail)
        live.edit(SORRY, PARDON)
        live.until_told(
            "refused: an error in Lumen prevented the check of these files: ZeroDivisionError('a fault of ours')"
        )
    assert live.show.loop.project is before
    live.edit("en: Never mind.", "en: No problem.")
    live.until_told("the saved files are active")


@pytest.mark.slow
def test_a_bus_that_refuses_is_told(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    before, usual = live.show.loop.project, live.show.loop.inbox.listen

    def listen(project: Any) -> None:
        if project is not before:
            raise BusError("the broker says no")
        usual(project)

    monkeypatch.setattr(live.show.loop.inbox, "listen", listen)
    live.edit(SORRY, PARDON)
    live.until_told("refused: the bus refuses its routes: the broker says no")
    assert live.show.loop.project is before


@pytest.mark.slow
@pytest.mark.parametrize("error", [ZeroDivisionError("a fault"), LumenError("it never comes to rest")])
def test_a_bundle_that_fails_in_its_probation_is_taken_back_and_no_event_lost(
    live: Live, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    live.greet()
    before, usual = live.show.loop.project.hash, runtime.step
    live.edit(SORRY, PARDON)
    live.until_told("are active")
    bad = live.show.loop.project.machine

    def step(machine: Any, snapshot: Any, event: Event) -> Any:
        if machine is bad and event.name == "heard":
            raise error
        return usual(machine, snapshot, event)

    monkeypatch.setattr(runtime, "step", step)
    live.speak("my name is Ada", "how_are_you")
    assert live.show.loop.runtime.snapshot.context["visitor"] == "Ada"
    assert live.show.loop.project.hash == before
    assert f"the new files failed: {error}: back to the previous files" in live.transcript
    assert live.verdicts[-1] == "rolled back"


@pytest.mark.slow
def test_after_its_probation_a_bundle_is_on_its_own(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    live.greet()
    live.edit(SORRY, PARDON)
    live.until_told("are active")
    live.live(11.0)
    after = live.show.loop.project.hash
    assert live.records.keeper
    assert live.records.keeper.good() == after
    monkeypatch.setattr(runtime, "step", lambda *_: (_ for _ in ()).throw(LumenError("it never comes to rest")))
    live.show.loop.happen(Event("stop", {}))
    live.live(0.1)
    assert live.show.loop.project.hash == after


@pytest.mark.slow
def test_what_performs_may_fail_too(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    before = live.show.loop.project.hash
    live.edit(SORRY, PARDON)
    live.until_told("are active")
    usual = live.show.loop.performer.perform

    def perform(project: Any, *rest: Any) -> None:
        if project.hash != before:
            fail()
        usual(project, *rest)

    monkeypatch.setattr(live.show.loop.performer, "perform", perform)
    live.greet()
    assert live.show.loop.project.hash == before


@pytest.mark.slow
def test_where_there_is_no_way_back_it_begins_anew(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    live.greet()
    live.speak("my name is Ada", "how_are_you")
    live.edit(SORRY, PARDON)
    live.until_told("are active")
    monkeypatch.setattr(live.show.behavior, "plan", lambda *_, **__: MigrationDelay("no way", "how_are_you"))
    commands = live.show.loop._rescued(ZeroDivisionError("a fault"))
    assert commands
    assert "idle" in live.states
    assert isinstance(live.show.loop.plan(live.show.loop.project), MigrationPlan)
