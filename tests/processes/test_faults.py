"""Killed processes and a killed broker: the tour continues or ends safely, and no action is repeated."""

import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

import pika
import pytest

import lumen
from lumen.bus import connect
from lumen.cli.main import main
from lumen.language.commands import Rest
from lumen.ports import Perform
from lumen.run.parts import guard
from lumen.run.snapshot_store import SNAPSHOT_FILE
from tests.guarded import DEVNULL, PIPE, STDOUT, Guarded
from tests.processes.troupe import SPEED, Member, Troupe, alone, deeds
from tests.rabbitmq import RabbitMQ
from tests.waiting import HANG, Collector, until

SORRY, PARDON = 'en: "I am sorry, I did not understand that."', 'en: "Come again, please?"'
Start = Callable[..., Guarded[str]]


@pytest.fixture
def start(copy: Path, broker: RabbitMQ) -> Iterator[Start]:
    """A function that starts `lumen run --only …` in a process of its own."""
    with ExitStack() as stack:

        def run(only: str, *words: str, speed: str = SPEED, program: Sequence[str] = ("-m", "lumen")) -> Guarded[str]:
            line = [sys.executable, *program, "run", str(copy), "--robot", "recording", "--speed", speed]
            line += ["--bus", broker.url, "--only", only, *words]
            process: Guarded[str] = Guarded(line, text=True, stdin=DEVNULL, stdout=PIPE, stderr=STDOUT)
            stack.callback(process.wait, 30)
            stack.callback(process.kill)
            return process

        yield run


class Dead:
    """Collects the messages that reach `lumen.dead` from now on."""

    def __init__(self, url: str) -> None:
        self._connection = pika.BlockingConnection(pika.URLParameters(url))
        self._channel = self._connection.channel()
        self._queue = self._channel.queue_declare("", exclusive=True).method.queue
        self._channel.queue_bind(self._queue, "lumen.dead")

    def next(self) -> bytes:
        return self._channel.basic_get(self._queue, auto_ack=True)[2] or b""

    def close(self) -> None:
        self._connection.close()


def motions(member: Member) -> list[str]:
    return [command.motion.name for _, command in member.body.performed if isinstance(command, Perform)]


PATIENCE = 120.0
"""The time that a brain may be away [s]: a crowded machine needs more than the usual 5 s to restart it."""
PATIENT = f"""
import sys
from lumen.cli.main import main
from lumen.run import loop
loop.BRAIN_LOST_AFTER = {PATIENCE}
sys.exit(main(sys.argv[1:]))
"""


def test_a_brain_that_is_killed_goes_on_where_it_was_with_a_file_edited_in_between(
    troupe: Troupe, start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(guard, "BRAIN_TIMEOUT", PATIENCE)
    robot, visitor = troupe.join("robot"), troupe.join("visitor", story="dancing")
    brain = start("brain", "--story", "dancing")
    troupe.until(lambda: "dance" in motions(robot))
    kept = troupe.folder / ".lumen" / SNAPSHOT_FILE
    troupe.until(lambda: kept.exists() and '.dance"' in kept.read_text("utf-8"))  # the disk may lag behind the robot
    os.kill(brain.pid, signal.SIGKILL)
    brain.wait()
    tour = troupe.folder / "behaviors" / "tour.yaml"
    tour.write_text(tour.read_text("utf-8").replace(SORRY, PARDON), "utf-8")
    again = start("brain", "--story", "dancing", program=("-c", PATIENT))
    troupe.until(lambda: visitor.process.over)
    assert not visitor.process.failed
    assert motions(robot) == ["dance", "goodbye"]
    again.send_signal(signal.SIGTERM)
    said = again.communicate(timeout=HANG)[0]
    assert "this one continues from there, in dance" in said
    assert again.returncode == 0
    assert "Traceback" not in said


DYING = """
import os, signal, sys
from lumen.features.rabbitmq.consumer import Consumer
from lumen.cli.main import main
from lumen.robot.recording import RecordingRobot
perform = RecordingRobot.start
def die(robot, id, command):
    perform(robot, id, command)
    os.kill(os.getpid(), signal.SIGKILL)
RecordingRobot.start = die
Consumer._acknowledge = lambda *_: None  # the broker never hears that it was handled
sys.exit(main(sys.argv[1:]))
"""


def test_a_robot_that_is_killed_between_performing_and_saying_so_performs_once(
    copy: Path, broker: RabbitMQ, start: Start
) -> None:
    reports, bus = Collector(), connect(broker.url, lumen.load(copy))
    bus.subscribe("avatar.NAO.event.command", reports)
    line = ["run", str(copy), "--robot", "recording", "--bus", broker.url, "--only", "robot"]
    dying = Guarded([sys.executable, "-c", DYING, *line], stdout=DEVNULL, stdin=DEVNULL)

    def send() -> None:
        """Send the command as a brain does that hears nothing: again and again, under one id."""
        bus.publish("avatar.NAO.command", {"id": "once", "type": "motion", "method": "dance"})

    until(lambda: send() or dying.poll() is not None)
    assert dying.returncode == -signal.SIGKILL
    start("robot", speed="1")
    states = lambda: [body["state"] for body in reports.bodies]  # noqa: E731
    until(lambda: send() or states().count("failed") > 1)
    assert set(states()) <= {"accepted", "failed"}
    assert states().count("accepted") <= 1
    bus.close()


def test_a_robot_that_hangs_is_lost_and_does_nothing_late_when_it_goes_on(
    troupe: Troupe, start: Start, capsys: pytest.CaptureFixture[str]
) -> None:
    brain, robot = troupe.join("brain"), start("robot")
    troupe.until(lambda: "idle" in brain.states)
    dead = Dead(troupe.url)
    os.kill(robot.pid, signal.SIGSTOP)
    os.waitid(os.P_PID, robot.pid, os.WSTOPPED | os.WNOWAIT)  # all its threads: one may read on until then
    troupe.ear.publish("avatar.NAO.command", {"id": "late", "type": "motion", "method": "goodbye"}, ttl=2.0)
    troupe.until(lambda: "robot_lost" in brain.states)
    main(["doctor", str(troupe.folder), "--bus", troupe.url])
    assert "?? robot: a process receives `command`, but NAO shows no sign of life" in capsys.readouterr().out
    os.kill(robot.pid, signal.SIGCONT)
    troupe.until(lambda: b'"late"' in dead.next())
    troupe.until(lambda: "idle" in brain.states)
    robot.send_signal(signal.SIGTERM)
    said = robot.communicate(timeout=HANG)[0]
    assert "rests: its process was paused for " in said
    assert "goodbye" not in said
    dead.close()


def test_ctrl_c_ends_each_process_cleanly_and_who_waits_says_for_whom(start: Start) -> None:
    waiting = [start("brain"), start("visitor"), start("motion")]
    lines = []
    for process in waiting:
        assert process.stdout
        said = [process.stdout.readline(), process.stdout.readline()]
        lines.append(said[1].strip())
        process.send_signal(signal.SIGINT)
        rest = process.communicate(timeout=HANG)[0]
        assert process.returncode == 0, rest
        assert "Traceback" not in rest
    assert lines == ["waiting for the robot on avatar.NAO.command"] * 3


@pytest.mark.soak
def test_the_whole_tour_in_four_processes(troupe: Troupe, start: Start) -> None:
    """Each part is a process of its own; the tour of `make run` is the same as in one process."""
    expected = alone(troupe.folder, "visitor")
    others = [start("robot", speed="1"), start("motion", speed="1"), start("brain", "--story", "visitor", speed="1")]
    visitor = start("visitor", "--story", "visitor", speed="1")
    said = visitor.communicate(timeout=600)[0]
    assert visitor.returncode == 0, said
    troupe.until(lambda: len(deeds(troupe.trace.bodies)) >= len(expected))
    assert deeds(troupe.trace.bodies) == expected
    for process in others:
        process.send_signal(signal.SIGTERM)
        rest = process.communicate(timeout=HANG)[0]
        assert process.returncode == 0, rest
        assert "Traceback" not in rest


@pytest.mark.soak
def test_a_robot_that_is_killed_and_started_again(troupe: Troupe, start: Start) -> None:
    brain, robot = troupe.join("brain", story="dancing"), start("robot")
    visitor = troupe.join("visitor", story="dancing")
    troupe.until(lambda: "dance" in brain.states)
    os.kill(robot.pid, signal.SIGKILL)
    troupe.until(lambda: "robot_lost" in brain.states)
    start("robot")
    troupe.until(lambda: {"offer", "watching"} <= brain.states)
    troupe.until(lambda: visitor.process.over)
    assert not visitor.process.failed


@pytest.mark.soak
def test_a_broker_that_is_killed_mid_tour_and_comes_back(copy: Path) -> None:
    broker = RabbitMQ()
    broker.start()
    troupe = Troupe(copy, broker.url)
    try:
        robot, motion = troupe.join("robot"), troupe.join("motion")
        brain, visitor = troupe.join("brain", story="dancing"), troupe.join("visitor", story="dancing")
        troupe.until(lambda: "dance" in motions(robot))
        broker.kill()
        troupe.until(lambda: "robot_lost" in brain.states and isinstance(robot.body.performed[-1][1], Rest))
        before = motions(robot)
        broker.start()
        troupe.until(lambda: {"offer", "watching"} <= brain.states)
        assert motions(robot) == before == ["dance"]
        troupe.until(lambda: visitor.process.over)
        assert not visitor.process.failed
        assert motions(robot) == ["dance", "goodbye"]
        assert motion in troupe.members
    finally:
        troupe.close()
        broker.stop()
