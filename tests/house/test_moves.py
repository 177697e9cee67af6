"""The tool that moves the files of the engine, in a small package of its own, and its plan for this engine."""

import tomllib
from pathlib import Path

import pytest
from moves import Plan, exports, history, main, moves, problems
from references import PACKAGE
from scripts.shape import ROOT

from tests.guarded import run_guarded
from tests.provided import program
from tests.waiting import HANG

PLAN = """
stays = ["__init__.py"]
texts = ["docs/*", "engine/lumen/*/__init__.py", "pyproject.toml"]
leave = ["docs/old.md", "scripts/moves.toml"]

[packages]
"parlour" = "The parlour."

[stages.first]
"table.py" = "parlour/table_top.py"
"attic/table/" = "table/"

[stages.second]
"attic/__init__.py" = "-"
"attic/oven.py" = "table/oven.py"
"""
FILES = [
    "__init__.py",
    "attic/__init__.py",
    "attic/oven.py",
    "attic/table/__init__.py",
    "attic/table/leg.py",
    "table.py",
]
HOUSE = {
    f"{PACKAGE}/__init__.py": "",
    f"{PACKAGE}/attic/__init__.py": "",
    f"{PACKAGE}/attic/oven.py": "from lumen.attic.table.leg import Leg\nfrom lumen.table import Table\n",
    f"{PACKAGE}/attic/table/__init__.py": '__all__ = ["Table"]\nHOME = "lumen.table"\n',
    f"{PACKAGE}/attic/table/leg.py": "class Leg: ...\n",
    f"{PACKAGE}/table.py": "class Table: ...\n",
    "docs/old.md": "`lumen.attic.table.leg` was made in 1922.\n",
    "pyproject.toml": 'script = "lumen.attic.table.leg:Leg"\nkey = "lumen.table.NAO.command"\n',
    "scripts/moves.toml": PLAN,
}


def plan(text: str = PLAN) -> Plan:
    return Plan.of(tomllib.loads(text))


def test_each_file_of_the_engine_has_a_place() -> None:
    own = plan((ROOT / "scripts/moves.toml").read_text("utf-8"))
    package = ROOT / PACKAGE
    files = [path.relative_to(package).as_posix() for path in sorted(package.rglob("*")) if path.is_file()]
    files = [path for path in files if "__pycache__" not in path]
    assert len(files) > 1000
    assert problems(own, files, exports(own, package, files)) == []


def test_the_row_of_the_longest_path_moves_a_file() -> None:
    house = plan(PLAN + '"attic/table/leg.py" = "table/foot.py"\n')
    assert moves(house, "first", FILES) == {
        "attic/table/__init__.py": "table/__init__.py",
        "table.py": "parlour/table_top.py",
    }
    assert moves(house, "second", FILES)["attic/table/leg.py"] == "table/foot.py"


def test_what_a_stage_has_moved_is_found_by_its_new_place() -> None:
    done = ["table/__init__.py", "table/leg.py", "parlour/__init__.py", "parlour/table_top.py"]
    assert history(plan(), "first", done) == {
        "attic/table/__init__.py": "table/__init__.py",
        "attic/table/leg.py": "table/leg.py",
        "table.py": "parlour/table_top.py",
    }


@pytest.mark.parametrize(
    ("files", "more", "problem"),
    [
        ([*FILES, "cellar.py"], "", "no row for cellar.py"),
        (FILES, '"attic/pan.py" = "table/pan.py"', "no file for the row attic/pan.py"),
        ([*FILES, "attic/leg.py"], '"attic/leg.py" = "table/leg.py"', "2 files become table/leg.py"),
        ([*FILES, "attic/a.py"], '"attic/a.py" = "shed/a.py"', "no docstring for the new package shed"),
        (
            [*FILES, "attic/a.py"],
            '"attic/a.py" = "table/lamp.py"',
            "table/lamp.py hides the name `lamp` of its package",
        ),
    ],
)
def test_a_plan_that_does_not_fit_the_files_is_reported(files: list[str], more: str, problem: str) -> None:
    assert problems(plan(PLAN + more), files, {"table": ["lamp"]}) == [problem]


def test_a_row_whose_file_has_moved_is_done() -> None:
    done = ["__init__.py", "table/__init__.py", "table/leg.py", "table/oven.py", "parlour/table_top.py"]
    assert problems(plan(), [*done, "parlour/__init__.py"], {}) == []


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for name, text in HOUSE.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    git = [program("git"), "-c", "user.name=a", "-c", "user.email=a@b.c", "-C", str(tmp_path)]
    for command in (["init", "-q"], ["add", "."], ["commit", "-q", "-m", "Build"]):
        run_guarded([*git, *command], check=True, timeout=HANG)
    return tmp_path


def contents(root: Path) -> dict[str, str]:
    files = [path for path in sorted(root.rglob("*")) if path.is_file() and ".git/" not in path.as_posix()]
    return {path.relative_to(root).as_posix(): path.read_text("utf-8") for path in files if ".ruff" not in str(path)}


@pytest.mark.process
def test_a_stage_moves_files_and_whatever_names_them(root: Path) -> None:
    pages = {name: HOUSE[name] for name in ("docs/old.md", "scripts/moves.toml", f"{PACKAGE}/__init__.py")}
    main(["--root", str(root), "--check", "first"])
    assert contents(root) == HOUSE
    main(["--root", str(root), "first"])
    first = contents(root)
    assert first == {
        **pages,
        f"{PACKAGE}/attic/__init__.py": "",
        f"{PACKAGE}/attic/oven.py": "from lumen.table import Table\nfrom lumen.table.leg import Leg\n",
        f"{PACKAGE}/parlour/__init__.py": '"""The parlour."""\n',
        f"{PACKAGE}/parlour/table_top.py": "class Table: ...\n",
        f"{PACKAGE}/table/__init__.py": '__all__ = ["Table"]\nHOME = "lumen.parlour.table_top"\n',
        f"{PACKAGE}/table/leg.py": "class Leg: ...\n",
        "pyproject.toml": 'script = "lumen.table.leg:Leg"\nkey = "lumen.table.NAO.command"\n',
    }
    main(["--root", str(root), "first"])
    assert contents(root) == first, "a stage that is done changes nothing"
    main(["--root", str(root), "second"])
    assert not (root / PACKAGE / "attic").exists()


@pytest.mark.process
def test_a_listed_file_stays_listed_after_it_moved(root: Path) -> None:
    """`attic/table/leg.py` is in `texts`, and the stage after the one that moves it moves what it names."""
    text = PLAN.replace("texts = [", 'texts = ["engine/lumen/attic/table/leg.py", ')
    (root / "scripts/moves.toml").write_text(text, encoding="utf-8")
    (root / PACKAGE / "attic/table/leg.py").write_text('OVEN = "lumen.attic.oven"\n', encoding="utf-8")
    main(["--root", str(root), "first", "second"])
    assert contents(root)[f"{PACKAGE}/table/leg.py"] == 'OVEN = "lumen.table.oven"\n'


@pytest.mark.process
def test_a_name_in_a_file_that_no_list_has_is_left_for_a_person(root: Path) -> None:
    (root / "table.yaml").write_text("leg: lumen.attic.table.leg\n", encoding="utf-8")
    run_guarded([program("git"), "-C", str(root), "add", "."], check=True, timeout=HANG)
    with pytest.raises(SystemExit, match=r"table\.yaml:1: leg: lumen\.attic\.table\.leg"):
        main(["--root", str(root), "first"])
    assert contents(root)["table.yaml"] == "leg: lumen.attic.table.leg\n"


@pytest.mark.process
def test_a_file_that_git_will_not_follow_is_printed(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A file of imports alone is a new one to git if they are rewritten in the commit that moves it."""
    main(["--root", str(root), "first"])
    lost = [line for line in capsys.readouterr().out.splitlines() if "differs" in line]
    assert lost == ["table/__init__.py differs so much that git does not follow it to attic/table/__init__.py"]


@pytest.mark.process
def test_a_folder_stays_a_package_until_its_last_file_has_moved(root: Path) -> None:
    text = PLAN.replace('"attic/__init__.py" = "-"\n', "").replace('"table.py"', '"attic/" = "parlour/"\n"table.py"')
    (root / "scripts/moves.toml").write_text(text, encoding="utf-8")
    main(["--root", str(root), "first"])
    assert {"attic/__init__.py", "parlour/__init__.py", "attic/oven.py"} <= {
        name.removeprefix(f"{PACKAGE}/") for name in contents(root)
    }
    main(["--root", str(root), "second"])
    assert not (root / PACKAGE / "attic").exists()


@pytest.mark.process
def test_a_stage_waits_for_those_before_it(root: Path) -> None:
    with pytest.raises(SystemExit, match="second: carry out first before it"):
        main(["--root", str(root), "second"])
    assert contents(root) == HOUSE
