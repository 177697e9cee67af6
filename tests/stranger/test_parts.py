"""A stranger's part takes part in an exhibition; a faulty one is a finding, and the exhibition runs without it."""

import json
import logging
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.bus.memory import MemoryBus
from lumen.bus.validated import validated
from lumen.cli.main import main
from lumen.errors import UsageError
from lumen.feature import resolve
from lumen.features.alerts.part import AlertPart
from lumen.language.events import Event
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.exhibition import Exhibition
from lumen.run.parts.part import Part
from lumen.run.plan import Plan
from lumen.run.rehearsal import RehearsalTrace
from lumen.run.setup import set_up
from tests import ROOT
from tests.copying import copied_project
from tests.stranger.installing import Installed
from tests.tables import for_each

MANIFEST = """
from lumen.feature import Feature, PartRow, Phase

FEATURE = Feature(name="counter", parts=(PartRow("counter", Phase.WATCH, "counting_part:make"),))
"""
COUNTER = """
from lumen.run.parts.part import Part
from lumen.run.exhibition import Exhibition
from lumen.features.alerts.part import AlertPart
from lumen.run.parts.part import Part
from lumen.run.plan import Plan
from lumen.run.rehearsal import RehearsalTrace
from lumen.run.setup import set_up
from lumen.bus.memory import MemoryBus
from lumen.bus.validated import validated
from lumen.errors import UsageError
from lumen.feature import resolve
from lumen.run.loop import Observer

class Counter(Part, Observer):
    watches = True
    steps = 0

    def stepped(self, step):
        self.steps += 1

def make(services):
    {make}
"""
FAULTY = "the installed package `lumen-counter` 1.0 is faulty: its module `counting_part:make` raised "


@pytest.fixture
def minimal(tmp_path: Path) -> Path:
    return copied_project(ROOT / "examples/minimal", tmp_path / "minimal")


def write(installed: Installed, make: str, manifest: str = MANIFEST) -> None:
    installed.write("lumen-counter", manifest, counting_part=COUNTER.format(make=make))


def findings(root: Path) -> list[str]:
    return [each.message for each in check_files(root, read_files(root))[1]]


def test_a_part_watches_the_steps_of_the_behaviour(installed: Installed, minimal: Path) -> None:
    write(installed, "return Counter()")
    assert findings(minimal) == []
    with lumen.open(minimal, robot="recording") as exhibition:
        exhibition.run(seconds=1)
        counter = exhibition.services[resolve("counting_part:Counter")]
        assert counter.steps > 0


@for_each(
    ("make", "told"),
    [
        ("1 / 0", "ZeroDivisionError: division by zero"),
        ("raise SystemExit(3)", "SystemExit: 3"),
        ("return [Counter(), 3]", "TypeError: `counting_part:make` returned 3, which is no part"),
        ("import not_installed", "ModuleNotFoundError: No module named 'not_installed'"),
        ("return 3", "TypeError: Value after * must be an iterable, not int"),
        (
            "return type('Deaf', (Part,), {'watches': True})()",
            "TypeError: the part Deaf watches the behaviour: derive it from Observer, too",
        ),
    ],
)
def test_an_exhibition_runs_without_a_part_that_cannot_be_made(
    make: str, told: str, installed: Installed, minimal: Path, caplog: pytest.LogCaptureFixture
) -> None:
    write(installed, make)
    project, stopped = lumen.load(minimal), list[str]()
    with (
        caplog.at_level(logging.ERROR),
        Exhibition(Plan(project, set_up("recording", project, "max"))) as exhibition,
    ):
        exhibition.services.add(0, Witness(stopped))
        exhibition.start()
        exhibition.run(seconds=1)
        assert exhibition.node.now >= 1
    assert f"the part `counter` is left out: {FAULTY}{told}" in caplog.text
    assert stopped == ["the part `counter` of the package lumen-counter 1.0"]


FAULTS = {
    "begin": "def begin(self, now): 1 / 0",
    "tick": "def tick(self, now, changes): 1 / 0",
    "tick with an error of Lumen": "def tick(self, now, changes): raise UsageError('the bottle is empty')",
    "tick that leaves": "def tick(self, now, changes): raise SystemExit(3)",
    "quiet_until": "def quiet_until(self, now): pass",
    "over": "over = property(lambda self: 1 / 0)",
    "failed": "failed = property(lambda self: 1 / 0)",
    "stepped": "def stepped(self, step): 1 / 0",
    "performing": "def performing(self, command, now): 1 / 0",
    "answered": "def answered(self, event): 1 / 0",
    "close": "def close(self): 1 / 0",
    "tick and close": "def tick(self, now, changes): 1 / 0\n    def close(self): exit()",
    "summary": "def summary(self): yield 7",
    "use": "def use(self, project): 1 / 0",
    "interrupt": "def interrupt(self): 1 / 0",
}


@pytest.mark.parametrize("case", FAULTS)
def test_an_exhibition_continues_without_a_part_that_fails(
    case: str, installed: Installed, minimal: Path, caplog: pytest.LogCaptureFixture
) -> None:
    code = COUNTER.format(make="return Counter()").replace("def make", f"    {FAULTS[case]}\n\ndef make")
    installed.write("lumen-counter", MANIFEST, counting_part=code)
    project, told = lumen.load(minimal), list[str]()
    narrator = RehearsalTrace(lambda: 0.0, lambda: project.machine, None)
    witness = Witness(told)
    with Exhibition(Plan(project, set_up("recording", project, "max"), narrator=narrator)) as exhibition:
        exhibition.services.add(0, witness)
        exhibition.start()
        assert exhibition.run(seconds=3.0) == pytest.approx(3.0)
        for part in exhibition.node.parts:
            part.quiet_until(3.0)
        exhibition.node.use(project)
        exhibition.node.summary()
        exhibition.node.failed  # noqa: B018  it is a property
        exhibition.node.interrupt()
        exhibition.tick()
    (line,) = [text for _, who, text in narrator.lines if who == "trouble" and "lumen-counter" in text]
    assert "package `lumen-counter` 1.0 is faulty: its part `counter` is stopped, because it raised" in line
    assert told == ["the part `counter` of the package lumen-counter 1.0"]
    assert "Traceback" in caplog.text


def test_the_first_interrupt_reaches_a_part(installed: Installed, minimal: Path) -> None:
    handler = "def interrupt(self):\n        self.steps = -1\n        return True"
    code = COUNTER.format(make="return Counter()").replace("def make", f"    {handler}\n\ndef make")
    installed.write("lumen-counter", MANIFEST, counting_part=code)
    project, stopped = lumen.load(minimal), list[str]()
    with Exhibition(Plan(project, set_up("recording", project, "max"))) as exhibition:
        exhibition.services.add(0, Witness(stopped))
        exhibition.start()
        counter = exhibition.services[resolve("counting_part:Counter")]
        assert counter.steps >= 0
        exhibition.node.interrupt()
        exhibition.tick()
        assert counter.steps == -1
        assert not exhibition.node.over
    assert stopped == []


class Witness(Part):
    """A part that keeps which other parts were stopped."""

    def __init__(self, told: list[str]) -> None:
        self._told = told

    def part_stopped(self, part: str) -> None:
        self._told.append(part)


RUN = "run", "--robot", "recording", "--format", "json"
STOPPED = (
    "the installed package `lumen-counter` 1.0 is faulty: its part `counter` is stopped, because it raised"
    " ZeroDivisionError: division by zero (update `lumen-counter`, or remove it: pip uninstall lumen-counter)"
)
BOX = """
from lumen.feature import BusRow, Feature, PartRow, Phase

FEATURE = Feature(
    name="counter",
    parts=(PartRow("counter", Phase.WATCH, "counting_part:make"),),
    buses={"box": BusRow("lumen.bus.memory:open_bus", ("box://NAME",))},
)
"""


def write_failing(installed: Installed, method: str, manifest: str = MANIFEST) -> None:
    """Install a part of which one method raises ZeroDivisionError."""
    code = COUNTER.format(make="return Counter()")
    installed.write("lumen-counter", manifest, counting_part=code.replace("def make", f"    {method}\n\ndef make"))


@pytest.mark.process
@pytest.mark.parametrize(
    ("words", "case"),
    [
        ("--speed max --for 1s", "tick"),
        ("--speed max --story visitor", "stepped"),
        ("--speed max --story visitor", "close"),
        ("--only robot --bus box://hall --for 100ms", "tick"),
        ("--only robot --bus box://hall --for 100ms", "summary"),
    ],
)
def test_a_run_without_a_part_that_failed_ends_with_trouble(
    words: str, case: str, installed: Installed, minimal: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_failing(installed, FAULTS[case].replace("yield 7", "1 / 0"), BOX)
    assert main([*RUN, *words.split(), str(minimal)]) == 1
    verdict, told = verdict_of(capsys)
    assert (verdict["ended"], verdict["failure"], verdict["summary"][0]) == ("troubled", STOPPED, STOPPED)
    assert "Ended with trouble: 0:0" in told
    assert f"\n  {STOPPED}\n" in told


@pytest.mark.process
@pytest.mark.parametrize("words", ["--for 1s", "--story visitor"])
def test_a_house_without_a_part_that_failed_ends_with_trouble(
    words: str, installed: Installed, minimal: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main_file = minimal / "lumen.yaml"
    one, two = "robot: {name: NAO, model: nao}", "robots: {ana: {model: nao}, ben: {model: nao}}"
    main_file.write_text(main_file.read_text().replace(one, two))
    code = COUNTER.format(make="counter = Counter()\n    counter.project = services.project\n    return counter")
    failing = "    def tick(self, now, changes): 1 / (self.project.robot == 'ana')\n\ndef make"
    installed.write("lumen-counter", MANIFEST, counting_part=code.replace("def make", failing))
    assert main([*RUN, "--speed", "max", *words.split(), str(minimal)]) == 1
    verdict, told = verdict_of(capsys)
    assert (verdict["ended"], verdict["failure"]) == ("troubled", f"ben: {STOPPED}")
    assert "Ended with trouble: 0:0" in told
    assert not [line for line in verdict["summary"] if line.startswith("ana: the installed")]


@pytest.mark.process
def test_a_run_without_a_part_that_cannot_be_made_ends_with_trouble(
    installed: Installed, minimal: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(installed, "1 / 0")
    assert main([*RUN, "--speed", "max", "--story", "visitor", str(minimal)]) == 1
    verdict, _ = verdict_of(capsys)
    assert verdict["ended"] == "troubled"
    assert verdict["failure"].startswith(f"the part `counter` is left out: {FAULTY}ZeroDivisionError")


@pytest.mark.process
def test_a_failed_story_is_not_excused_by_a_part_that_failed(
    installed: Installed, minimal: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_failing(installed, FAULTS["tick"])
    story = minimal / "behaviors/stories/visitor.yaml"
    story.write_text("title: Wrong\nsteps: [{expect: {state: goodbye}}]\n")
    assert main([*RUN, "--speed", "max", "--story", "visitor", str(minimal)]) == 1
    verdict, told = verdict_of(capsys)
    assert verdict["ended"] == "failed"
    assert "The story failed: " in told
    assert STOPPED in verdict["summary"]


def verdict_of(capsys: pytest.CaptureFixture[str]) -> tuple[dict[str, Any], str]:
    """Return what `lumen run --format json` printed: its object and its transcript."""
    printed = capsys.readouterr()
    return json.loads(printed.out), printed.err


def test_a_fault_of_a_part_of_lumen_ends_the_run(minimal: Path) -> None:
    class Faulty(Part):
        def tick(self, now: float, changes: Sequence[Event]) -> None:
            raise ZeroDivisionError

    with lumen.open(minimal, robot="recording") as exhibition:
        exhibition.services.add(0, Faulty())
        with pytest.raises(ZeroDivisionError):
            exhibition.run(seconds=1)


def test_an_alert_about_a_stopped_part_names_its_package(tmp_path: Path) -> None:
    told: list[tuple[str, ...]] = []
    desk: Any = lambda *alert: told.append(alert)  # noqa: E731
    desk.close = lambda: None
    with closing(AlertPart(desk, validated(MemoryBus(), lumen.load(ROOT)), tmp_path, ())) as alerts:
        alerts.part_stopped("the part `counter` of the package lumen-counter 1.0")
    name = "the part `counter` of the package lumen-counter 1.0"
    assert told == [("lost", f"{name} failed and is not running", name)]


def test_a_package_refuses_the_start_with_an_error_of_lumen(installed: Installed, minimal: Path) -> None:
    write(installed, "raise UsageError('the bottle is empty')")
    with pytest.raises(UsageError, match="the bottle is empty"):
        lumen.open(minimal, robot="recording")


@for_each(
    ("old", "new", "told"),
    [
        ("counting_part:make", "counting_part:gone", "AttributeError: module 'counting_part' has no attribute 'gone'"),
        ("counting_part:make", "gone:make", "ModuleNotFoundError: No module named 'gone'"),
        ('make"', 'make", "brian"', "the part `counter` has the unknown condition `brian`: use whole"),
    ],
)
def test_lint_reports_a_row_that_cannot_be_used(
    old: str, new: str, told: str, installed: Installed, minimal: Path
) -> None:
    write(installed, "return None", MANIFEST.replace(old, new))
    [message] = findings(minimal)
    assert message.startswith("the installed package `lumen-counter` 1.0 is faulty: ")
    assert told in message
