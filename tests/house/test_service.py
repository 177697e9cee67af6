"""The unit file for systemd: systemd accepts it, and its command starts an exhibition that ends in order on SIGTERM."""

import configparser
import shutil
import signal
import sys
from pathlib import Path

import pytest

from lumen.cli.main import main
from tests import ROOT
from tests.guarded import PIPE, STDOUT, Guarded, run_guarded
from tests.waiting import HANG

UNIT = ROOT / "examples/systemd/lumen.service"


def service() -> configparser.SectionProxy:
    unit = configparser.ConfigParser(interpolation=None)
    unit.optionxform = str  # type: ignore[assignment,method-assign]
    unit.read_string(UNIT.read_text(encoding="utf-8"))
    return unit["Service"]


def test_systemd_takes_it(tmp_path: Path) -> None:
    analyze = shutil.which("systemd-analyze")
    if analyze is None:
        pytest.skip("this machine has no systemd-analyze")
    text = UNIT.read_text(encoding="utf-8").replace(
        "/opt/lumen/bin/lumen", str(Path(sys.executable).with_name("lumen"))
    )
    unit = tmp_path / UNIT.name
    unit.write_text(text.replace("User=lumen", "User=root"), encoding="utf-8")
    done = run_guarded([analyze, "verify", "--man=no", str(unit)], capture_output=True, text=True, timeout=HANG)
    assert (done.returncode, done.stderr + done.stdout) == (0, "")


def test_its_command_runs_an_exhibition_that_ends_in_order(tmp_path: Path) -> None:
    project = tmp_path / "exhibition"
    assert main(["new", str(project), "--minimal"]) == 0
    program, *arguments = service()["ExecStart"].split()
    assert Path(program).name == "lumen"
    command = [sys.executable, "-m", "lumen", *arguments, "--robot", "recording"]
    with Guarded(command, cwd=project, stdin=None, stdout=PIPE, stderr=STDOUT, text=True) as process:
        assert process.stdout
        said = [next(line for line in process.stdout if "Hello" in line or "Good to see you" in line)]
        process.send_signal(getattr(signal, service().get("KillSignal", "SIGTERM")))
        said += process.stdout.readlines()
        assert process.wait(float(service()["TimeoutStopSec"])) == 0, said
    assert (project / ".lumen").is_dir()


def test_the_page_names_what_the_unit_says() -> None:
    page = (ROOT / "docs/all-day.md").read_text(encoding="utf-8")
    assert service()["WorkingDirectory"] in page
    assert str(Path(service()["ExecStart"].split()[0]).parents[1]) in page
    assert "--last-good" in service()["ExecStart"]
    assert f"after {service()['RestartSec']} s" in page
