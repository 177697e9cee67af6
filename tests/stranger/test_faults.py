"""Faulty code of a package ends with a sentence that names the package; an exhibition continues without its module."""

import json
from pathlib import Path

import pytest

from lumen.bus import connect
from lumen.cli.main import main
from lumen.project import load
from lumen.run.exhibition import Exhibition
from lumen.run.making.modules import ModulesPlan
from lumen.run.parts.module import make_module
from lumen.run.plan import Plan
from lumen.run.rehearsal import RehearsalTrace
from lumen.run.setup import set_up
from tests import ROOT
from tests.copying import copied_project
from tests.leftovers import none_left
from tests.stranger.installing import Installed
from tests.waiting import HANG

MANIFEST = """\
from lumen.feature import *

FEATURE = Feature(name="faulty", {row})
"""
ROBOT = """\
from lumen.run.rehearsal import RehearsalTrace
from lumen.run.setup import set_up_with


class Robot:
    def start(self, id, command): 1 / 0
    def cancel(self, id): pass
    def poll(self): return ()
    def begun(self): return ()
    def read(self, sense): return None
    def close(self): pass


def make(request):
    return set_up_with(Robot())
"""
QUIET = ROBOT.replace("1 / 0", "pass")
BUS = "from lumen.bus.memory import MemoryBus\n\n\nclass make(MemoryBus):\n    def send(self, message): 1 / 0\n"
SILENT = BUS.replace("def send(self, message): 1 / 0", "def __init__(self, address, sender): super().__init__()")
CLOCK_ROW = "robots={'bot': RobotRow('faulty_code:make')}"
CLOCK = QUIET.replace("Robot())", "Robot(), Clock())") + "\n\nclass Clock:\n"
ODD = "from lumen.language.diagnostics import *\nODD = Code('odd', 'names', WARNING, 'is odd')\n"
RUN = "run --robot recording --speed max --story visitor"
FAULTS = {
    "robot without a method": (
        "robots={'bot': RobotRow('faulty_code:make')}",
        ROBOT.replace("def begun", "def beguns"),
        "run --robot bot",
        "`faulty_code:make` made a wrong object: a robot needs the method `begun`",
    ),
    "robot that is no setup": (
        "robots={'bot': RobotRow('faulty_code:make')}",
        "def make(request): return 7",
        "run --robot bot",
        "`faulty_code:make` returned 7 instead of a `lumen.run.setup.Setup`",
    ),
    "robot that raises": (
        "robots={'bot': RobotRow('faulty_code:make')}",
        ROBOT,
        "run --robot bot",
        "line 6 of `faulty_code` raised ZeroDivisionError: division by zero",
    ),
    "no bus": (
        "buses={'box': BusRow('faulty_code:make', ('box://',), '', True)}",
        "def make(address, sender): return 7",
        f"{RUN} --bus box://",
        "`faulty_code:make` made a wrong object: a bus needs the methods ",
    ),
    "bus that raises": (
        "buses={'box': BusRow('faulty_code:make', ('box://',), '', True)}",
        BUS.replace("def send", "def __init__(self, address, sender): super().__init__()\n    def send"),
        f"{RUN} --bus box://",
        "line 6 of `faulty_code` raised ZeroDivisionError: division by zero",
    ),
    "bus without the ends of subscriptions": (
        "buses={'box': BusRow('faulty_code:make', ('box://',), '', True)}",
        f"{SILENT}    def subscribe(self, *given): return 7",
        f"{RUN} --bus box://",
        "its bus `box` returned 7 from `subscribe`: it must return a function",
    ),
    "bus with a wrong count": (
        "buses={'box': BusRow('faulty_code:make', ('box://',), '', True)}",
        f"{SILENT}    dropped = 7",
        f"{RUN} --bus box://",
        "its bus `box` has 7 as `dropped`: it must be a Mapping",
    ),
    "bus with a wrong ability": (
        "buses={'box': BusRow('faulty_code:make', ('box://',), '', True)}",
        f"{SILENT}    def ability(self, kind): return 7",
        f"{RUN} --bus box://",
        "its bus `box` returned 7 from `ability`: it must return a `CountsDrops` or None",
    ),
    "bus that leaves": (
        "buses={'box': BusRow('faulty_code:make', ('box://',), '', True)}",
        f"{SILENT}    def carry(self, routes): exit(3)",
        f"{RUN} --bus box://",
        "line 6 of `faulty_code` raised SystemExit: 3",
    ),
    "bus that misuses Lumen": (
        "buses={'box': BusRow('faulty_code:make', ('box://',), '', True)}",
        f"{SILENT}    def send(self, message): super().send(None)",
        f"{RUN} --bus box://",
        "its bus `box` raised TypeError: cannot unpack non-iterable NoneType object from `send`",
    ),
    "clock without a time": (
        CLOCK_ROW,
        f"{CLOCK}    def now(self): pass\n    def wait(self, until): pass\n",
        "run --robot bot --for 1s",
        "the clock of its robot `bot` returned None from `now`: it must return a finite number",
    ),
    "clock with a wrong speed": (
        CLOCK_ROW,
        f"{CLOCK}    speed = 'fast'\n    def now(self): return 0.0\n    def wait(self, until): pass\n",
        "run --robot bot --for 1s",
        "the clock of its robot `bot` has the speed 'fast': it must be a number or None",
    ),
    "clock that stops": (
        CLOCK_ROW,
        f"{CLOCK}    def now(self): return 0.0\n    def wait(self, until): 1 / 0\n",
        "run --robot bot --for 1s",
        "line 20 of `faulty_code` raised ZeroDivisionError: division by zero",
    ),
    "clock that loses the time": (
        CLOCK_ROW,
        f"{CLOCK}    time = 0.0\n    def now(self): return self.time\n    def wait(self, until): self.time = 'late'\n",
        "run --robot bot --for 1s",
        "the clock of its robot `bot` returned 'late' from `now`: it must return a finite number",
    ),
    "importer": (
        "importers={'.odd': Importer('behavior', 'faulty_code:read')}",
        "def read(*given): 1 / 0",
        "import a.odd",
        "line 1 of `faulty_code` raised ZeroDivisionError: division by zero",
    ),
    "importer of nothing": (
        "importers={'.odd': Importer('behavior', 'faulty_code:read')}",
        "def read(*given): pass",
        "import a.odd",
        "`faulty_code:read` returned None instead of data and diagnostics",
    ),
    "exporter": (
        "exporters={'odd': Exporter('behavior', 'faulty_code:write')}",
        "def write(machine): pass",
        "export odd",
        "its module `faulty_code:write` raised TypeError: write() takes 1 positional argument but 2 were given",
    ),
    "format of findings": (
        "finding_formats={'odd': 'faulty_code:render'}",
        "def render(found): pass",
        "lint --format odd",
        "its module `faulty_code:render` raised TypeError: render() got an unexpected keyword argument 'coloured'",
    ),
    "robot that leaves": (
        "robots={'bot': RobotRow('faulty_code:make')}",
        ROBOT.replace("1 / 0", "raise SystemExit(0)"),
        "run --robot bot",
        "line 6 of `faulty_code` raised SystemExit: 0",
    ),
    "robot without events": (
        "robots={'bot': RobotRow('faulty_code:make')}",
        QUIET.replace("poll(self): return ()", "poll(self): pass"),
        "run --robot bot",
        "its robot `bot` returned None from `poll`: it must return events",
    ),
    "robot with wrong events": (
        "robots={'bot': RobotRow('faulty_code:make')}",
        QUIET.replace("poll(self): return ()", "poll(self): return ['fallen']"),
        "run --robot bot",
        "its robot `bot` returned ['fallen'] from `poll`: it must return events",
    ),
    "robot with wrong ids": (
        "robots={'bot': RobotRow('faulty_code:make')}",
        QUIET.replace("begun(self): return ()", "begun(self): return 'c1'"),
        "run --robot bot",
        "its robot `bot` returned 'c1' from `begun`: it must return ids of commands",
    ),
    "importer of wrong diagnostics": (
        "importers={'.odd': Importer('controller', 'faulty_code:read')}",
        "def read(*given): return {}, ['lost']",
        "import a.odd",
        "`faulty_code:read` returned ({}, ['lost']) instead of data and diagnostics",
    ),
    "importer of no motion": (
        "importers={'.odd': Importer('motion', 'faulty_code:read')}",
        "def read(*given): return {}, []",
        "import a.odd",
        "`faulty_code:read` returned ({}, []) instead of the curves of joints",
    ),
    "importer that leaves": (
        "importers={'.odd': Importer('behavior', 'faulty_code:read')}",
        "raise SystemExit('gone')",
        "import a.odd",
        "its module `faulty_code:read` raised SystemExit: gone",
    ),
    "exporter of nothing": (
        "exporters={'odd': Exporter('behavior', 'faulty_code:write')}",
        "def write(*given): pass",
        "export odd",
        "`faulty_code:write` returned None instead of a text and diagnostics",
    ),
    "exporter of no diagram": (
        "exporters={'odd': Exporter('diagram', 'faulty_code:write')}",
        "def write(*given): return 7",
        "export odd",
        "`faulty_code:write` returned 7 instead of a text",
    ),
    "exporter of no project": (
        "exporters={'odd': Exporter('project', 'faulty_code:write')}",
        "def write(*given): raise SystemExit(7)",
        "export odd",
        "its module `faulty_code:write` raised SystemExit: 7",
    ),
    "format of findings without text": (
        "finding_formats={'odd': 'faulty_code:render'}",
        "def render(found, coloured): pass",
        "lint --format odd",
        "`faulty_code:render` returned None instead of a text",
    ),
    "format of verdicts without text": (
        "verdict_formats={'odd': 'faulty_code:render'}",
        "def render(verdict): pass",
        "test --format odd",
        "`faulty_code:render` returned None instead of a text",
    ),
    "pages that leave": (
        "codes=('faulty_code',), pages=('faulty_code:pages',)",
        f"{ODD}def __getattr__(name): raise SystemExit",
        "explain odd",
        "its module `faulty_code:pages` raised SystemExit: ",
    ),
    "pages of no package": (
        "codes=('faulty_code',), pages=('faulty_code:pages',)",
        f"{ODD}pages = 7",
        "explain odd",
        "its module `faulty_code:pages` raised ",
    ),
    "subcommand that leaves": (
        "subcommands={'odd': Subcommand('be odd', 'faulty_code')}",
        "raise SystemExit(3)",
        "odd",
        "its module `faulty_code` raised SystemExit: 3",
    ),
    "subcommand without run": (
        "subcommands={'odd': Subcommand('be odd', 'faulty_code')}",
        "def configure(parser): pass",
        "odd",
        "its module `faulty_code` raised AttributeError: module 'faulty_code' has no attribute 'run'",
    ),
    "subcommand that raises": (
        "subcommands={'odd': Subcommand('be odd', 'faulty_code')}",
        "def configure(parser): pass\ndef run(options): open('missing')",
        "odd",
        "line 2 of `faulty_code` raised FileNotFoundError: ",
    ),
    "subcommand without an exit code": (
        "subcommands={'odd': Subcommand('be odd', 'faulty_code')}",
        "def configure(parser): pass\ndef run(options): pass",
        "odd",
        "`run` of its subcommand returned None, which is no exit code",
    ),
}


@pytest.fixture
def hall(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    root = copied_project(ROOT / "examples/minimal", tmp_path / "hall")
    (root / "a.odd").write_text("odd")
    monkeypatch.chdir(root)
    return root


@pytest.mark.process
@pytest.mark.parametrize("case", FAULTS)
def test_faulty_code_ends_with_a_sentence_that_names_its_package(
    case: str, installed: Installed, hall: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    row, code, words, fault = FAULTS[case]
    installed.write("faulty", MANIFEST.format(row=row), version="1.2", faulty_code=code)
    assert main(words.split()) == 2
    verb, told = words.split()[0], capsys.readouterr().err.splitlines()[-1]
    assert told.startswith(f"lumen {verb}: the installed package `faulty` 1.2 is faulty: {fault}")


@pytest.mark.process
def test_an_alert_about_the_end_of_a_run_names_the_package(installed: Installed, hall: Path) -> None:
    row, code, words, _ = FAULTS["robot that raises"]
    installed.write("faulty", MANIFEST.format(row=row), version="1.2", faulty_code=code)
    program = hall / "told.sh"
    program.write_text("#!/bin/sh\ncat > told.json\n")
    program.chmod(0o755)
    main_file = hall / "lumen.yaml"
    main_file.write_text(f"{main_file.read_text()}\nalerts: {{to: [{{command: [./told.sh]}}]}}\n")
    assert main(words.split()) == 2
    told = json.loads((hall / "told.json").read_text())
    assert "it ended because of a fault in the package faulty 1.2 (ZeroDivisionError)" in told["text"]


MODULE = "from lumen.run.module import Module\n\n\nclass Mood(Module):\n    "
CURVES = """
from lumen.project.formats.joint_curves import CurvePoint
from lumen.language.diagnostics import Place
"""
ROW = "modules={'mood': ModuleRow('faulty_code:Mood')}"
MODULES = {
    "is no module": ("class Mood: pass", "is no subclass of `lumen.run.module.Module`"),
    "can't be made": (f"{MODULE}def __init__(self, *given): 1 / 0", "raised ZeroDivisionError"),
    "can't begin": (f"{MODULE}def begin(self): 1 / 0", "raised ZeroDivisionError"),
    "is left out by its own error": (
        f"from lumen.errors import ModuleError\n{MODULE}def begin(self): raise ModuleError('no microphone')",
        "raised ModuleError: no microphone",
    ),
    "leaves": (f"{MODULE}def begin(self): raise SystemExit(1)", "raised SystemExit: 1"),
    "leaves at its import": ("raise SystemExit(1)", "raised SystemExit: 1"),
    "makes no module": (f"{MODULE}@classmethod\n    def make(cls, *given): return 7", "returned 7 instead of a module"),
    "lists no routes": (f"{MODULE}hears = ('heard',)", "raised TypeError"),
    "can't end": (f"{MODULE}def hears(self): return {{}}\n    def close(self): 1 / 0", "raised ZeroDivisionError"),
}


def told_by(code: str, installed: Installed, hall: Path) -> list[str]:
    """Return what the exhibition reports of a package's module with this code in a second."""
    installed.write("faulty", MANIFEST.format(row=ROW), faulty_code=code)
    main_file = hall / "lumen.yaml"
    main_file.write_text(f"{main_file.read_text()}\nmodules: {{mood: {{here: true}}}}\n")
    project = load(hall)
    narrator = RehearsalTrace(lambda: 0.0, lambda: project.machine, None)
    plan = Plan(project, set_up("recording", project, "max"), narrator=narrator, options={"modules": ModulesPlan()})
    with Exhibition(plan) as exhibition:
        exhibition.start()
        assert exhibition.run(seconds=1.0) == pytest.approx(1.0)
    return [text for _, who, text in narrator.lines if who == "mood"]


@pytest.mark.parametrize("case", MODULES)
def test_an_exhibition_goes_on_without_a_faulty_module(case: str, installed: Installed, hall: Path) -> None:
    code, fault = MODULES[case]
    (line,) = told_by(code, installed, hall)
    assert "the installed package `faulty` 1.0 is faulty" in line
    assert fault in line


def test_the_thread_of_a_module_ends_although_its_own_close_does_nothing(installed: Installed, hall: Path) -> None:
    with none_left():
        told_by(f"{MODULE}def hears(self): return {{}}\n    def close(self): pass", installed, hall)


def test_a_fault_on_a_message_is_told_with_the_name_of_the_package(installed: Installed, hall: Path) -> None:
    handler = "def hears(self): return {'heard': self.heed}\n    def heed(self, message): raise SystemExit(4)"
    installed.write("faulty", MANIFEST.format(row=ROW), faulty_code=f"{MODULE}{handler}")
    project, told = load(hall), list[str]()
    bus = connect("memory://")
    module = make_module("mood", project, bus, told.append, None)
    module.begin()
    bus.publish(module.key("heard"), {"result": "hello"})
    assert module.settle(HANG)
    module.close()
    (line,) = told
    assert line.startswith("the installed package `faulty` 1.0 is faulty: line 6 of `faulty_code` raised SystemExit: 4")


def test_a_subcommand_of_a_package_may_leave_the_program(installed: Installed, hall: Path) -> None:
    row = "subcommands={'odd': Subcommand('be odd', 'faulty_code')}"
    code = "def configure(parser): pass\ndef run(options): raise SystemExit(5)"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=code)
    with pytest.raises(SystemExit) as raised:
        main(["odd"])
    assert raised.value.code == 5


def test_a_motion_of_a_package_is_imported(
    installed: Installed, hall: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    curves = "{'HeadYaw': [CurvePoint(1.0, 0.2, Place('a.odd'))]}"
    code = f"{CURVES}\ndef read(file, findings): return {curves}"
    row = "importers={'.odd': Importer('motion', 'faulty_code:read')}"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=code)
    assert main(["import", "a.odd"]) == 0
    assert "HeadYaw" in capsys.readouterr().out
