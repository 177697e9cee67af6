"""The message of `lumen run` about a bus that can't be reached, for one robot and for several."""

from pathlib import Path

import pytest

from lumen.cli.main import main

NO_BROKER = "amqp://guest:guest@127.0.0.1:1/"


@pytest.mark.process
@pytest.mark.parametrize(("robots", "only"), [((), False), (("--robot-name", "ana"), False), ((), True)])
def test_a_remote_robot_without_only_gets_a_hint(
    two: Path, robots: tuple[str, ...], only: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    parts = ("--only", "brain") if only else ("--robot", "remote")
    assert main(["run", str(two), "--bus", NO_BROKER, *parts, *robots]) == 2
    told = capsys.readouterr().err
    assert "no broker listens at 127.0.0.1:1" in told
    assert ("or use --bus memory://" in told) != only
