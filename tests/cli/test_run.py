"""`lumen run`: the story, its transcript, its exit codes, and one line for each invalid request."""

import os
import re
import signal
import sys
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.clock.simulated import SimulatedClock
from lumen.language.projects import Project
from lumen.ports import Perform
from lumen.robot.recording import RecordingRobot
from lumen.run.setup import Setup
from tests.guarded import PIPE, Guarded, run_guarded
from tests.nodes import whole
from tests.rabbitmq import RabbitMQ
from tests.waiting import HANG, Collector, until


@pytest.mark.process
@pytest.mark.slow
def test_a_story_is_told_line_by_line_and_summed_up(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(copy), "--robot", "recording", "--speed", "max", "--story", "visitor"]) == 0
    told = capsys.readouterr().out.replace("\n" + " " * 18, " ")
    for line in (
        "state    greet  (face)",
        "robot    “Good morning!”",
        "visitor  “My name is Budi”",
        "robot    plays dance",
        "visitor  walks away",
        "motions: dance, sing, photo, goodbye",
        "px from the centre of the camera's image",
        "Next:",
    ):
        assert line in told
    assert "trouble" not in told


@pytest.mark.process
def test_a_story_that_fails_says_where_and_exits_with_1(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    story = copy / "behaviors" / "stories" / "short.yaml"
    story.write_text(
        "title: Too much to ask\nsteps:\n  - visitor: arrives\n  - expect: {state: dance, within: 3s}\n", "utf-8"
    )
    assert main(["run", str(copy), "--robot", "recording", "--speed", "max", "--story", "short"]) == 1
    told = capsys.readouterr().out
    assert "The story failed" in told
    assert "step 2 of `short`: expected state `dance` within 3 s, but the active states are" in told


@pytest.mark.process
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--story", "vistor"], "did you mean `visitor`?"),
        (["--for", "3"], "write a duration such as 60s"),
        (["--language", "fr"], "it has `en`, `id`"),
        (["--bus", "amqp://guest:guest@127.0.0.1:1/"], "no broker listens at 127.0.0.1:1"),
        (["--bus", "carrier-pigeon://"], "write memory://"),
        (["--video", "film.avi"], "name an .mp4 file"),
        (["--robot", "recording", "--video", "film.mp4"], "--video records the simulation"),
        (
            ["--video", "film.mp4", "--size", "641x480"],
            "invalid `--size 641x480`: write two even numbers from 64 to 4096",
        ),
        (
            ["--robot", "simulation", "--imperfections", "noise,backlsh"],
            "--imperfections has no `backlsh`: did you mean `backlash`?",
        ),
        (["--robot", "recording", "--imperfections", "none"], "needs --robot simulation"),
        (["--robot", "none", "--speed", "4"], "leave out --speed"),
        (["--robot", "none", "--story", "visitor"], "a story needs a robot"),
    ],
)
def test_what_can_not_be_is_one_line_and_exit_code_2(
    copy: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    robot = [] if "--robot" in arguments or "--video" in arguments else ["--robot", "recording"]
    assert main(["run", str(copy), *robot, *arguments]) == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1


def test_a_folder_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "no-such-folder"]) == 2
    assert "no-such-folder does not exist" in capsys.readouterr().err


@pytest.mark.process
def test_a_broken_project_is_named_with_its_place(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tour = copy / "behaviors" / "tour.yaml"
    tour.write_text(tour.read_text("utf-8").replace("{play: dance}", "{play: danse}"), "utf-8")
    assert main(["run", str(copy)]) == 1
    error = capsys.readouterr().err
    assert "behaviors/tour.yaml:" in error
    assert "did you mean `dance`?" in error


@pytest.mark.process
def test_so_much_time_and_no_more(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = ["run", str(copy), "--robot", "recording", "--speed", "max", "--story", "visitor", "--for", "5s"]
    assert main(run) == 1
    assert "Ended before the story was over: 0:05 of simulated time" in capsys.readouterr().out


@pytest.mark.process
@pytest.mark.slow
def test_the_tour_in_indonesian(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = ["run", str(copy), "--robot", "recording", "--speed", "max", "--story", "visitor", "--for", "12s"]
    assert main([*run, "--language", "id"]) == 1
    assert "Selamat pagi!" in capsys.readouterr().out


@pytest.mark.once
def test_the_same_tour_through_rabbitmq(project: Project, broker: RabbitMQ) -> None:
    """At ten times real time, and no faster than the broker: what it carries arrives within a fifth of a second."""
    story = project.stories["visitor"]
    robot = RecordingRobot(project.body)
    show = whole(project, Setup(robot, SimulatedClock(robot.advance, 10.0), robot), broker.url, story)
    show.start()
    assert show.player
    echo, ticks = Collector(), 0
    show.services.bus.subscribe("lumen.test.echo", echo)
    while not show.player.finished:
        show.tick()
        ticks += 1
        if ticks % 10 == 0:
            show.services.bus.publish("lumen.test.echo", ticks)
            echo.wait(ticks // 10)
    show.close()
    assert show.player.failure == ""
    assert [c.motion.name for _, c in robot.performed if isinstance(c, Perform)] == [
        "dance",
        "sing",
        "photo",
        "goodbye",
    ]


@pytest.mark.once
@pytest.mark.slow
def test_what_is_typed_is_what_the_visitor_says(copy: Path) -> None:
    """A person types through a pipe: each line is written after the output that it answers."""
    run = [sys.executable, "-m", "lumen", "run", str(copy), "--robot", "recording", "--speed", "max"]
    with Guarded(run, stdin=PIPE, stdout=PIPE, text=True) as process:
        assert process.stdin
        assert process.stdout
        told = ""
        for wanted, line in (("ask_name", "I am Rani"), ("How are you, Rani?|Nice to meet you, Rani", "fine")):
            while not any(word in told for word in wanted.split("|")):
                read = process.stdout.readline()
                assert read, told
                told += read
            process.stdin.write(line + "\n")
            process.stdin.flush()
        process.stdin.close()
        told += process.stdout.read()
        assert process.wait(HANG) == 0
    assert "visitor  “I am Rani”" in told
    assert "visitor  walks away" in told


@pytest.mark.once
@pytest.mark.slow
def test_ctrl_c_once_rests_the_robot_and_twice_ends(copy: Path, tmp_path: Path) -> None:
    log = tmp_path / "told.txt"
    story = copy / "behaviors" / "stories" / "long.yaml"
    story.write_text("title: Somebody stays\nsteps: [{visitor: arrives}, {wait: 10min}]\n", "utf-8")
    run = [sys.executable, "-m", "lumen", "run", str(copy), "--robot", "recording", "--speed", "4", "--story", "long"]
    with (
        log.open("w") as told,
        Guarded(run, stdout=told, env={**os.environ, "COLUMNS": "200"}) as process,
    ):
        until(lambda: "greet" in log.read_text())
        process.send_signal(signal.SIGINT)
        until(lambda: "again to end" in log.read_text())
        # it may have reached `ask_name` by then, and that state watches whether the visitor leaves
        until(lambda: re.search(r"stopped, interrupted(, unwatched)?  \(stop, then safety\.alarm", log.read_text()))
        process.send_signal(signal.SIGINT)
        assert process.wait(HANG) == 0
    assert "Ended before the story was over" in log.read_text()


@pytest.mark.slow
def test_a_robot_without_physics_is_run_without_numpy() -> None:
    code = "import sys, lumen.cli.run, lumen.robot.recording; sys.exit('numpy' in sys.modules)"
    assert run_guarded([sys.executable, "-c", code]).returncode == 0
