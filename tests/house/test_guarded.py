"""Processes that a test starts end with the process that started them, even if that is killed."""

import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from tests import ROOT
from tests.guarded import PIPE, CalledProcessError, Guarded, TimeoutExpired, run_guarded
from tests.waiting import HANG, until

FAMILY = """
import sys
from tests.guarded import Guarded, temporary_folder
(temporary_folder("family-") / "file").write_text("")
Guarded(["sh", "-c", "trap '' INT TERM HUP; sleep 1000 & sleep 1000"])
Guarded([sys.executable, "-c", "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(1000)"])
print("started", flush=True)
"""
BROKER = """
from tests.rabbitmq import RabbitMQ
RabbitMQ().start()
print("started", flush=True)
"""
FOREVER = "import time\nwhile True: time.sleep(1)\n"
STUBBORN = f"""
import time
from pathlib import Path
def test_that_does_not_end():
    exec({FAMILY!r})
    Path("started").touch()
    while True:
        try:
            time.sleep(1000)
        except KeyboardInterrupt:
            if WILLING:
                raise
"""
"""A test that starts programs and never ends; unless it is WILLING, not even when it is interrupted."""

Start = Callable[..., Guarded[str]]


@pytest.fixture
def start(tmp_path: Path) -> Start:
    """A function that starts Python in `tmp_path`, which is in the environment of all child processes."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path)}

    def begin(*words: str, folder: Path = tmp_path) -> Guarded[str]:
        return Guarded([sys.executable, *words], cwd=folder, env=environment, stdout=PIPE, text=True)

    return begin


def left(folder: Path) -> list[str]:
    """Return the processes whose environment names the folder, and the folders in it in which they worked."""
    mark = str(folder)
    if Path("/proc").is_dir():
        processes = [str(process) for process in Path("/proc").glob("[0-9]*") if mark in environment(process)]
    else:
        said = run_guarded(["ps", "axeww"], stdout=PIPE, text=True).stdout
        processes = [line for line in said.splitlines() if mark in line]
    return processes + [path.name for prefix in ("family-*", "lumen-*") for path in folder.glob(prefix)]


def environment(process: Path) -> str:
    try:
        return (process / "environ").read_text(errors="replace")
    except OSError:
        return ""


def gone(folder: Path) -> None:
    until(lambda: not left(folder))


@pytest.mark.parametrize("program", [FAMILY, pytest.param(BROKER, marks=pytest.mark.broker)], ids=["family", "broker"])
def test_what_a_process_started_ends_when_it_is_killed(program: str, start: Start, tmp_path: Path) -> None:
    process = start("-c", program + FOREVER)
    assert process.stdout
    assert process.stdout.readline() == "started\n"
    assert len(left(tmp_path)) > 4
    process.kill()
    process.communicate()
    gone(tmp_path)


@pytest.mark.parametrize("end", ["quit()", "1 / 0", "import os; os._exit(1)"])
def test_or_ends_otherwise(end: str, start: Start, tmp_path: Path) -> None:
    out, _ = start("-c", FAMILY + end).communicate()
    assert out == "started\n"
    gone(tmp_path)


def test_sessions_that_are_killed_or_interrupted_leave_nothing(start: Start, tmp_path: Path) -> None:
    """The sessions run at the same time, since each takes as long as xdist waits for its worker."""
    sessions = [begun(start, tmp_path / name, willing) for name, willing in (("a", False), ("b", True), ("c", False))]
    for session in sessions:
        until((session.folder / "started").exists)
    assert len(left(tmp_path)) > 3 * 4
    killed, interrupted, stubborn = (session.process for session in sessions)
    killed.kill()
    os.killpg(interrupted.pid, signal.SIGINT)
    os.killpg(stubborn.pid, signal.SIGINT)
    interrupted.wait(HANG)
    stubborn.kill()
    for process in (killed, interrupted, stubborn):
        process.communicate()
    gone(tmp_path)


class Session(NamedTuple):
    folder: Path
    process: Guarded[str]


def begun(start: Start, folder: Path, willing: bool) -> Session:
    """Return a session of pytest with one worker, in which a test does not end."""
    folder.mkdir()
    (folder / "test_inner.py").write_text(f"WILLING = {willing}\n" + STUBBORN)
    words = ["-m", "pytest", "-n", "1", "-p", "no:cacheprovider", "-c", os.devnull, "test_inner.py"]
    return Session(folder, start(*words, folder=folder))


def test_programs_end_in_time_and_say_how() -> None:
    """They behave like the functions of the standard library that they replace."""
    done = run_guarded(["cat"], input="hello", capture_output=True, text=True, timeout=HANG)
    assert (done.returncode, done.stdout, done.stderr) == (0, "hello", "")
    with pytest.raises(TimeoutExpired):
        run_guarded(["sleep", "1000"], timeout=0.1)
    with pytest.raises(CalledProcessError, match="non-zero exit status 3"):
        run_guarded(["sh", "-c", "exit 3"], check=True)
