"""`lumen stop` and `lumen resume`, to an exhibition that runs and to one whose robot is not there."""

import io
from pathlib import Path

import pytest

import lumen
from lumen.bus import Bus
from lumen.bus.memory import MemoryBus
from lumen.cli import resume, stop
from lumen.cli.main import main
from lumen.cli.person import person
from lumen.run.exhibition import Exhibition
from lumen.run.reaching import robots_meant
from lumen.run.recovery.run_directory import RunDirectory
from tests import ROOT
from tests.cli.conftest import Terminal
from tests.copying import copied_project
from tests.waiting import until


@pytest.mark.once
@pytest.mark.slow
def test_it_stops_stays_and_goes_on_as_a_person_wants_it(
    exhibition: Exhibition, copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main(["stop", str(copy)]) == 0
    assert "the robot rests" in capsys.readouterr().out
    until(lambda: "stopped" in exhibition.configuration)
    hold = exhibition.robot.server.hold
    assert hold.stopped
    assert hold.stopped.by == person()
    monkeypatch.setattr("sys.stdin", Terminal("no\n"))
    assert main(["resume", str(copy)]) == 1
    since = f"{hold.stopped.since.astimezone():%Y-%m-%d %H:%M:%S}"
    said = capsys.readouterr().out
    assert (
        f"{person()} stopped the robot at {since}.\nIt may stand up at once, and Lumen can't see who is near." in said
    )
    assert "`--yes` skips this question" in said
    assert "stopped" in exhibition.configuration
    monkeypatch.setattr("sys.stdin", io.StringIO())
    assert main(["resume", str(copy)]) == 2
    assert "add --yes" in capsys.readouterr().err
    monkeypatch.setattr("sys.stdin", Terminal("Yes\n"))
    assert main(["resume", str(copy)]) == 0
    until(lambda: "watching" in exhibition.configuration)
    assert main(["stop", str(copy)]) == 0
    assert main(["resume", str(copy), "--yes"]) == 0
    until(lambda: "watching" in exhibition.configuration)


@pytest.mark.network
def test_where_no_robot_answers_it_says_what_is_left(
    bus: Bus, copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stop, "STOP_TIMEOUT", 0.2)
    told: list[object] = []
    bus.subscribe("lumen.config.command", lambda message: told.append(message.body))
    assert main(["stop", str(copy)]) == 2
    said = capsys.readouterr().err
    assert "the robot does not answer on `avatar.NAO.stop` and may still move: switch it off (NAO: hold the" in said
    until(lambda: told == [{"command": "stop"}])


@pytest.mark.parametrize(
    ("since", "shown"), [("just now", "just now"), (None, "None"), ("2026-05-20T10:00:00+00:00", "2026-05-")]
)
def test_what_is_no_time_is_shown_as_the_robot_told_it(
    since: object, shown: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", Terminal("no\n"))
    assert not resume._sure({"stopped_by": "Ana", "since": since}, "the robot")
    assert capsys.readouterr().out.startswith(f"Ana stopped the robot at {shown}")


@pytest.mark.network
@pytest.mark.parametrize(
    ("url", "meant"), [("memory://", ["one"]), ("amqp://hall.local", ["one", "two"]), ("", ["one", "two"])]
)
def test_all_robots_of_a_house_on_a_broker_are_meant_and_else_those_that_run_here(
    url: str, meant: list[str], tmp_path: Path
) -> None:
    root = copied_project(ROOT / "tests/lint/base", tmp_path / "house")
    main_file = root / "lumen.yaml"
    one = "robot: {name: TINY, model: tiny}"
    both = "robots: {one: {model: tiny, at: {x: 0, y: 0}}, two: {model: tiny, at: {x: 0, y: 0.5}}}"
    main_file.write_text(main_file.read_text("utf-8").replace(one, both), "utf-8")
    directory = RunDirectory(root, "one")
    try:
        if url:
            directory.open(MemoryBus(), url, lumen.load(root, robot="one"))
        assert robots_meant(str(root), None) == meant
        assert robots_meant(str(root), "amqp://hall.local") == ["one", "two"]
        assert robots_meant(str(root), "memory://") == meant
    finally:
        directory.close(forget=True)
