"""A house over RabbitMQ: its robots in one process or several; one is stopped or killed while the other continues."""

import json
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from lumen.cli.main import main
from lumen.run import claiming, node
from tests.guarded import DEVNULL, STDOUT, Guarded
from tests.rabbitmq import RabbitMQ
from tests.relay import Relay
from tests.waiting import HANG, UNLIMITED, until

PATIENT = """
import sys
from lumen.cli.main import main
from lumen.run import presence
presence.LOST_AFTER = 30.0  # the other robot's process may stand still for a while on a crowded machine
sys.exit(main(sys.argv[1:]))
"""


class Hall:
    """The two robots' processes on one broker, and the commands of operators."""

    def __init__(self, root: Path, url: str, capsys: pytest.CaptureFixture[str]) -> None:
        self.root, self.url, self._capsys = root, url, capsys
        self.running: list[Guarded[bytes]] = []

    def begin(
        self, *flags: str, url: str = "", program: Sequence[str] = ("-m", "lumen")
    ) -> tuple[Guarded[bytes], Path]:
        """Start `lumen run`; return the process and the file with its output."""
        told = self.root / f"told-{len(self.running)}.txt"
        line = [
            sys.executable,
            *program,
            "run",
            self.root,
            "--robot",
            "recording",
            "--bus",
            url or self.url,
            *flags,
        ]
        with told.open("wb") as file:
            process = Guarded(line, stdin=DEVNULL, stdout=file, stderr=STDOUT)
        self.running.append(process)
        return process, told

    def end(self, process: Guarded[bytes], how: signal.Signals = signal.SIGKILL) -> None:
        os.killpg(process.pid, how)
        process.wait(HANG)

    def call(self, verb: str, *flags: str) -> tuple[int, str]:
        """Call `lumen` for the house; return the exit code and all output."""
        self._capsys.readouterr()
        code = main([verb, *flags, str(self.root), "--bus", self.url])
        said = self._capsys.readouterr()
        return code, said.out + said.err

    def status(self) -> dict[str, dict[str, Any]]:
        """Return each robot's status; empty if none answers."""
        code, said = self.call("status", "--format", "json")
        return {} if code else {one["robot"]: one for one in json.loads(said)["robots"]}

    def both(self) -> bool:
        return ["configuration" in one for one in self.status().values()] == [True, True]

    def stands_in(self, name: str, state: str) -> bool:
        return self.status().get(name, {}).get("configuration") == [state]

    def close(self) -> None:
        for process in self.running:
            if process.poll() is None:
                self.end(process)


@pytest.fixture
def hall(two: Path, broker: RabbitMQ, capsys: pytest.CaptureFixture[str]) -> Iterator[Hall]:
    one = Hall(two, broker.url, capsys)
    yield one
    one.close()


def test_two_robots_of_one_process(hall: Hall, monkeypatch: pytest.MonkeyPatch) -> None:
    """A second process for a name is refused; a stop concerns one robot and outlives its process, whose end is told."""
    monkeypatch.setattr(sys, "stdin", None)
    process, _ = hall.begin()
    until(hall.both)
    with monkeypatch.context() as patient:  # the first may announce itself late
        patient.setattr(claiming, "CLAIM_DURATION", UNLIMITED)
        patient.setattr(node, "CLAIM_DURATION", UNLIMITED)
        code, said = hall.call("run", "--robot", "recording", "--robot-name", "ana")
    assert (code, "is already the robot of ana on this bus: end it first" in said) == (2, True)
    assert hall.call("stop", "--robot-name", "ana")[0] == 0
    found = hall.status()
    by = found["ana"]["stopped_by"]
    assert by
    assert not found["ben"]["stopped"]
    hall.end(process)
    code, said = hall.call("status", "--robot-name", "ana")
    assert code == 2
    assert "ana       is not running: it ended unexpectedly at " in said
    assert (
        f"stopped   by {by}; it stays stopped after a restart. To let it move, hold its head, or run `lumen resume`"
        in said
    )
    process, told = hall.begin()
    until(hall.both)
    assert hall.status()["ana"]["stopped_by"] == by
    hall.end(process, signal.SIGTERM)
    assert told.read_text("utf-8").count("The last run ended unexpectedly") == 2
    assert "ana       is not running: it was ended at " in hall.call("status", "--robot-name", "ana")[1]
    said = hall.call("run", "--robot", "recording", "--for", "0.1s")[1]
    assert said.count("The last run was ended") == 2
    assert "unexpectedly" not in said


def test_a_robot_whose_process_is_killed_is_told_and_the_other_goes_on(hall: Hall) -> None:
    _, told = hall.begin("--only", "brain", "--robot-name", "ana,ben", program=("-c", PATIENT))
    lost, _ = hall.begin("--only", "robot", "--robot-name", "ana")
    hall.begin("--only", "robot", "--robot-name", "ben")
    until(hall.both)
    hall.end(lost)
    until(lambda: "robot.lost" in told.read_text("utf-8"))
    lines = [line for line in told.read_text("utf-8").splitlines() if "robot.lost" in line]
    assert [line.split()[1] for line in lines] == ["ana"]
    assert hall.call("say", "I am here", "--robot-name", "ben") == (0, "said\n")
    assert not hall.status()["ben"]["stopped"]


def test_what_they_have_in_common_outlives_the_loss_of_the_broker(
    stage: Path, broker: RabbitMQ, capsys: pytest.CaptureFixture[str]
) -> None:
    """Ben gets the value that Ana assigned while he was cut off, and a replay repeats each of his steps."""
    hall, wire = Hall(stage, broker.url, capsys), Relay(broker.port)
    try:
        hall.begin("--robot-name", "ana")
        ben, _ = hall.begin("--robot-name", "ben", url=broker.url.replace(f":{broker.port}", f":{wire.port}"))
        until(hall.both)
        assert hall.call("goto", "busy", "--yes", "--robot-name", "ana")[0] == 0
        until(lambda: hall.stands_in("ben", "watching"))
        wire.refuse()
        assert hall.call("goto", "free", "--yes", "--robot-name", "ana")[0] == 0
        wire.mend()
        until(lambda: hall.both() and hall.stands_in("ben", "waiting"))
        hall.end(ben, signal.SIGTERM)
        capsys.readouterr()
        assert main(["replay", "--project", str(stage), "--robot-name", "ben"]) == 0
        assert "the same" in capsys.readouterr().out
    finally:
        hall.close()
        wire.close()
