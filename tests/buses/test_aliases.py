"""Aliases of keys: a module of 2015 reaches the only robot, and no subscriber gets a message twice."""

from collections.abc import Iterator
from dataclasses import replace

import pytest

import lumen
from lumen.bus import Bus, aliases, connect
from lumen.bus.validated import ValidatedBus, by_key, validated
from lumen.language.causes import MessageOrigin
from lumen.language.projects import Project
from lumen.ports import Bus as AnyBus
from tests.waiting import Collector

OLD, NEW = "lumen.audio.speech.recognition", "lumen.NAO.audio.speech.recognition"
SAID = {"name": "", "result": "dance", "date": ""}
BEN = {"robot": "Ben", "parts": ["robot"], "session": "b", "state": "here", "host": "", "process": 1}


@pytest.fixture(scope="module")
def project() -> Project:
    return lumen.load()


@pytest.fixture
def stranger() -> Iterator[Bus]:
    """A bus for a module of 2015, which has no project."""
    bus = connect("memory://aliases")
    yield bus
    bus.close()


def ours(project: Project, **changes: object) -> ValidatedBus:
    return validated(connect("memory://aliases"), replace(project, **changes))  # type: ignore[arg-type]


def listening(bus: AnyBus, key: str) -> Collector:
    seen = Collector()
    bus.subscribe(key, seen)
    return seen


def test_a_module_of_2015_is_heard_and_hears(project: Project, stranger: Bus) -> None:
    robot = ours(project)
    heard, state = listening(robot, NEW), listening(stranger, "lumen.state")
    stranger.publish(OLD, SAID)
    robot.publish("lumen.NAO.state", {"robot": "NAO", "time": 1.0})
    assert [message.key for message in heard.messages] == [OLD]
    assert [message.body["time"] for message in state.messages] == [1.0]
    robot.close()


def test_who_listens_to_both_hears_once(project: Project, stranger: Bus) -> None:
    robot, ears = ours(project), ours(project)
    heard, both = listening(robot, NEW), listening(stranger, "lumen.#")
    ears.publish(NEW, SAID)
    assert [message.key for message in heard.messages] == [NEW]
    assert [message.key for message in both.messages] == [NEW, OLD]
    assert both.messages[1].id == both.messages[0].id + aliases.COPY
    for bus in (robot, ears):
        bus.close()


def test_a_message_that_says_its_cause_has_an_id_under_either(project: Project, stranger: Bus) -> None:
    robot, seen = ours(project), Collector()
    for key in ("lumen.NAO.state", "lumen.state"):
        stranger.subscribe(key, seen)
    for _ in range(2):
        robot.publish("lumen.NAO.state", {"robot": "NAO", "time": 1.0}, origin=MessageOrigin(cause="step 42"))
    ids = [message.id for message in seen.messages]
    assert len(set(ids)) == 4
    assert ids[1::2] == [f"{id}{aliases.COPY}" for id in ids[::2]]
    robot.close()


def test_a_body_that_does_not_fit_is_refused_under_either(project: Project, stranger: Bus) -> None:
    robot = ours(project)
    heard = listening(robot, NEW)
    for key in (OLD, NEW):
        stranger.publish(key, {"result": 3})
    assert heard.messages == []
    robot.close()


def test_while_another_robot_is_there_no_alias_is_used(
    project: Project, stranger: Bus, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = ours(project)
    heard, state = listening(robot, NEW), listening(stranger, "lumen.state")
    for _ in range(2):
        stranger.publish("lumen.Ben.presence", BEN)
    stranger.publish(OLD, SAID)
    robot.publish("lumen.NAO.state", {"robot": "NAO", "time": 1.0})
    assert heard.messages == state.messages == []
    assert [record.message.partition(":")[0] for record in caplog.records] == ["another robot, Ben, is on this bus"]
    monkeypatch.setattr(aliases, "AWAY_AFTER", -1.0)
    stranger.publish(OLD, SAID)
    assert len(heard.messages) == 1
    robot.close()


def test_a_robot_that_keys_without_a_robot_share_is_told_of(
    project: Project, stranger: Bus, caplog: pytest.LogCaptureFixture
) -> None:
    face = replace(project.routes["face"], key="lumen.visual.face.detection", alias="")
    robot = ours(project, routes={**project.routes, "face": face})
    stranger.publish("lumen.presence", BEN)
    assert "both robots receive the messages on `face`" in caplog.text
    robot.close()


@pytest.mark.parametrize(("said", "count"), [(True, 1), (False, 0)])
def test_lumen_yaml_may_decide(project: Project, stranger: Bus, said: bool, count: int) -> None:
    robot = ours(project, aliases=said)
    heard, state = listening(robot, NEW), listening(stranger, "lumen.state")
    stranger.publish("lumen.Ben.presence", BEN)
    stranger.publish(OLD, SAID)
    robot.publish("lumen.NAO.state", {"robot": "NAO", "time": 1.0})
    assert len(heard.messages) == len(state.messages) == count
    robot.close()


def test_a_reload_gives_and_takes_an_alias(project: Project, stranger: Bus) -> None:
    robot = ours(project)
    heard = listening(robot, NEW)
    robot.use(replace(project, aliases=False))
    stranger.publish(OLD, SAID)
    assert heard.messages == []
    other = replace(project.routes["heard"], alias="lumen.other.words")
    robot.use(replace(project, routes={**project.routes, "heard": other}))
    for key in (OLD, "lumen.other.words"):
        stranger.publish(key, SAID)
    assert [message.key for message in heard.messages] == ["lumen.other.words"]
    robot.close()


def test_who_listens_no_more_hears_under_neither(project: Project, stranger: Bus) -> None:
    robot, seen = ours(project), Collector()
    undo = robot.subscribe(NEW, seen)
    undo()
    undo()
    for key in (OLD, NEW):
        stranger.publish(key, SAID)
    assert seen.messages == []
    robot.close()


def test_every_key_of_2015_is_there_under_its_old_name(project: Project) -> None:
    keys = by_key(project)
    for words in (
        "presence", "state", "trouble", "audio.speech.recognition", "audio.gender.identification", "audio.wav.stream",
        "audio.get.wave", "audio.text.stream", "audio.text.to.speech", "visual.face.detection",
        "visual.face.recognition", "visual.face.tracking", "visual.human.detection", "visual.command",
    ):  # fmt: skip
        assert keys[f"lumen.{words}"] == keys[f"lumen.NAO.{words}"]


def test_a_crowd_of_robots_fills_neither_log_nor_memory_and_hides_nobody(
    project: Project, stranger: Bus, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = ours(project)
    for number in range(3 * aliases.MAX_ROBOTS):
        stranger.publish("lumen.presence", {**BEN, "robot": f"R{number}" + "x" * 1000})
    assert len(caplog.records) == 1
    for other in robot._aliases._others:
        robot._aliases._others[other] -= 2 * aliases.AWAY_AFTER
    assert robot._aliases.used
    stranger.publish("lumen.Ben.presence", BEN)
    assert not robot._aliases.used, "one that comes after a crowd is seen, too"
    assert len(robot._aliases._others) == aliases.MAX_ROBOTS
    robot.close()
