"""The distributions: they have the metadata an index asks for, all needed files, and none of our own tools."""

import email
import email.message
import re
import sys
import tarfile
import zipfile
from pathlib import Path

import installed_size as installing
import package_metadata
import pytest
from trove_classifiers import classifiers

from tests import ROOT
from tests.golden.subjects.distribution import files
from tests.guarded import run_guarded

pytestmark = [pytest.mark.xdist_group("installing"), pytest.mark.slow]
REPOSITORY = "https://example.org/us/lumen"
RELATIVE = re.compile(r"\]\((?![a-z]+:|#)")


@pytest.fixture(scope="session")
def metadata(wheel: Path) -> email.message.Message:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        return email.message_from_string(archive.read(name).decode())


@pytest.fixture(scope="session")
def sdist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sdist")
    run_guarded([sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", folder], cwd=ROOT, check=True)
    return next(folder.glob("*.tar.gz"))


@pytest.mark.process
def test_what_an_index_asks_is_said(metadata: email.message.Message) -> None:
    named = metadata.get_all("Classifier", [])
    assert len(named) > 8
    assert set(named) <= set(classifiers)
    assert metadata["License-Expression"] == "Apache-2.0"
    assert set(metadata.get_all("License-File", [])) == {"LICENSE", "NOTICE"}
    assert metadata["Description-Content-Type"] == "text/markdown"
    assert metadata["Keywords"]


@pytest.mark.process
def test_without_an_address_nothing_leads_nowhere(metadata: email.message.Message) -> None:
    assert metadata.get_all("Project-URL") is None
    text = str(metadata.get_payload())
    assert text.startswith("# Lumen")
    assert not RELATIVE.search(text)
    assert "![" not in text


def test_with_an_address_every_link_and_picture_leads_to_a_file_that_is_there() -> None:
    text = package_metadata.readme((ROOT / "README.md").read_text(), REPOSITORY)
    targets = re.findall(rf"\]\({REPOSITORY}/(raw|blob)/HEAD/([^)#]+)", text)
    assert len(targets) > 20
    assert {kind for kind, _ in targets} == {"raw", "blob"}
    assert [target for _, target in targets if not (ROOT / target).exists()] == []
    assert not RELATIVE.search(text)
    assert package_metadata.urls(REPOSITORY)["Changelog"] == f"{REPOSITORY}/blob/HEAD/CHANGELOG.md"


def test_the_source_archive_holds_what_the_wheel_is_built_from_and_no_more(
    sdist: Path, wheel: Path, tmp_path: Path
) -> None:
    with tarfile.open(sdist) as archive:
        archive.extractall(tmp_path, filter="data")
    (unpacked,) = tmp_path.iterdir()
    assert {path.name for path in unpacked.iterdir()} == {
        "engine", "lumen.yaml", "behaviors", "functions", "knowledge", "fuzzy", "motions", "schemas", "models",
        "examples",
        "scripts", "README.md", "CHANGELOG.md", "LICENSE", "NOTICE", "pyproject.toml", "PKG-INFO",
        ".gitignore"}  # fmt: skip
    assert {path.name for path in (unpacked / "examples").iterdir()} == {"museum", "minimal"}
    assert {path.name for path in (unpacked / "scripts").iterdir()} == {"package_metadata.py"}
    assert not [path for path in unpacked.rglob("*") if path.name in ("__pycache__", ".lumen", "tests")]
    assert sdist.stat().st_size < 3_000_000
    command = [*installing.PIP, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", tmp_path, unpacked]
    run_guarded(command, check=True)
    assert names(next(tmp_path.glob("*.whl"))) == names(wheel)


def test_the_file_lists_that_are_recorded_are_those_of_what_is_built(sdist: Path, wheel: Path) -> None:
    assert [name for name in names(wheel) if ".dist-info/" not in name] == files("wheel")
    with tarfile.open(sdist) as archive:
        built = {name.partition("/")[2] for name in archive.getnames()}
    assert built - {"PKG-INFO"} >= set(files("sdist"))
    assert built - set(files("sdist")) <= {"PKG-INFO", "pyproject.toml", ".gitignore"}


def names(wheel: Path) -> list[str]:
    with zipfile.ZipFile(wheel) as archive:
        return sorted(archive.namelist())


def test_each_source_that_a_model_names_stands_in_the_notice() -> None:
    notice = re.sub(r"\s+", " ", (ROOT / "NOTICE").read_text())
    models = "".join((ROOT / "models" / name).read_text() for name in ("nao.xml", "nao.yaml", "v6.yaml"))
    for source in (
        "naoV50_generated_urdf",
        "ros-naoqi/nao_robot",
        "softbankrobotics-research/qibullet",
        "NAOH25V60.urdf",
    ):
        assert source in models
        assert source in notice
