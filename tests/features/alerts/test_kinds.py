"""Each kind of alert is sent: by `lumen run`, and by the processes of `--only` that detect it."""

import shutil
from collections import namedtuple
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock, call

import pytest

import lumen
from lumen.cli.main import main
from lumen.errors import BusUnreachableError
from lumen.features.alerts import part as alerting
from lumen.features.alerts.part import AlertPart, room
from lumen.features.alerts.settings import KINDS, Alerts
from lumen.language.events import Event
from lumen.language.modules import ModuleSettings
from lumen.project.home import Home
from lumen.run import claiming, node, presence, services
from lumen.run.recovery.run_directory import RunDirectory
from tests.features.alerts.halls import Hall
from tests.features.alerts.servers import Web
from tests.saving import save
from tests.tables import for_each
from tests.waiting import until

Usage = namedtuple("Usage", "total used free")


@pytest.fixture
def hall(tmp_path: Path, web: Callable[..., Web], monkeypatch: pytest.MonkeyPatch) -> Iterator[Hall]:
    monkeypatch.setattr(alerting, "BROKER_PATIENCE", 0.1)
    one = Hall(tmp_path, web())
    yield one
    one.close()


def test_a_fall_that_it_can_not_get_up_from(hall: Hall) -> None:
    hall.whole(posture="fails")
    hall.happen("fallen")
    assert hall.told("fallen") == "it fell and can't get up"


def test_a_fall_that_nobody_does_anything_about(hall: Hall) -> None:
    hall.whole(posture="hangs")
    hall.happen("fallen")
    assert hall.told("fallen") == "it fell and has not got up"


def test_of_a_fall_that_it_gets_up_from_nobody_is_told(hall: Hall) -> None:
    shown = hall.whole()
    hall.happen("fallen")
    hall.until(lambda: "rises" in shown.configuration)
    hall.until(lambda: "idle" in shown.configuration)
    end = shown.now + 100.0
    hall.until(lambda: shown.now > end)
    hall.close()
    assert hall.web.bodies == []


def test_a_stop(hall: Hall) -> None:
    hall.whole().stop()
    assert hall.told("stopped") == "a person stopped it"


def test_a_robot_whose_connection_is_lost(hall: Hall) -> None:
    hall.whole()
    hall.happen("robot.lost", seconds=2.5)
    assert hall.told("lost") == "the robot no longer responds"
    hall.happen("robot.back", seconds=12.0)
    hall.until(lambda: len(hall.web.of("lost")) == 2)
    assert hall.web.of("lost")[1]["text"].endswith("the robot is back after 12 s")


@for_each(
    ("event", "told"),
    [
        ("mood.lost", ("lost", "the module mood no longer responds", "mood")),
        ("mood.found", ("lost", "the module mood is back", "mood.found")),
        ("mood.changed", None),
        ("pump.lost", None),
    ],
)
def test_a_module_of_ones_own_that_is_lost_and_found(event: str, told: tuple[str, str, str] | None) -> None:
    assert alerting.told_of_own(Event(event, {"seconds": 2, "reason": "a text of its own"}), ("mood",)) == told


def test_the_loss_of_a_module_of_ones_own_in_a_run(hall: Hall) -> None:
    shown = hall.whole()
    shown.services[AlertPart].use(
        replace(shown.project, modules={"mood": ModuleSettings(command=("python3", "mood.py"))})
    )
    hall.happen("mood.lost", seconds=2.0, reason="it ended")
    assert hall.told("lost") == "the module mood no longer responds"


def test_a_battery_and_motors(hall: Hall) -> None:
    hall.whole()
    hall.happen("battery.low", percentage=12)
    hall.happen("motors.hot", joint="LKneePitch", temperature=82.4)
    assert hall.told("battery") == "its battery is at 12 %"
    assert hall.told("hot") == "a motor is at 82 °C"


def test_a_broker_that_is_away_for_long(hall: Hall) -> None:
    hall.whole()
    hall.bus.away = True
    assert hall.told("broker") == "the message broker can't be reached"


def test_a_broker_that_is_short_of_memory(hall: Hall) -> None:
    hall.whole()
    hall.bus.blocked = "memory"
    assert hall.told("broker") == "the message broker is short of memory and accepts no messages"


def test_files_that_are_refused(hall: Hall) -> None:
    hall.whole()
    tour = hall.folder / "behaviors/tour.yaml"
    save(tour, tour.read_text().replace("onDone: idle", "onDone: nowhere"))
    assert hall.told("refused") == (
        "the saved files were refused: behaviors/tour.yaml:8:13 unknown-state; the exhibition continues unchanged"
    )


def test_a_start_on_the_last_good_files(hall: Hall) -> None:
    hall.whole()
    hall.close()
    tour = hall.folder / "behaviors/tour.yaml"
    tour.write_text(tour.read_text().replace("onDone: idle", "onDone: nowhere"))
    hall.whole(last_good=True)
    assert hall.told("refused").endswith("unknown-state; the last good files are active")


def test_a_run_that_ended_without_notice(hall: Hall) -> None:
    hall.whole()
    hall.until(lambda: (hall.folder / ".lumen/snapshot.json").exists())
    hall.close()
    hall.whole()
    assert hall.told("crashed").startswith("it ended unexpectedly, and continues after ")


def test_a_part_that_gave_up(hall: Hall) -> None:
    shown = hall.whole()
    for part in shown.node.parts:
        part.helpless("the thread `lumen-x` failed 5 times, at last on what Ani said")
    assert hall.told("crashed") == "a part of Lumen failed. The robot rests, because no one could have stopped it"


def test_a_disk_that_is_full(hall: Hall, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _: Usage(10**12, 10**12, 12_000_000))
    hall.whole()
    assert hall.told("disk") == "the disk is nearly full: 12 MB are left"
    hall.live(200)
    hall.close()
    assert len(hall.web.of("disk")) == 1, "it is told when it begins"


def test_a_disk_that_takes_nothing(hall: Hall, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Home, "write", lambda *_: "no space left on device")
    hall.whole()
    assert hall.told("disk") == "the snapshot of the behaviour can't be written: no space left on device"


def test_room_is_looked_for_where_there_is_no_folder_yet(tmp_path: Path) -> None:
    assert room(tmp_path / "not/there") == ""


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shorten the periods in which processes find each other, and detect that one is lost.

    A pause between two rounds that is longer than PRESENCE_PERIOD is not counted as silence.
    """
    monkeypatch.setattr(claiming, "CLAIM_DURATION", 0.05)
    monkeypatch.setattr(node, "CLAIM_DURATION", 0.05)
    monkeypatch.setattr(presence, "PRESENCE_PERIOD", 0.5)
    monkeypatch.setattr(presence, "LOST_AFTER", 1.5)
    monkeypatch.setattr(alerting, "BRAIN_PATIENCE", 0.2)


def apart(hall: Hall) -> tuple[node.Node, node.Node]:
    """Start robot and brain as separate nodes, and return them once each has found the other."""
    robot, brain = hall.part("robot"), hall.part("brain")
    hall.until(lambda: "idle" in _states(brain) and robot.presence and robot.presence.find("brain"))
    hall.live(5)
    return robot, brain


def _states(brain: node.Node) -> frozenset[str]:
    loop = next(part for part in brain.parts if part.name == "brain").behavior.loop  # type: ignore[attr-defined]
    return loop.runtime._snapshot.configuration if loop.runtime._snapshot else frozenset()


def origins(hall: Hall, kind: str) -> list[list[str]]:
    return [body["parts"] for body in hall.web.of(kind)]


@pytest.mark.usefixtures("quick")
def test_the_brains_process_tells_of_the_robot(hall: Hall) -> None:
    robot, _ = apart(hall)
    hall.happen("battery.low", percentage=9)
    assert hall.told("battery") == "its battery is at 9 %"
    hall.kill(robot)
    assert hall.told("lost") == "the robot no longer responds"
    assert origins(hall, "battery") == origins(hall, "lost") == [["brain"]]


@pytest.mark.usefixtures("quick")
def test_the_robots_process_tells_of_the_brain_and_of_what_it_notices_alone(hall: Hall) -> None:
    _, brain = apart(hall)
    hall.kill(brain)
    assert hall.told("lost") == "the brain no longer responds, and the robot rests"
    hall.happen("fallen")
    hall.happen("motors.hot", joint="LKneePitch", temperature=90.0)
    assert hall.told("fallen") == "it fell, and no brain is connected to get it up"
    assert hall.told("hot") == "a motor is at 90 °C"
    hall.nodes[0].interrupt()
    assert hall.told("stopped") == "a person stopped it"
    assert {tuple(body["parts"]) for body in hall.web.bodies} == {("robot",)}


def test_the_robots_process_tells_of_the_brain_once_and_that_it_is_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(alerting, "BRAIN_PATIENCE", -1.0)
    desk, others = Mock(), Mock(left=lambda part: False)
    others.find.side_effect = [True, True, False, False, True, True]
    with closing(AlertPart(desk, Mock(ability=lambda kind: None), tmp_path, ["robot"], others)) as part:
        for _ in range(6):
            part._look_for_brain()
    assert desk.call_args_list == [
        call("lost", "the brain no longer responds, and the robot rests", "brain"),
        call("lost", "the brain is back", "brain.back"),
    ]


@pytest.mark.usefixtures("quick")
def test_of_a_brain_that_ended_as_it_should_nobody_is_told(hall: Hall) -> None:
    robot, brain = apart(hall)
    hall.nodes.remove(brain)
    brain.close()
    hall.closing.remove(brain.close)
    hall.until(lambda: robot.presence and robot.presence.left("brain"))
    hall.live(50)
    assert hall.web.of("lost") == []


@pytest.mark.usefixtures("quick")
def test_the_processes_tell_of_the_broker_the_disk_and_the_files(hall: Hall, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda _: Usage(10**12, 10**12, 1_000_000))
    _, brain = apart(hall)
    hall.bus.away = True
    hall.until(lambda: len(hall.web.of("broker")) == 2)
    hall.until(lambda: len(hall.web.of("disk")) == 2)
    assert sorted(origins(hall, "broker")) == sorted(origins(hall, "disk")) == [["brain"], ["robot"]]
    tour = hall.folder / "behaviors/tour.yaml"
    tour.write_text(tour.read_text().replace("onDone: idle", "onDone: nowhere"))
    hall.bus.publish("lumen.config.command", {"command": "reload"})
    assert "unknown-state" in hall.told("refused")
    hall.bus.publish("lumen.config.command", {"command": "stop"})
    assert hall.told("stopped") == "a person stopped it"
    # The watcher and the command may both have read the file: then people are told twice, each time by the brain.
    assert {tuple(parts) for parts in origins(hall, "refused")} == {("brain",)}
    assert origins(hall, "stopped") == [["brain"]]
    assert brain.project.section(Alerts).to


@pytest.mark.usefixtures("quick")
def test_a_module_that_is_lost_and_a_process_without_robot_or_brain_that_says_nothing_of_others(hall: Hall) -> None:
    robot, _ = apart(hall)
    memory = hall.part("memory")
    hall.until(lambda: robot.presence and robot.presence.find("memory"))
    hall.live(10)
    hall.kill(memory)
    assert hall.told("lost") == "the memory no longer responds"
    assert origins(hall, "lost") == [["brain"]]


@pytest.mark.parametrize("only", [(), ("--only", "robot"), ("--only", "brain,motion")])
def test_a_start_that_is_refused(hall: Hall, only: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    tour = hall.folder / "behaviors/tour.yaml"
    tour.write_text(tour.read_text().replace("onDone: idle", "onDone: nowhere"))
    assert main(["run", str(hall.folder), "--robot", "recording", *only]) == 1
    [body] = hall.web.told("start")
    assert body["text"].endswith(
        "the project's files have errors, the first at behaviors/tour.yaml:8:13: unknown-state"
    )
    assert body["parts"] == (only[1].split(",") if only else ["robot", "brain"])
    capsys.readouterr()


def two_robots(hall: Hall) -> None:
    main_file = hall.folder / "lumen.yaml"
    robots = "robots: {ana: {model: tiny, at: {y: -0.4}}, ben: {model: tiny, at: {y: 0.4}}}"
    main_file.write_text(main_file.read_text().replace("robot: {name: TINY, model: tiny}", robots))


def test_a_start_of_several_robots_that_is_refused(hall: Hall, capsys: pytest.CaptureFixture[str]) -> None:
    two_robots(hall)
    tour = hall.folder / "behaviors/tour.yaml"
    tour.write_text(tour.read_text().replace("onDone: idle", "onDone: nowhere"))
    assert main(["run", str(hall.folder), "--robot", "recording", "--speed", "max"]) == 1
    [body] = hall.web.told("start")
    assert body["robot"] == "ana, ben"
    assert body["text"].endswith(
        "the project's files have errors, the first at behaviors/tour.yaml:8:13: unknown-state"
    )
    capsys.readouterr()


def test_one_robot_of_several_that_an_error_ends(
    hall: Hall, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    two_robots(hall)
    usual = node.Node.tick

    def tick(one: node.Node) -> float:
        if one.project.robot == "ana" and one.now > 0.5:
            raise BusUnreachableError("the broker closed the connection")
        return usual(one)

    monkeypatch.setattr(node.Node, "tick", tick)
    assert main(["run", str(hall.folder), "--robot", "recording", "--speed", "max", "--for", "1s"]) == 1
    said = capsys.readouterr().out
    assert "Ended with trouble: 0:01" in said
    assert "  ana: the broker closed the connection" in said
    [body] = hall.web.told("start")
    assert (body["robot"], body["parts"]) == ("ana", ["robot", "brain"])
    assert body["text"].endswith("it could not start or continue: the broker closed the connection")
    resumed = {}
    for name in ("ana", "ben"):
        directory = RunDirectory(hall.folder, name)
        resumed[name] = bool(directory.records.keeper and directory.records.keeper.kept())
        assert directory.records.died(lumen.load(hall.folder, robot=name).hash) == 0
        directory.close(forget=False)
    assert resumed == {"ana": True, "ben": False}, "ana continues from where it was"


@pytest.mark.slow
def test_a_start_without_a_broker_and_with_a_main_file_that_can_not_be_read(
    hall: Hall, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def connect(url: str, **_: object) -> None:
        raise BusUnreachableError(f"no broker listens at {url.rpartition('@')[2]}")

    with monkeypatch.context() as patch:
        patch.setattr(services, "connect", connect)
        url = "amqp://lumen:secret@127.0.0.1:1"
        assert main(["run", str(hall.folder), "--robot", "recording", "--bus", url]) == 2
    [body] = hall.web.told("start")
    assert body["text"].endswith("it could not start or continue: no broker listens at 127.0.0.1:1")
    (hall.folder / "lumen.yaml").write_text("alerts: [")
    assert main(["run", str(hall.folder), "--robot", "recording"]) == 1
    assert hall.web.told("start", 2)[1]["text"].endswith("the first at lumen.yaml:1:9: yaml-syntax")
    capsys.readouterr()


def test_a_fault_of_our_own_is_told_without_what_it_says(hall: Hall, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ZeroDivisionError("Ani said so")

    monkeypatch.setattr("lumen.cli.run.robot_of", fail)
    with pytest.raises(ZeroDivisionError):
        main(["run", str(hall.folder), "--robot", "recording"])
    assert hall.web.told("crashed")[0]["text"].endswith("it ended because of a fault in Lumen (ZeroDivisionError)")


def test_a_story_is_no_trouble_and_nobody_is_told_of_what_was_typed_wrong(
    hall: Hall, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise BusUnreachableError("no broker")

    assert main(["run", str(hall.folder), "--only", "robbot"]) == 2
    monkeypatch.setattr("lumen.run.run_start.startup_project", fail)
    assert main(["run", str(hall.folder), "--story", "x"]) == 2
    assert hall.web.bodies == []
    capsys.readouterr()


NAMED = [
    Event("motors.hot", {"joint": "Ani", "temperature": "Ani"}),
    Event("battery.low", {"percentage": "Ani"}),
    Event("robot.back", {"seconds": ["Ani"]}),
    Event("robot.lost", "Ani"),
    Event("Ani.lost", {"seconds": 1.0}),
    Event("battery.low", {"percentage": float("nan")}),
    Event("motors.hot", {"temperature": 10**400}),
]


@pytest.mark.parametrize("event", NAMED, ids=range(len(NAMED)))
def test_nothing_that_somebody_else_says_is_told(event: Event) -> None:
    assert "Ani" not in str(alerting.told_of(event))


def test_each_kind_is_shown_here() -> None:
    text = Path(__file__).read_text("utf-8")
    assert [kind for kind in KINDS if f'told("{kind}"' not in text] == []


def test_saved_files_say_who_is_told_from_now_on(hall: Hall, web: Callable[..., Web]) -> None:
    shown, other = hall.whole(), web()
    main_file = hall.folder / "lumen.yaml"
    save(main_file, main_file.read_text().replace(hall.web.url, other.url))
    hall.until(lambda: shown.reloader and shown.reloader.last)
    assert shown.reloader
    report = shown.reloader.last
    assert report
    assert (report.verdict, report.restart) == ("applied", [])
    assert [str(change) for change in report.changes] == ["the recipients of alerts (`alerts`) changed"]
    shown.stop()
    hall.live(2)
    until(lambda: other.of("stopped"))
    hall.close()
    assert hall.web.bodies == []
