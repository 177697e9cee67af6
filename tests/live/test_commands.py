"""The commands that an operator may send to a running exhibition, and its answers."""

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from lumen.bus import connect
from lumen.features.rabbitmq.consumer import Consumer
from lumen.language.commands import Say
from lumen.language.events import Event
from lumen.run.loop import Observer
from lumen.statechart import Step
from lumen.statechart.direct_entry import entered_directly
from tests.live.conftest import PATIENT, wait_for_visitors
from tests.live.shows import Live
from tests.rabbitmq import RabbitMQ

SORRY, PARDON = 'en: "I am sorry, I did not understand that."', 'en: "Come again, please?"'
WAVE = "                - {play: goodbye}\n"


class Ears(Observer):
    """Keeps the names of the events that the behaviour hears."""

    def __init__(self) -> None:
        self.heard: list[str] = []

    def stepped(self, step: Step) -> None:
        self.heard.append(step.event.name if step.event else "")


def leave(live: Live) -> None:
    """Let the visitor leave, and the visit end."""
    loop = live.show.loop
    assert live.show.visitor
    live.show.visitor.leave()
    over = Event("operator.goto", None, loop.clock.now())
    loop.take(entered_directly(loop.project.machine, loop.runtime.snapshot, "idle", over))


@pytest.fixture
def manual(copy: Path) -> Iterator[Live]:
    one = Live(copy, "manual")
    yield one
    one.close()


@pytest.mark.slow
def test_a_saved_text_is_in_force_told_and_journaled(live: Live) -> None:
    before = live.show.loop.project.hash
    live.edit(SORRY, PARDON)
    live.until_told("the saved files are active")
    told = live.status.bodies[-1]
    after = live.show.loop.project.hash
    assert (told["verdict"], told["who"], told["before"], told["after"]) == ("applied", "files", before, after)
    assert told["risk"] == "cosmetic"
    [entry] = live.records.journal.entries()
    assert (entry["verdict"], entry["before"], entry["after"]) == ("applied", before, after)
    assert set(entry["took"]) == {"loading", "stories", "applying", "waiting"}


@pytest.mark.slow
def test_by_hand_it_is_staged_until_somebody_applies_it(manual: Live) -> None:
    before = manual.show.loop.project
    manual.edit(SORRY, PARDON)
    manual.until_told("staged: ")
    assert manual.show.loop.project is before
    assert manual.ask("status")["staged"]
    assert manual.ask("apply")["verdict"] == "applied"
    assert manual.show.loop.project.hash != before.hash
    assert manual.ask("apply")["verdict"] == "refused"


@pytest.mark.slow
def test_what_is_staged_is_tried_for_one_visitor_and_waits_again(manual: Live) -> None:
    before = manual.show.loop.project.hash
    assert manual.ask("try")["verdict"] == manual.ask("refuse")["verdict"] == "refused"
    manual.edit(SORRY, PARDON)
    manual.until_told("staged: ")
    answer = manual.ask("try")
    assert (answer["verdict"], answer["reason"].split(":")[0]) == ("applied", "for one visitor")
    tried = manual.show.loop.project.hash
    assert tried != before
    manual.live(30.0)  # no visitor has come: the files are still on trial
    assert manual.show.loop.project.hash == tried
    manual.greet()
    assert manual.show.loop.project.hash == tried
    leave(manual)
    manual.until(lambda: manual.show.loop.project.hash == before)
    assert "the visit for which these files were tried is over" in manual.transcript
    assert manual.ask("status")["staged"]
    assert manual.ask("apply")["verdict"] == "applied"
    assert manual.show.loop.project.hash == tried
    manual.greet()
    leave(manual)
    manual.live(5.0)
    assert manual.show.loop.project.hash == tried


@pytest.mark.slow
def test_what_is_tried_is_kept_during_the_trial(manual: Live) -> None:
    before = manual.show.loop.project.hash
    manual.edit(SORRY, PARDON)
    manual.until_told("staged: ")
    assert manual.ask("try")["verdict"] == "applied"
    tried = manual.show.loop.project.hash
    manual.greet()
    assert manual.ask("status")["trial"] is True
    kept = manual.ask("apply")
    assert (kept["verdict"], kept["reason"]) == ("applied", "the files that were tried for one visitor stay active")
    assert "trial" not in manual.ask("status")
    leave(manual)
    manual.live(5.0)
    assert manual.show.loop.project.hash == tried != before
    assert manual.ask("apply")["verdict"] == "refused"  # there is no trial any more
    assert manual.ask("rollback")["verdict"] == "applied"
    assert manual.show.loop.project.hash == before


@pytest.mark.slow
def test_what_is_staged_can_be_refused(manual: Live) -> None:
    before = manual.show.loop.project
    manual.edit(SORRY, PARDON)
    manual.until_told("staged: ")
    answer = manual.ask("refuse")
    assert (answer["verdict"], answer["reason"]) == ("refused", "a person refused these files")
    assert manual.show.loop.project is before
    assert not manual.ask("status")["staged"]
    assert "nothing staged" in manual.ask("apply")["reason"]


@pytest.mark.slow
def test_a_rollback_brings_back_what_ran_before_and_stays(live: Live) -> None:
    before = live.show.loop.project.hash
    assert "nothing to go back to" in live.ask("rollback")["reason"]
    live.edit(SORRY, PARDON)
    live.until_told("are active")
    assert live.ask("rollback")["verdict"] == "applied"
    assert "the previous files are active again" in live.transcript
    assert live.show.loop.project.hash == before
    live.live(5.0)
    assert live.show.loop.project.hash == before
    assert live.ask("reload")["verdict"] == "unchanged"
    assert live.show.loop.project.hash == before


@pytest.mark.slow
def test_a_dry_run_says_what_would_be_and_changes_nothing(manual: Live) -> None:
    before = manual.show.loop.project
    manual.edit(SORRY, PARDON)
    manual.until_told("staged: ")
    answer = manual.ask("dry-run")
    assert answer["verdict"] == "dry run"
    assert "they would be active at once" in answer["lines"][0]
    assert manual.show.loop.project is before


@pytest.mark.slow
def test_reload_answers_with_the_diagnostics(live: Live) -> None:
    live.edit('done.do.*: "#any_question"', 'done.do.*: "#any_questoin"')
    answer = live.ask("reload")
    assert answer["verdict"] == "refused"
    assert answer["diagnostics"][0]["code"] == "unknown-state"
    assert live.ask("status")["last"]["verdict"] == "refused"


def test_where_nothing_was_saved_it_says_so(live: Live) -> None:
    assert live.ask("reload")["verdict"] == "unchanged"


@pytest.mark.parametrize(
    "body", [None, 7, "reload", [], {}, {"command": 7}, {"command": "danse"}, {"command": "reload", "now": "yes"}]
)
def test_nonsense_is_answered_and_ends_nothing(live: Live, body: Any) -> None:
    bus = live.show.loop.bus
    bus.publish("lumen.config.command", body, reply_to="lumen.test.answer")
    bus.publish("lumen.config.command", body)
    live.until(lambda: live.answers.messages)
    assert live.answers.bodies[0]["verdict"] == "refused"
    assert live.ask("status")["verdict"] == "status"


def test_off_means_off(copy: Path) -> None:
    one = Live(copy, "off")
    one.edit(SORRY, PARDON)
    assert "--reload off" in one.ask("reload")["reason"]
    assert one.ask("status")["mode"] == "off"
    one.close()


@pytest.fixture
def waving(copy: Path) -> Iterator[Live]:
    """A show in which neither a motion nor the farewell ends by itself."""
    wait_for_visitors(copy, PATIENT, "30s")
    tour = copy / "behaviors" / "tour.yaml"
    tour.write_text(tour.read_text("utf-8").replace('12s: "#idle"', '2h: "#idle"'), "utf-8")
    one = Live(copy, behaves={"play": "hangs"})
    yield one
    one.close()


@pytest.mark.slow
def test_it_waits_for_what_the_robot_does_and_now_does_not(waving: Live) -> None:
    waving.greet()
    waving.until(lambda: "goodbye" in waving.states)
    waving.edit(WAVE, WAVE.replace("goodbye", "photo"))
    waving.until_told("waiting for `goodbye`")
    answer = waving.ask("reload", now=True)
    assert answer["verdict"] == "applied"
    assert waving.verdicts[-2:] == ["waiting", "applied"]


@pytest.mark.slow
def test_patience_ends(waving: Live) -> None:
    waving.edit("reload: {patience: 60s}", "reload: {patience: 10ms}", "lumen.yaml")
    waving.until_told("are active")
    waving.greet()
    waving.until(lambda: "goodbye" in waving.states)
    waving.edit(WAVE, WAVE.replace("goodbye", "photo"))
    waving.until_told("is still under way after 0.01 s")
    assert waving.ask("apply", now=True)["verdict"] == "applied"


def test_what_needs_a_restart_is_named(live: Live) -> None:
    live.edit("stage: {x: [-0.4, 0.4]", "stage: {x: [-0.3, 0.4]", "lumen.yaml")
    live.until_told("the saved files are good: the stage changed: it takes effect at the next start")
    assert live.transcript.count("the stage changed") == 1
    assert live.status.bodies[-1]["restart"]
    assert live.show.loop.project.stage
    assert live.show.loop.project.stage.x == (-0.4, 0.4)


def test_a_story_saved_with_the_files_is_played_and_refuses_them(live: Live) -> None:
    before = live.show.loop.project
    live.edit("steps:\n", "steps:\n  - expect: {state: dance, within: 2s}\n", "behaviors/stories/refuses.yaml")
    live.until_told("stories that fail with these files: `refuses`")
    assert "behaviors/stories/refuses.yaml:" in live.transcript
    assert live.show.loop.project is before


@pytest.mark.slow
def test_a_story_that_no_longer_holds_is_told_after_the_files_are_in_force(live: Live) -> None:
    refusal = 'no|done: "#offer"'
    live.edit(refusal, refusal.replace("offer", "how_are_you"))
    live.until_told("are active")
    live.until_told("the story `refuses` fails with these files")


@pytest.mark.process
@pytest.mark.slow
def test_the_same_in_another_process(copy: Path) -> None:
    one = Live(copy, apart=True)
    one.edit(SORRY, PARDON)
    one.until_told("are active")
    one.edit("steps:\n", "steps:\n  - expect: {state: dance, within: 2s}\n", "behaviors/stories/refuses.yaml")
    one.until_told("behaviors/stories/refuses.yaml:")
    one.edit('done.do.*: "#any_question"', 'done.do.*: "#any_questoin"')
    one.until_told("did you mean `#any_question`?")
    one.close()


def test_stop_is_heard_by_the_behaviour(live: Live) -> None:
    live.greet()
    assert live.ask("stop")["verdict"] == "stopped"
    live.until(lambda: "interrupted" in live.states)
    assert any(isinstance(command, Say) for _, command in live.robot.performed)


def test_the_same_on_a_broker_for_which_no_tick_waits(
    copy: Path, broker: RabbitMQ, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = Live(copy, url=broker.url)
    waiting: list[threading.Thread] = []
    usual = Consumer._await
    monkeypatch.setattr(Consumer, "_await", lambda *given: (waiting.append(threading.current_thread()), usual(*given)))
    one.edit("routes:\n", "routes:\n  load: {key: lumen.load, direction: in, event: load}\n", "lumen.yaml")
    one.until_told("are active")
    assert waiting
    assert one.ask("status")["revision"] == 1
    one.edit("key: lumen.load,", "key: lumen.burden,", "lumen.yaml")
    one.until(lambda: one.verdicts.count("applied") == 2)
    assert one.ask("rollback")["verdict"] == "applied"
    assert threading.current_thread() not in waiting
    ears, other = Ears(), connect(broker.url)
    one.show.loop.observers.append(ears)
    one.until(lambda: other.publish("lumen.load", {}) or "load" in ears.heard)
    other.close()
    one.close()
