"""The kind of a body's base is a row of a feature, in lint, in the editor and under physics."""

import shutil
from pathlib import Path

import pytest

import lumen
from lumen.errors import LumenError
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import complete
from lumen.features.simulation.offers import SimulatedRobot
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.schema import load_schema
from tests import ROOT
from tests.features.editor.test_services import place
from tests.stranger.installing import Installed
from tests.tables import for_each

HELLO, MODEL = "behaviors/hello.yaml", "models/lantern.yaml"
SPEEDS = "speed: 0.2, turn: 1"
BEHAVIOR = """\
entry: {wake: true}
states:
  leaving: {do: {walk: {x: 0.3, theta: 1.57}}, onDone: there, onError: there}
  there: {on: {face: leaving}}
"""


def lantern_hall(folder: Path, base: str) -> Path:
    """Write a project in which Lantern walks, with a base of its own, and return it."""
    root = shutil.copytree(ROOT / "examples/minimal", folder / "hall")
    main = (root / "lumen.yaml").read_text()
    (root / "lumen.yaml").write_text(main.replace("model: nao", "model: lantern").replace("story:", "# story:"))
    (root / HELLO).write_text(BEHAVIOR)
    shutil.rmtree(root / "behaviors/stories")
    (root / "models").mkdir()
    (root / MODEL).write_text((ROOT / MODEL).read_text().replace("base: {kind: fixed}", f"base: {base}"))
    shutil.copy(ROOT / "models/lantern.xml", root / "models")
    return root


def findings(root: Path) -> list[str]:
    """Return the code, the place, the message and the hint of each finding in the body's file."""
    found = [each for each in check_files(root, read_files(root))[1] if each.place.file == MODEL]
    return [f"{d.place.line}:{d.place.column} {d.code} | {d.message} | {d.hint}" for d in found]


WRONG = {
    "sound": (f"{{kind: glider, {SPEEDS}}}", []),
    "unknown kind": (
        f"{{kind: gilder, {SPEEDS}}}",
        ["30:16 wrong-value | `kind` can't be `gilder` | did you mean `glider`? allowed: "],
    ),
    "missing speed": ("{kind: glider, turn: 1}", ["30:3 missing-key | `base` needs the key `speed`"]),
    "key of another kind": (
        f"{{kind: glider, {SPEEDS}, left: turn}}",
        ["30:45 unknown-key | `left` is not"],
    ),
}


@for_each("what", WRONG)
def test_lint_checks_the_keys_of_a_base_by_its_row(what: str, stranger: Path, tmp_path: Path) -> None:
    base, expected = WRONG[what]
    found = findings(lantern_hall(tmp_path / what, base))
    assert [text[: len(start)] for text, start in zip(found, expected, strict=True)] == expected


def test_a_kind_is_unknown_without_its_package(tmp_path: Path) -> None:
    (found,) = findings(lantern_hall(tmp_path, "{kind: glider, speed: 0.3, turn: 1}"))  # no text that was read before
    assert "wrong-value | `kind` can't be `glider`" in found
    assert found.endswith("`biped`, `fixed`, `wheels`")


def test_lint_reports_a_walk_as_left_out_if_the_base_stays(stranger: Path, tmp_path: Path) -> None:
    for name, base, left_out in (("moves", f"{{kind: glider, {SPEEDS}}}", False), ("stays", "{kind: fixed}", True)):
        found = lumen.check(lantern_hall(tmp_path / name, base))
        assert (("left-out", HELLO) in {(each.code, each.place.file) for each in found}) is left_out


def test_the_editor_and_the_schema_list_the_kind(stranger: Path, tmp_path: Path) -> None:
    root = lantern_hall(tmp_path, f"{{kind: glider, {SPEEDS}}}")
    analysis = Analysis(root, read_files(root))
    offered = {item.text for item in complete(analysis, *place(analysis, MODEL, "kind: |glider"))}
    assert offered == {"biped", "wheels", "fixed", "glider"}
    kind = load_schema("body")["properties"]["roles"]["properties"]["base"]["properties"]["kind"]
    assert kind["description"].endswith(" `glider` is a glider.")


def test_a_body_walks_on_the_base_of_a_package(stranger: Path, tmp_path: Path) -> None:
    with lumen.open(lantern_hall(tmp_path, f"{{kind: glider, {SPEEDS}}}"), robot="simulation") as exhibition:
        exhibition.run(seconds=5)
        assert exhibition.configuration == {"there"}
        robot = exhibition.services.setup.robot
        assert isinstance(robot, SimulatedRobot)
        assert robot.base.whereabouts == pytest.approx((0.3, 0.0, 1.57, 0.0), abs=0.03)
        assert not robot.fallen


MANIFEST = """\
from lumen.feature import *

FEATURE = Feature(name="faulty", bases={"strider": BaseRow("faulty_code:make", "a strider", legs=True),
"sledge": BaseRow("faulty_code:make", "a sledge", drives=True)})
"""


def test_a_base_with_legs_needs_what_a_biped_needs(installed: Installed, tmp_path: Path) -> None:
    installed.write("faulty", MANIFEST)
    role, posture = findings(lantern_hall(tmp_path, "{kind: strider}"))
    assert "incomplete-role | a strider needs `legs.left`, `legs.right`, `soles.left`" in role
    assert "the robot has no posture `Crouch`" in posture


FAULTS = {
    "raises": ("def make(request): 1 / 0", "its module `faulty_code:make` raised ZeroDivisionError"),
    "returns no base": (
        "def make(request): return 7",
        "a base needs the methods whereabouts, catching, soles, walk, steady, relax, lose, keep"
        " (`lumen.features.simulation.base.RobotBase`)",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_faulty_base_is_an_error_that_names_its_package(fault: str, installed: Installed, tmp_path: Path) -> None:
    code, message = FAULTS[fault]
    installed.write("faulty", MANIFEST, faulty_code=code)
    root = lantern_hall(tmp_path, f"{{kind: sledge, {SPEEDS}}}")
    with pytest.raises(LumenError, match="the installed package `faulty`") as raised:
        SimulatedRobot(lumen.load(root).body, root / "models", str(ROOT / "models/hall.xml"))
    assert message in str(raised.value)
