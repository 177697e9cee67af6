"""A stranger's feature forgets a person, in each process that forgets; a faulty one keeps no other from forgetting."""

import logging
from contextlib import closing
from pathlib import Path

import pytest

import lumen
from lumen.feature import resolve
from lumen.language.people import PersonName
from lumen.language.stories import Visitor
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.forgetting.added import OF_A_PACKAGE, FeatureForgetter, out_of_reach
from tests import ROOT
from tests.copying import copied_project
from tests.features.alerts.halls import Hall
from tests.features.alerts.servers import Web
from tests.stranger.installing import Installed

MANIFEST = """
from lumen.feature import Feature

FEATURE = Feature(name="guests", forgets=("guest_list:gone", "guest_list:fails", "guest_list:forget"))
"""
GUESTS = """
FORGOTTEN = []

def fails(person):
    raise ValueError(f"{person.key} is not a guest")

def forget(person):
    FORGOTTEN.append(person)
"""
FAULTS = {
    name: f"the installed package `lumen-guests` 1.0 is faulty: `guest_list:{name}` raised {kind} and did not forget a"
    " person (update `lumen-guests`, or remove it: pip uninstall lumen-guests)"
    for name, kind in (("gone", "AttributeError"), ("fails", "ValueError"))
}


def forgotten(module: str) -> list[str]:
    return [person.key for person in resolve(f"{module}:FORGOTTEN")]


@pytest.mark.process
def test_a_part_and_a_function_forget_a_person(stranger: Path, tmp_path: Path) -> None:
    root = copied_project(ROOT / "examples/minimal", tmp_path / "minimal")
    with lumen.open(root, robot="recording") as exhibition:
        book = exhibition.services[resolve("lumen_stranger.guests:GuestBook")]
        exhibition.visitor.arrive(Visitor())
        for sentence in ("I am Ani", "I am Budi"):
            exhibition.visitor.speak(sentence)
            exhibition.run(seconds=1)
        assert book.sentences == ["I am Ani", "I am Budi"]
        exhibition.services.bus.publish("lumen.NAO.persistence.forgotten", {"name": "Ani"})
        exhibition.run(seconds=1)
        assert book.sentences == ["I am Budi"]
    assert forgotten("lumen_stranger.guests") == ["ani"]


@pytest.mark.process
@pytest.mark.network
def test_a_process_with_the_robot_forgets_what_it_has(stranger: Path, tmp_path: Path) -> None:
    with closing(Web()) as web, closing(Hall(tmp_path, web)) as hall:
        robot = hall.part("robot")
        assert not [part for part in robot.parts if part.name == "guest book"]
        hall.bus.publish("lumen.TINY.persistence.forgotten", {"name": "Ani"})
        hall.until(lambda: forgotten("lumen_stranger.guests") == ["ani"])


def test_if_one_feature_fails_the_others_forget_and_the_log_has_no_name(
    installed: Installed, caplog: pytest.LogCaptureFixture
) -> None:
    installed.write("lumen-guests", MANIFEST, guest_list=GUESTS)
    told = list[str]()
    FeatureForgetter(lambda kind: None, told.append).forget(PersonName("Ani"))
    assert forgotten("guest_list") == ["ani"]
    assert told == [record.getMessage() for record in caplog.records] == [FAULTS["gone"], FAULTS["fails"]]
    assert {record.levelno for record in caplog.records} == {logging.ERROR}
    assert "ani" not in caplog.text.lower()


def test_a_run_in_which_a_package_failed_to_forget_ends_with_trouble(installed: Installed, tmp_path: Path) -> None:
    installed.write("lumen-guests", MANIFEST, guest_list=GUESTS)
    root = copied_project(ROOT / "examples/minimal", tmp_path / "minimal")
    with lumen.open(root, robot="recording") as exhibition:
        exhibition.services.bus.publish("lumen.NAO.persistence.forgotten", {"name": "Ani"})
        exhibition.run(seconds=1)
        assert exhibition.node.faults == [FAULTS["gone"], FAULTS["fails"]]


def test_lumen_memory_forget_names_the_package(installed: Installed) -> None:
    installed.write("lumen-guests", MANIFEST, guest_list=GUESTS)
    assert ("the installed package `lumen-guests`", OF_A_PACKAGE) in out_of_reach((), broker="")


def test_lint_reports_what_cannot_be_imported(installed: Installed) -> None:
    installed.write("lumen-guests", MANIFEST, guest_list=GUESTS)
    base = ROOT / "tests/lint/pages/base"
    [finding] = check_files(base, read_files(base))[1]
    assert "its module `guest_list:gone` raised AttributeError" in finding.message
