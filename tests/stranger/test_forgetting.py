"""A stranger's feature forgets a person, in each process that forgets; a faulty one keeps no other from forgetting."""

import logging
from contextlib import closing
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.feature import resolve
from lumen.language.people import PersonName
from lumen.language.stories import Visitor
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.forgetting.added import FILES_ELSEWHERE, FORGOT, OF_A_PACKAGE, FeatureForgetter, of_package
from tests import ROOT
from tests.copying import copied_project
from tests.features.alerts.halls import Hall
from tests.features.alerts.servers import Web
from tests.live.test_forgetting import found, hear, running
from tests.stranger.installing import Installed
from tests.waiting import HANG, until

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
HATS = """
from lumen.feature import Feature

FEATURE = Feature(name="hats", forgets=("hat_list:forget",))
"""
NAMED = """
id: hello
context: {visitor: ""}
initial: waits
states:
  waits:
    on: {heard: {actions: {assign: {visitor: "after(event.data.result, 'my name is')"}}}}
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


def test_lumen_memory_forget_names_the_package(
    installed: Installed, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.write("lumen-guests", MANIFEST, guest_list=GUESTS)
    root = copied_project(ROOT / "examples/minimal", tmp_path / "minimal")
    assert main(["memory", "forget", "Ani", "--project", str(root)]) == 1
    assert f"not here: {of_package('lumen-guests', OF_A_PACKAGE).where}: {OF_A_PACKAGE}" in capsys.readouterr().out


@pytest.mark.process
@pytest.mark.slow
def test_lumen_memory_forget_reports_what_the_running_exhibition_forgot(
    installed: Installed, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    installed.write("lumen-guests", MANIFEST, guest_list=GUESTS)
    installed.write("lumen-hats", HATS, hat_list=GUESTS)
    monkeypatch.setenv("PYTHONPATH", f"{installed.folder}:{ROOT / 'engine'}")
    monkeypatch.setattr("lumen.features.visitors.command.FORGETTING_SPACING", HANG)
    monkeypatch.setattr("lumen.run.forgetting.files.PATIENCE", HANG)
    root = copied_project(ROOT / "examples/minimal", tmp_path / "minimal")
    (root / "behaviors/hello.yaml").write_text(NAMED)
    (root / "behaviors/stories/visitor.yaml").write_text("title: A visit\nsteps: [{expect: {state: waits}}]\n")
    with running(root) as (_, bus):
        hear(bus, "my name is Ani")
        until(lambda: {"snapshot.json", "journal"} <= set(found(root, "Ani")))
        assert main(["memory", "forget", "Ani", "--project", str(root)]) == 1
    told = capsys.readouterr().out.splitlines()
    assert told[:6] == [
        "forgot Ani: 0 visitors, 0 entries, 0 pictures",
        "  deleted: journal: the name, by the running exhibition",
        "  deleted: snapshot.json: the name, by the running exhibition",
        f"  asked: the installed package `lumen-hats`: {FORGOT}",
        "  STILL THERE: the installed package `lumen-guests`:"
        " `guest_list:fails` raised ValueError and did not forget a person",
        f"  not here: other machines: {FILES_ELSEWHERE}",
    ]


def test_lint_reports_what_cannot_be_imported(installed: Installed) -> None:
    installed.write("lumen-guests", MANIFEST, guest_list=GUESTS)
    base = ROOT / "tests/lint/pages/base"
    [finding] = check_files(base, read_files(base))[1]
    assert "its module `guest_list:gone` raised AttributeError" in finding.message
