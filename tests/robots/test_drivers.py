"""Robots of the project's own: found, checked and run; and the promises that pytest tries with them."""

import shutil
import sys
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.errors import LumenError, RobotError, UsageError
from lumen.lint import check_files
from lumen.project import load
from lumen.project.files import read_files
from lumen.run.driver import make_robot, robot_class
from lumen.run.setup import robot_kind, set_up
from tests import ROOT
from tests.guarded import PIPE, STDOUT, run_guarded
from tests.tables import for_each

METHODS = """\
class Robot:
    def __init__(self, project): pass
    def start(self, id, command): pass
    def cancel(self, id): pass
    def poll(self): return []
    def begun(self): return []
    def read(self, sense): return None
    def close(self): pass
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    root = tmp_path / "hall"
    shutil.copytree(ROOT / "examples/minimal", root, ignore=shutil.ignore_patterns(".lumen"))
    assert main(["new", "robot", "printer", "--project", str(root)]) == 0
    return root


def driver(root: Path, text: str) -> None:
    (root / "drivers/own.py").write_text(text)


def test_a_driver_of_the_project_is_a_robot(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    setup = set_up("printer", load(root), "1")
    assert setup.hall is None
    setup.robot.close()
    assert robot_kind("printer", root) == "printer"


def test_a_driver_that_was_edited_is_imported_anew(root: Path) -> None:
    for version in ("first", "second one"):
        driver(root, f"{METHODS}    version = {version!r}\n")
        assert vars(robot_class("own", root))["version"] == version


def test_the_driver_of_lumen_yaml_performs_unless_another_robot_is_named(root: Path) -> None:
    main_file = root / "lumen.yaml"
    assert robot_kind("", root) == "simulation"
    main_file.write_text(main_file.read_text().replace("model: nao}", "model: nao, driver: printer}"))
    assert check_files(root, read_files(root))[1] == ()
    assert robot_kind("", root) == "printer"
    assert robot_kind("recording", root) == "recording"


@for_each(
    ("name", "says"),
    [
        ("printr", "did you mean `printer`? choose one of `naoqi`, `none`, `printer`, `reachy`, `recording`"),
        ("simulatoin", "did you mean `simulation`?"),
    ],
)
def test_an_unknown_robot_is_told_with_those_that_there_are(tmp_path: Path, name: str, says: str) -> None:
    (tmp_path / "drivers").mkdir(exist_ok=True)
    (tmp_path / "drivers/printer.py").write_text(METHODS)
    with pytest.raises(UsageError, match=f"invalid `--robot {name}`") as refused:
        robot_kind(name, tmp_path)
    assert says in str(refused.value)


BROKEN = {
    "no class": ("x = 1\n", "drivers/own.py has no class"),
    "two robots": (METHODS + METHODS.replace("Robot", "Other"), "has several robots: `Robot`, `Other`"),
    "no poll": (METHODS.replace("def poll", "def pol"), "`Robot` of the driver `own` is no robot: it lacks `poll`"),
    "no Python": (METHODS + "def x(:\n", "own.py:9: the driver `own` can't be read: invalid syntax"),
    "raises": (METHODS + "1 / 0\n", "the driver `own` can't be imported: ZeroDivisionError: division by zero"),
    "is not made": (
        METHODS.replace("project): pass", "project): raise OSError('no cable')"),
        "the driver `own` can't be used: OSError: no cable (",
    ),
    "wrong arguments": (METHODS.replace("self, project", "self"), "the driver `own` can't be used: TypeError"),
}


@pytest.mark.parametrize(("text", "says"), BROKEN.values(), ids=BROKEN)
def test_a_broken_driver_is_a_sentence(root: Path, text: str, says: str) -> None:
    driver(root, text)
    with pytest.raises(RobotError) as refused:
        make_robot("own", load(root))
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


@for_each(
    ("name", "says"),
    [
        ("nothing_at_all:Robot", "there is no package `nothing_at_all`"),
        ("lumen.robot.recording:RecordingRobo", "`lumen.robot.recording` has no class `RecordingRobo`: did you mean"),
        ("lumen.robot.recording:Path", "lumen.robot.recording"),
    ],
)
def test_a_class_of_a_package_that_is_none_is_a_sentence(tmp_path: Path, name: str, says: str) -> None:
    project = load(ROOT / "examples/minimal")
    with pytest.raises(LumenError) as refused:
        make_robot(name, project)
    assert says in str(refused.value)


def test_what_a_driver_does_wrong_in_a_run_names_it(root: Path) -> None:
    driver(root, METHODS.replace("return []\n    def begun", "return 3\n    def begun"))
    setup = set_up("own", load(root), "1")
    with pytest.raises(RobotError, match="the driver `own` returned 3 from `poll`"):
        setup.robot.poll()


def test_lint_finds_a_driver_that_is_missing_and_imports_none(root: Path) -> None:
    driver(root, "raise SystemExit('imported')\n")
    main_file = root / "lumen.yaml"
    main_file.write_text(main_file.read_text().replace("model: nao}", "model: nao, driver: prnter}"))
    [found] = check_files(root, read_files(root))[1]
    assert (found.code, found.hint) == ("missing-driver", "did you mean `printer`? drivers/ has `own`, `printer`")


def test_an_error_of_a_driver_names_its_line(root: Path) -> None:
    driver(root, METHODS.replace("def cancel(self, id): pass", "def cancel(self, id): return 1 / 0"))
    robot = set_up("own", load(root), "1").robot
    with pytest.raises(
        RobotError, match=r"`own` raised ZeroDivisionError: division by zero from `cancel` \(.*own.py:4"
    ):
        robot.cancel("a")


# The promises


def promises(root: Path, name: str) -> tuple[int, str]:
    """Return the exit code of pytest and its output, with the options that a user passes."""
    line = [
        sys.executable,
        "-m",
        "pytest",
        "-p",
        "no:cacheprovider",
        "--lumen-robot",
        name,
    ]
    done = run_guarded(line, cwd=root, stdout=PIPE, stderr=STDOUT, text=True, check=False)
    return done.returncode, done.stdout


@pytest.mark.process
def test_the_template_keeps_all_promises(root: Path) -> None:
    code, said = promises(root, "printer")
    assert code == 0, said
    assert "23 passed" in said


@pytest.mark.process
def test_the_recording_robot_keeps_all_promises(root: Path) -> None:
    (root / "drivers/own.py").write_text(
        "from lumen.robot.recording import RecordingRobot\n\n\n"
        "class Own(RecordingRobot):\n"
        "    def __init__(self, project):\n"
        "        super().__init__(project.body)\n"
    )
    code, said = promises(root, "own")
    assert code == 0, said


LIAR = """\
from lumen.language.commands import Rest
from lumen.language.events import Event
from lumen.ports import Joints
from lumen.robot.recording import RecordingRobot


class Liar(RecordingRobot):
    def __init__(self, project):
        super().__init__(project.body)

    def poll(self):
        events = list(super().poll())
        return events + [event for event in events if "look" in event.name]

    def start(self, id, command):
        if isinstance(command, Rest):
            raise KeyError("rest")
        super().start(id, command)

    def read(self, sense):
        return "warm"
"""


@pytest.mark.process
def test_a_robot_that_breaks_promises_fails_with_sentences(root: Path) -> None:
    (root / "drivers/own.py").write_text(LIAR)
    code, said = promises(root, "own")
    assert code == 1
    assert "The robot `own` answered the command `look` 2 times: done, done." in said
    assert "The driver `own` raised KeyError: 'rest' from `start` (" in said
    assert "drivers/own.py:17)." in said
    assert "`read`" in said
    assert "Traceback" not in said


@pytest.mark.process
def test_no_such_driver_is_told_by_pytest(root: Path) -> None:
    code, said = promises(root, "prnter")
    assert code == 1
    assert "no driver `prnter`: did you mean `printer`?" in said
