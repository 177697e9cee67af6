"""Lint stores its findings, and shows them again only if all its inputs are unchanged."""

import os
import shutil
import sys
from collections.abc import Callable
from importlib import invalidate_caches
from pathlib import Path
from types import SimpleNamespace

import pytest

from lumen.cli.main import main
from lumen.lint import traps
from lumen.project import engine_files, looks
from lumen.run.linting import kept_findings
from tests import ROOT
from tests.copying import copied_project
from tests.guarded import PIPE, run_guarded

BASE = Path(__file__).parent / "base"
FORMATS = "text", "concise", "json", "sarif", "github", "junit"
TOUR, MODEL, PACKED = "behaviors/tour.yaml", "models/tiny.xml", "tinybody"

Run = Callable[..., str]


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project that names a sound, a mesh and a fact with a last day, and whose files count as settled."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(looks, "SETTLED_NS", -(10**18))
    root = copied_project(BASE, tmp_path / "project")
    edit(root / TOUR, "play: wave", "sound: hum.wav")
    (root / MODEL).write_text('<mujoco>\n  <asset><mesh file="foot.stl"/></asset>\n</mujoco>\n')
    (root / "knowledge").mkdir()
    fact = "questions: {en: a, id: b}\nanswer: {en: a, id: b}\nuntil: 2998-01-01\n"
    (root / "knowledge/a.yaml").write_text(fact)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "packages").mkdir()
    monkeypatch.syspath_prepend(str(tmp_path / "packages"))
    return root


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """A list with an entry for each time that the rules ran."""
    times: list[int] = []
    first = traps.check

    def counted(draft: object) -> None:
        times.append(1)
        first(draft)  # type: ignore[arg-type]

    monkeypatch.setattr(traps, "check", counted)
    return times


@pytest.fixture
def lint(project: Path, capsys: pytest.CaptureFixture[str]) -> Run:
    def run(*options: str) -> str:
        main(["lint", str(project), *options])
        return capsys.readouterr().out

    return run


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def test_the_same_files_are_not_judged_again(lint: Run, judged: list[int]) -> None:
    before = {format: lint("--no-cache", "--format", format) for format in FORMATS}
    assert "hum.wav" in before["concise"]
    lint()
    judged.clear()
    assert {format: lint("--format", format) for format in FORMATS} == before
    assert lint("--select", "missing-sound", "--format", "concise").count("warning[") == 1
    assert not judged


def test_no_cache_judges_and_keeps_nothing(lint: Run, judged: list[int], tmp_path: Path) -> None:
    lint("--no-cache")
    assert not (tmp_path / "cache").exists()
    lint()
    judged.clear()
    lint("--no-cache")
    assert judged


def a_file(root: Path, _: pytest.MonkeyPatch) -> None:
    edit(root / TOUR, "sound: hum.wav", "sound: hem.wav")


def another_file(root: Path, _: pytest.MonkeyPatch) -> None:
    (root / "fleet.yaml").write_text("x: 1\n")


def a_file_that_cannot_be_read(root: Path, _: pytest.MonkeyPatch) -> None:
    outside = root.parent / "outside.yaml"
    (root / TOUR).rename(outside)
    (root / TOUR).symlink_to(outside)


def a_sound(root: Path, _: pytest.MonkeyPatch) -> None:
    (root / "hum.wav").write_bytes(b"no sound")


def a_mesh(root: Path, _: pytest.MonkeyPatch) -> None:
    (root / "models/foot.stl").write_bytes(b"")


def one_like_the_mesh(root: Path, _: pytest.MonkeyPatch) -> None:
    (root / "models/food.stl").write_bytes(b"")


def a_day(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_findings, "time", SimpleNamespace(strftime=lambda _: "2999-01-01"))


def the_engine(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine_files, "engine", lambda: "another")


def a_body(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LUMEN_MODEL", "nao")


@pytest.mark.parametrize(
    "change",
    [a_file, another_file, a_file_that_cannot_be_read, a_sound, a_mesh, one_like_the_mesh, a_day, the_engine, a_body],
)
def test_what_is_another_is_judged(
    change: Callable[[Path, pytest.MonkeyPatch], None],
    lint: Run,
    judged: list[int],
    project: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lint()
    judged.clear()
    change(project, monkeypatch)
    found = lint()
    assert judged
    assert found == lint("--no-cache")


def test_a_package_that_is_installed_later_counts(lint: Run, judged: list[int], project: Path, tmp_path: Path) -> None:
    edit(project / "models/tiny.yaml", "mjcf: tiny.xml", f"mjcf: '{PACKED}:tiny.xml'")
    assert f"no installed package `{PACKED}`" in lint()
    package = tmp_path / "packages" / PACKED
    package.mkdir()
    (package / "__init__.py").touch()
    shutil.copy(BASE / MODEL, package)
    invalidate_caches()
    assert f"no installed package `{PACKED}`" not in lint()
    judged.clear()
    lint()
    assert not judged
    edit(package / "tiny.xml", "<mujoco", "<mojuco")
    assert "broken-model" in lint()


def test_what_was_changed_a_moment_ago_is_not_kept(
    lint: Run, judged: list[int], project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(looks, "SETTLED_NS", 2_000_000_000)
    (project / "hum.wav").write_bytes(b"no sound")
    lint()
    judged.clear()
    lint()
    assert judged


@pytest.mark.parametrize("content", [b"", b"null", b"[]", b"{", b'{"looks": {}}', b'{"looks": 1, "findings": [1]}'])
def test_what_is_kept_badly_is_judged(content: bytes, lint: Run, judged: list[int], tmp_path: Path) -> None:
    found = lint()
    for kept in (tmp_path / "cache/lumen/findings").iterdir():
        kept.write_bytes(content)
    judged.clear()
    assert lint() == found
    assert judged


def test_what_is_known_needs_neither_rules_nor_the_language(project: Path) -> None:
    told = (
        "import sys; from lumen.project import looks; looks.SETTLED_NS = -10**18; from lumen.cli.main import main\n"
        "main(['lint', sys.argv[1]]); print(sorted({'yaml', 'lumen.expressions', 'lumen.lint'} & set(sys.modules)))"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "engine")}

    def imported() -> str:
        done = run_guarded([sys.executable, "-c", told, str(project)], stdout=PIPE, text=True, env=environment)
        return str(done.stdout.splitlines()[-1])

    assert [imported(), imported()] == ["['lumen.expressions', 'lumen.lint', 'yaml']", "[]"]
