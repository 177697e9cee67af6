"""`lumen doctor` lists skills: installed where the robot runs, missing there, or performed by a module."""

from pathlib import Path

from lumen.bus.memory import MemoryBus
from lumen.cli import doctor
from lumen.project import load
from lumen.run import attendance
from tests.features.skills.changing import project_in

PUMP = {"skills/pump.yaml": ("", "performed-by: {module: pump}\n")}


def found(root: Path, *signs: dict[str, object]) -> list[tuple[str, str]]:
    """Return the severity and text of each finding about skills, after these signs of life."""
    bus = MemoryBus()
    listener = attendance.RobotAttendance(bus, load(root))
    for sign in signs:
        bus.publish("lumen.NAO.presence", {"robot": "NAO", "session": "1", "state": "here", **sign})
    return [(severity, text) for what, severity, text in doctor._skills(listener, load(root)) if what == "skills"]


def test_a_skill_is_installed_where_the_robot_runs_or_missing_there(tmp_path: Path) -> None:
    mist = {"skills/mist.yaml": ("", "performed-by: {python: skills/spray.py}\n")}
    root = project_in(tmp_path, mist)
    said = found(root, {"parts": ["robot", "brain"], "skills": {"spray": "0123456789abcdef"}})
    assert said == [
        ("warning", "the robot's process has no program of `mist`: copy its files there, and reload"),
        ("ok", "the program of `spray` is installed (hash 0123456789ab)"),
    ]


def test_without_a_run_it_is_a_note(tmp_path: Path) -> None:
    assert found(project_in(tmp_path)) == [("note", "no running process has the programs of `spray`")]


def test_a_skill_of_a_module_needs_that_module(tmp_path: Path) -> None:
    root = project_in(tmp_path, PUMP)
    robot = {"parts": ["robot"], "skills": {"spray": "01"}}
    assert ("warning", "`pump` fails: the module `pump` shows no sign of life") in found(root, robot)
    assert ("ok", "`pump` is performed by the module `pump`") in found(root, robot, {"parts": ["pump"]})
