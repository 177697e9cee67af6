"""Shared values of robots: one assigns, the other reads at once; no other process can change them."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.insight.migration import MigrationPlan, plan
from lumen.language.commands import Say, Start
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.lint import check
from lumen.ports import Bus
from lumen.run.exhibition import Exhibition
from lumen.run.house import House
from lumen.run.shared_board import RETELL_PERIOD
from tests.houses.test_several import opened
from tests.waiting import Collector

KEY = "lumen.stage.shared"
Hosted = tuple[House, dict[str, Exhibition]]


@pytest.fixture
def heard() -> Iterator[Collector]:
    bus = lumen.bus.connect("memory://two")
    told = Collector()
    bus.subscribe(KEY, told)
    yield told
    bus.close()


@pytest.fixture
def hosted(stage: Path, heard: Collector) -> Iterator[Hosted]:
    with opened(stage, story=None) as shows:
        house = House({name: show.services for name, show in shows.items()})
        house.start()
        house.run(0.1)
        yield house, shows
        house.close()


def common(show: Exhibition) -> Any:
    return show.context["shared"]


def test_what_one_assigns_the_other_knows_in_the_same_tick(stage: Path, hosted: Hosted) -> None:
    assert check(stage) == []
    house, shows = hosted
    steps: list[Any] = []
    shows["ben"].observe(steps.append)
    shows["ana"].loop.happen(Event("begin"))
    house.tick()
    assert shows["ben"].configuration == {"watching"}, "a change is reason enough for `always`"
    [step] = steps
    assert (step.event.name, step.event.data) == ("shared.changed", {"stage": "busy"})
    assert [command.command for command in step.commands if isinstance(command, Start)] == [
        Say("The stage is busy", "en")
    ]
    house.tick()
    assert common(shows["ana"]) == common(shows["ben"]) == {"stage": "busy", "seats": 2}
    why = shows["ben"].why("watching")["chain"]
    assert [link["kind"] for link in why] == ["transition", "event", "message"]
    assert why[0]["text"].endswith("as shared.stage == 'busy'")
    assert why[2]["text"] == f"a message on {KEY}, from ana"


def test_nobody_else_changes_it(hosted: Hosted) -> None:
    house, shows = hosted
    stranger: Bus = lumen.bus.connect("memory://two")
    for body in (
        {"from": "ben", "values": {"stage": "busy"}, "asks": False},
        {"from": "eve", "values": {"stage": "busy"}, "asks": False},
        {"from": "ana", "values": {"stage": 1}, "asks": False},
        {"from": "ana", "values": {"stge": "busy"}, "asks": False},
        {"from": "ana", "values": "busy", "asks": False},
        "busy",
    ):
        stranger.publish(KEY, body)
    stranger.publish("lumen.ben.event", {"event": "shared.changed", "data": {"stage": "busy"}, "from": "ana"})
    house.run(0.1)
    stranger.close()
    assert common(shows["ana"]) == common(shows["ben"]) == {"stage": "free", "seats": 3}


def test_it_is_told_again_now_and_then_and_to_whoever_asks(hosted: Hosted, heard: Collector) -> None:
    house, _ = hosted
    heard.messages.clear()
    house.run(2 * RETELL_PERIOD)
    assert sorted(body["from"] for body in heard.bodies) == ["ana", "ana", "ben", "ben"]
    heard.messages.clear()
    stranger: Bus = lumen.bus.connect("memory://two")
    stranger.publish(KEY, {"from": "cleo", "values": {}, "asks": True})
    house.run(0.1)
    stranger.close()
    assert {"from": "ana", "values": {"stage": "free"}, "asks": False} in heard.bodies
    assert {"from": "ben", "values": {"seats": 3}, "asks": False} in heard.bodies


def test_other_files_keep_what_is_known(stage: Path, hosted: Hosted) -> None:
    house, shows = hosted
    shows["ana"].loop.happen(Event("begin"))
    house.run(0.1)
    main = stage / "lumen.yaml"
    main.write_text(main.read_text("utf-8").replace("initial: 3}", "initial: 3}\n  late: {owner: ana, type: boolean}"))

    def planned(name: str) -> Any:
        before: Project = shows[name].project
        found = plan(before, lumen.load(stage, robot=name), shows[name].loop.runtime.snapshot, now=True)
        assert isinstance(found, MigrationPlan)
        return found.snapshot.context["shared"]

    assert planned("ana") == planned("ben") == {"stage": "busy", "seats": 2, "late": False}
