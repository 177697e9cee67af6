"""Without the simulation: small, lints, plays stories, answers an editor, and names the extras of physics and plots."""

import sys
import tomllib
from pathlib import Path

import installed_size as installing
import pytest

from lumen.extras import INSTALL_BARE, MissingExtraError, demand
from tests import ROOT
from tests.features.editor.client import Client
from tests.guarded import run_guarded
from tests.installing.conftest import Lumen
from tests.waiting import HANG

pytestmark = [pytest.mark.xdist_group("installing"), pytest.mark.slow]
MAX_SIZE = 100.0
"""The greatest size of the core's files, without bytecode [MB]."""
SIMULATION = ("run --story visitor --speed max", "lint --physics", "play dance", "run --video film.mp4")


@pytest.mark.process
def test_the_core_is_small(core: Path) -> None:
    assert 20 < installing.size(core).files < MAX_SIZE


def test_it_lints_plays_a_story_and_draws_the_behaviour(lumen: Lumen, exhibition: Path) -> None:
    for words in ("lint --strict", "test visitor", "graph"):
        done = lumen(exhibition, *words.split())
        assert done.returncode == 0, (words, done.stdout[-500:], done.stderr[-500:])


def test_it_answers_an_editor(core: Path, exhibition: Path) -> None:
    with Client(exhibition, [str(core), "-I", "-m", "lumen", "lsp"]) as client:
        assert client.capabilities["hoverProvider"]


@pytest.mark.parametrize("words", SIMULATION)
def test_where_physics_is_asked_for_one_line_says_what_to_install(lumen: Lumen, exhibition: Path, words: str) -> None:
    done = lumen(exhibition, *words.split())
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert "needs mujoco" in line
    assert "pip install 'lumen-robot[simulation]'" in line


def test_so_it_does_for_a_plot(lumen: Lumen, exhibition: Path) -> None:
    done = lumen(exhibition, "plot", "fuzzy/head.yaml")
    assert (done.returncode, done.stderr) == (
        2,
        "lumen plot: a plot needs matplotlib: pip install 'lumen-robot[plot]'\n",
    )


def test_what_is_there_is_not_asked_for() -> None:
    demand("simulation", "the simulated robot", "mujoco", "dm_control")


@pytest.mark.parametrize(
    ("version", "missing", "asked", "not_asked"),
    [
        ((3, 12), ["dm_control"], "lumen-robot[simulation]", "--no-deps"),
        ((3, 13), ["dm_control"], INSTALL_BARE, "lumen-robot[simulation]"),
        ((3, 13), ["dm_control", "mujoco"], f"pip install 'lumen-robot[simulation]' and {INSTALL_BARE}", "("),
    ],
)
def test_from_3_13_on_dm_control_is_asked_for_alone(
    version: tuple[int, int], missing: list[str], asked: str, not_asked: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "version_info", version)
    for name in missing:
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(MissingExtraError) as raised:
        demand("simulation", "the robot", "mujoco", "dm_control")
    assert asked in str(raised.value)
    assert not_asked not in str(raised.value)


def test_the_lines_say_the_versions_that_pyproject_asks_for() -> None:
    asked = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]["simulation"]
    assert any(line.startswith(f"{INSTALL_BARE.split(chr(39))[1]};") for line in asked)


BARE = """
import sys
from importlib.abc import MetaPathFinder

WITHOUT = {"labmaze", "scipy", "requests", "tqdm", "pyparsing", "setuptools", "matplotlib"}

class Refuse(MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in WITHOUT or name == "google.protobuf":
            raise ModuleNotFoundError(name)

sys.meta_path.insert(0, Refuse())
import lumen
from lumen.run.setup import set_up
from lumen.language.commands import Posture
robot = set_up("simulation", lumen.load(), "max").robot
robot.start("sit", Posture("Sit", 1.0))
while not any(event.name == "done.command.sit" for event in robot.poll()):
    robot.advance(0.02)
print("sits")
"""


def test_the_robot_needs_nothing_of_dm_control_that_3_13_lacks(tmp_path: Path) -> None:
    """Packages that the extra does not list for 3.13 cannot be imported here."""
    done = run_guarded([sys.executable, "-c", BARE], cwd=tmp_path, timeout=HANG, capture_output=True, text=True)
    assert done.stdout == "sits\n", done.stderr[-1500:]
