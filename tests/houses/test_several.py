"""Several robots in one process, each with its own visitors, files and stop."""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.errors import LumenError, RobotModelError, UsageError
from lumen.journal.journal_folder import JOURNAL_FOLDER
from lumen.project.home import home_of
from lumen.run.exhibition import Exhibition
from lumen.run.house import House
from lumen.run.one_robot import one_robot, robots_of
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.recovery.startup import startup_project
from lumen.run.setup import set_up_house
from lumen.statechart import Step
from tests.tables import for_each

NAMES = ("ana", "ben")


@contextmanager
def opened(
    root: Path, names: tuple[str, ...] = NAMES, story: str | None = "visitor"
) -> Iterator[dict[str, Exhibition]]:
    """Open the robots of that project on one bus of this process, as fast as possible; the first plays the story."""
    projects = {name: lumen.load(root, robot=name) for name in names}
    told = {name: projects[name].stories[story] if story and name == names[0] else None for name in names}
    setups = set_up_house("recording", projects, "max", told)
    found = {name: Exhibition(Plan(projects[name], setups[name], "memory://two", told[name])) for name in names}
    yield found
    for one in found.values():
        one.close()


def lived(shows: Mapping[str, Exhibition], seconds: float | None = None) -> dict[str, list[str]]:
    """Return the steps of each behaviour until the first one is over."""
    steps: dict[str, list[str]] = {name: [] for name in shows}
    for name, show in shows.items():
        show.observe(lambda step, told=steps[name]: told.append(_told(step)))
    house = House({name: show.services for name, show in shows.items()}, together=seconds is None)
    house.start()
    house.run(seconds)
    house.close()
    return steps


def _told(step: Step) -> str:
    return f"{step.event and step.event.name} {step.exited} {step.entered}"


def test_the_visitor_of_one_is_nobody_to_the_other(two: Path) -> None:
    with opened(two, ("ana",)) as shows:
        alone = lived(shows)
    with opened(two) as shows:
        both = lived(shows)
    assert both["ana"] == alone["ana"]
    assert len(both["ana"]) > 3
    assert both["ben"] == ["None () ('waiting',)", "done.command.c1 () ()"], "it wakes, and waits"


@pytest.mark.once
def test_the_stop_of_one_stops_nobody_else(two: Path) -> None:
    with opened(two, story=None) as shows:
        house = House({name: show.services for name, show in shows.items()})
        house.start()
        shows["ana"].stop()
        house.run(1.0)
        assert shows["ana"].status()["stopped"]
        assert not shows["ben"].status()["stopped"]
        shows["ben"].say("Hello")
        house.run(1.0)
        shows["ana"].resume()
        house.run(1.0)
        assert not shows["ana"].status()["stopped"]


def test_a_lost_robot_ends_alone(two: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def lose() -> float:
        raise RobotModelError("it is gone")

    lost: list[tuple[str, LumenError]] = []
    with opened(two, story=None) as shows:
        house = House(
            {name: show.services for name, show in shows.items()}, lambda name, error: lost.append((name, error))
        )
        house.start()
        house.run(0.5)
        monkeypatch.setattr(shows["ana"].node, "tick", lose)
        house.run(0.5)
        assert [(name, str(error)) for name, error in lost] == [("ana", "it is gone")]
        assert house.going == ("ben",)
        assert shows["ben"].now == pytest.approx(1.0)


@pytest.mark.parametrize("leave", [True, False])
def test_each_knows_whether_the_next_run_goes_on(two: Path, leave: bool) -> None:
    with opened(two, story=None) as shows:
        house = House({name: show.services for name, show in shows.items()})
        house.start()
        house.interrupt(2, leave=leave)
        house.run(1.0)
        assert house.over
        assert [show.node.leaving for show in shows.values()] == [leave, leave]


@pytest.mark.process
def test_each_has_its_folder_and_its_journal(two: Path) -> None:
    homes = {}
    for name in NAMES:
        directory = RunDirectory(two, name)
        project = startup_project(two, directory, last_good=False)
        assert project.robot == name
        assert directory.home
        homes[name] = directory.home.folder
        directory.close(forget=False)
    assert homes == {name: two / ".lumen/robots" / name for name in NAMES}


@pytest.mark.network
def test_the_command_line_runs_all_of_them(two: Path, capsys: pytest.CaptureFixture[str]) -> None:
    flags = ["--robot", "recording", "--story", "visitor", "--speed", "max"]
    assert main(["run", str(two), *flags]) == 0
    said = capsys.readouterr().out
    assert "ana robot    “Hello! I am Nao.”" in said
    assert "ben state    waiting" in said
    assert "ben robot    “Hello" not in said
    assert list((home_of(two, "ana") / JOURNAL_FOLDER / "rehearsed").glob("*.journal"))
    assert main(["run", str(two), *flags, "--robot-name", "ben", "--format", "json"]) == 0
    verdict = json.loads(capsys.readouterr().out)
    assert verdict["ended"] == "well"
    assert main(["run", str(two), *flags, "--robot-name", "bob"]) == 2
    assert "there is no robot `bob`: there are `ana`, `ben`" in capsys.readouterr().err
    assert main(["run", str(two), *flags, "--video", "film.mp4"]) == 2
    assert "--video works with only one robot" in capsys.readouterr().err
    assert main(["run", str(two), *flags, "--voice", "espeak"]) == 2
    assert "--voice works with only one robot" in capsys.readouterr().err


@pytest.mark.process
@for_each(
    ("robot", "told"),
    [
        ("simulation", "the story `shy` has faults of the robot (`robot:`): play it with --robot recording"),
        ("none", "the story `shy` has faults of the robot (`robot:`): play it with --robot recording"),
        ("none --story visitor", "a story needs a robot: leave out --robot none"),
        ("recording --only brain,visitor --bus amqp://127.0.0.1:1/", "pass --story to the robot's process, too"),
    ],
)
def test_a_story_that_a_house_cannot_play_is_refused_as_for_one_robot(
    robot: str, told: str, two: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (two / "behaviors/stories/shy.yaml").write_text("title: Shy\nrobot: {say: fails}\nsteps: [{visitor: arrives}]\n")
    for chosen in ((), ("--robot-name", "ana")):
        assert main(["run", str(two), "--story", "shy", *chosen, "--robot", *robot.split()]) == 2
        assert told in capsys.readouterr().err


@pytest.mark.process
def test_a_house_in_which_a_story_was_not_over_ends_as_one_robot_does(
    two: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    flags = ["--robot", "recording", "--story", "visitor", "--speed", "max", "--for", "1s", "--format", "json"]
    for chosen in ((), ("--robot-name", "ana")):
        assert main(["run", str(two), *flags, *chosen]) == 1
        printed = capsys.readouterr()
        assert json.loads(printed.out)["ended"] == "early"
        assert "Ended before the story was over: 0:01" in printed.err


def test_who_is_meant(two: Path) -> None:
    assert robots_of(two, None) == ("ana", "ben")
    assert robots_of(two, " ben,ana ") == ("ben", "ana")
    assert one_robot(two) == "ana"
    shipped = Path(lumen.load().root)
    assert robots_of(shipped, None) == ()
    assert one_robot(shipped, "NAO") == ""
    with pytest.raises(UsageError, match="must be one or more"):
        robots_of(two, ",")
