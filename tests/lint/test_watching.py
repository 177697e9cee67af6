"""`lumen lint --watch`: saved files are answered, and Ctrl-C is a good end."""

import os
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests import ROOT
from tests.copying import copied_project
from tests.guarded import PIPE, Guarded
from tests.saving import save
from tests.waiting import HANG

HERE = Path(__file__).parent
ENGINE = ROOT / "engine"
END = "waiting for the next change, Ctrl-C ends"


@pytest.fixture
def project(tmp_path: Path) -> Path:
    copied_project(HERE / "base", tmp_path / "p")
    return tmp_path / "p"


@pytest.fixture
def watching(project: Path) -> Iterator[Guarded[str]]:
    command = [sys.executable, "-m", "lumen", "lint", "--watch", "--format", "concise", str(project)]
    environment = {**os.environ, "PYTHONPATH": str(ENGINE)}
    with Guarded(command, stdout=PIPE, stderr=PIPE, text=True, env=environment) as process:
        deadline = threading.Timer(HANG, process.kill)
        deadline.start()
        yield process
        deadline.cancel()
        process.kill()


def answer(process: Guarded[str]) -> str:
    """Return the output until the process waits; otherwise the deadline ends the process, and with it the pipe."""
    assert process.stdout
    said = ""
    for line in process.stdout:
        said += line
        if END in line:
            return said
    raise AssertionError(f"it ended: {said}")


@pytest.mark.slow
def test_a_saved_file_is_answered(project: Path, watching: Guarded[str]) -> None:
    assert "nothing wrong; " in answer(watching)
    tour = project / "behaviors/tour.yaml"
    text = tour.read_text()
    save(tour, text.replace("onError: idle", "onError: idel"))
    assert "error[unknown-state]" in answer(watching)
    save(project / "motions/bow.yml", "start: Stand\n")
    said = answer(watching)
    assert "error[unknown-state]" in said
    assert "warning[not-read]" in said
    (project / "motions/bow.yml").unlink()
    save(tour, text)
    while "nothing wrong; " not in (said := answer(watching)):
        assert "error" in said or "warning" in said
    watching.send_signal(signal.SIGINT)
    out, error = watching.communicate(timeout=HANG)
    assert (out, error, watching.returncode) == ("", "", 0)


UNNOTICED = """
import signal, sys, threading
from lumen.cli.main import main

def interrupt():
    sys.stdin.readline()
    signal.raise_signal(signal.SIGINT)  # on another thread: it does not end the wait of the main thread

threading.Thread(target=interrupt, daemon=True).start()
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.slow
def test_ctrl_c_just_before_a_wait_is_noticed(project: Path) -> None:
    command = [sys.executable, "-c", UNNOTICED, "lint", "--watch", str(project)]
    environment = {**os.environ, "PYTHONPATH": str(ENGINE)}
    with Guarded(command, stdin=PIPE, stdout=PIPE, stderr=PIPE, text=True, env=environment) as process:
        assert "nothing wrong; " in answer(process)
        assert process.communicate("now\n", timeout=HANG) == ("", "")
        assert process.returncode == 0
