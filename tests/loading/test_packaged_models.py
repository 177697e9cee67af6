"""`mjcf: PACKAGE:PATH`: a model of an installed package, and nothing outside of it."""

from pathlib import Path

from lumen.project.packaged_models import in_package, mjcf_path, package_file
from tests.tables import for_each

MODELS = Path("models")


def test_a_file_of_a_package_is_found_without_importing_it() -> None:
    found = package_file("dm_control:suite/humanoid.xml")
    assert found is not None
    assert found.is_file()
    assert mjcf_path("dm_control:suite/humanoid.xml", MODELS) == found


@for_each(
    "name",
    [
        "dm_control:suite/gone.xml",
        "dm_control:../mujoco/testdata/model.xml",
        "dm_control:/etc/passwd",
        "dm_control:suite",
        "dm_control.suite:humanoid.xml",
        "no_such_package:model.xml",
        "os:path.xml",
        ":x.xml",
        "dm_control:\0.xml",
    ],
)
def test_what_is_not_in_a_package_is_not_found(name: str) -> None:
    assert in_package(name)
    assert package_file(name) is None
    assert mjcf_path(name, MODELS) == MODELS / name


def test_a_name_without_a_package_lies_beside_the_body() -> None:
    assert not in_package("nao.xml")
    assert mjcf_path("nao.xml", MODELS) == MODELS / "nao.xml"
