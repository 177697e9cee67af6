"""A test of `make test` that starts a process fails, whatever ran before it; one that imports a library does not."""

import os
import sys
from pathlib import Path

from tests import ROOT
from tests.guarded import run_guarded
from tests.waiting import HANG

TWICE = """
from pathlib import Path

from lumen.run.reload.validation_worker import load_apart
from lumen.project.files import read_files

BASE = Path({base!r})

def test_a_project_is_read_in_a_process():
    assert load_apart(BASE, read_files(BASE))[0]

def test_a_kept_project_is_recalled():
    assert load_apart(BASE, read_files(BASE))[0]

def test_nothing_is_started():
    pass

def test_a_library_starts_a_process_while_it_is_imported():
    import library
"""


def test_a_project_that_is_kept_counts_as_one_that_is_not(tmp_path: Path) -> None:
    (tmp_path / "test_it.py").write_text(TWICE.format(base=str(ROOT / "tests/lint/base")))
    (tmp_path / "library.py").write_text("import subprocess, sys\nsubprocess.run([sys.executable, '-c', ''])\n")
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    words = [sys.executable, "-m", "pytest", "-q", "-p", "tests.suites", "--suite", "test", "test_it.py"]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    environment |= {"PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(tmp_path / "cache")}
    done = run_guarded(words, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=HANG)
    failed = [line.split(" - ")[0] for line in done.stdout.splitlines() if line.startswith("ERROR ")]
    assert failed == [
        "ERROR test_it.py::test_a_project_is_read_in_a_process",
        "ERROR test_it.py::test_a_kept_project_is_recalled",
    ], done.stdout
    assert "4 passed, 2 errors" in done.stdout
