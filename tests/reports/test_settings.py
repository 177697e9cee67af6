"""Wrong settings of the environment: one that is not needed is ignored, and any other is named."""

import errno
import os
import sys
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.project.files import read_files
from lumen.run.live_behavior import local_timezone
from tests.guarded import run_guarded
from tests.reports.small_project import MINIMAL, placed


def lumen(root: Path, *words: str, **settings: str) -> tuple[int, str]:
    """Run `lumen` with these environment variables; return its exit code and its whole output."""
    environment = {name: value for name, value in os.environ.items() if name not in ("MUJOCO_GL", "DISPLAY")}
    command = [sys.executable, "-m", "lumen", *words]
    done = run_guarded(command, cwd=root, env=environment | settings, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.physics
@pytest.mark.parametrize(
    ("setting", "why"),
    [
        ({"MUJOCO_GL": "nonsense"}, "MUJOCO_GL=nonsense does not work here (invalid value"),
        ({"MUJOCO_GL": "glfw"}, "MUJOCO_GL=glfw draws on a screen, but this machine has none"),
        ({"MUJOCO_GL": "disable"}, "there is no OpenGL library"),
    ],
    ids=["nonsense", "glfw", "disable"],
)
def test_without_pictures_everything_else_still_runs(setting: dict[str, str], why: str, tmp_path: Path) -> None:
    placed(tmp_path, read_files(MINIMAL))
    code, told = lumen(tmp_path, "play", "wave", "--speed", "max", **setting)
    assert (code, told.count("\n")) == (0, 2), told
    code, told = lumen(tmp_path, "play", "wave", "--speed", "max", "--video", "a.mp4", **setting)
    assert (code, told.count("\n")) == (2, 1), told
    assert told.startswith(f"lumen play: {why}")


@pytest.mark.physics
def test_a_backend_without_its_library_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    from lumen.features.simulation import gl  # imported here: it takes 0.5 s

    monkeypatch.setattr(gl, "_loads", lambda library: False)
    assert gl._fault("osmesa") == (
        "MUJOCO_GL=osmesa needs libOSMesa.so.8, which is not installed: unset it, or set it to egl, osmesa or disable"
    )
    assert gl.choose() == "disable"


@pytest.mark.physics
@pytest.mark.pictures
@pytest.mark.slow
def test_a_program_that_is_no_ffmpeg_is_named(tmp_path: Path) -> None:
    placed(tmp_path, read_files(MINIMAL))
    code, told = lumen(
        tmp_path, "play", "wave", "--speed", "max", "--video", "a.mp4", IMAGEIO_FFMPEG_EXE=str(tmp_path / "none")
    )
    assert code == 2
    assert f"IMAGEIO_FFMPEG_EXE={tmp_path / 'none'} is not ffmpeg: unset it" in told
    assert "Traceback" not in told


SETTINGS = {
    "LANG": "xx_YY.UTF-9", "TZ": "Nowhere", "COLUMNS": "abc", "LINES": "-1", "TERM": "nonsense", "NO_COLOR": "",
    "TMPDIR": "/nowhere", "HOME": "/dev/null", "XDG_CACHE_HOME": "/dev/null", "XDG_STATE_HOME": "relative",
    "MPLBACKEND": "nonsense", "MPLCONFIGDIR": "/dev/null", "MUJOCO_GL": "nonsense", "PYTHONIOENCODING": "ascii",
    "PYTHONTZPATH": "/nowhere", "LUMEN_BUS_CREDENTIALS": "/nowhere", "LUMEN_HOUSE": "none",
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ["lint"],
        ["run", "--robot", "recording", "--speed", "max", "--story", "visitor"],
        ["plot", "motions/wave.yaml", "-o", "wave.svg"],
        ["explain", "yaml-syntax"],
    ],
    ids=lambda words: words[0],
)
def test_a_wrong_setting_that_is_not_needed_is_ignored(words: list[str], tmp_path: Path) -> None:
    placed(tmp_path, read_files(MINIMAL))
    code, told = lumen(tmp_path, *words, **SETTINGS)
    assert code == 0, told
    assert "Traceback" not in told


def test_an_unknown_time_zone_of_the_environment_is_named(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("TZ", "Nowhere")
    used = local_timezone()
    assert f"TZ=Nowhere is not a known time zone: times of day are in {used}" in caplog.text
    caplog.clear()
    monkeypatch.setenv("TZ", ":Europe/Berlin")
    assert local_timezone() == "Europe/Berlin"
    assert not caplog.records


def test_without_a_temporary_folder_the_error_names_the_setting(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def none(options: object) -> int:
        raise FileNotFoundError(errno.ENOENT, "No usable temporary directory found in ['/nowhere']")

    monkeypatch.setattr("lumen.cli.lint.run", none)
    assert main(["lint"]) == 2
    assert "set TMPDIR to one that is" in capsys.readouterr().err
