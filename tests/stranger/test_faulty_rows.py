"""Faults of rows that lint, expressions, senses, voices and forgetting use: each costs its row alone."""

import json
import logging
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.bus import connect
from lumen.cli.main import main
from lumen.clock.checked import ability
from lumen.errors import ExpressionError, LumenError, Refused
from lumen.expressions import Scope, compile_expression
from lumen.feature import features, owner, resolve, table
from lumen.language.people import PersonName
from lumen.lint import check_files
from lumen.lint.fixes import fixes
from lumen.ports import Dozes, HasSpeed, Joints, MeasuresPace, Message, Sense
from lumen.project.files import read_files
from lumen.robot.command_table import speech_duration
from lumen.robot.remote import RemoteRobot
from lumen.robot.sense_codec import decode_reading, encode_reading
from lumen.run.forgetting.added import FeatureForgetter
from lumen.run.setup import set_up
from lumen.run.voices import AddedVoice
from tests import ROOT
from tests.copying import copied_project
from tests.stranger.installing import Installed

BASE = ROOT / "tests/lint/pages/base"
MANIFEST = "from lumen.feature import *\n\nFEATURE = Feature(name='faulty', {row})\n"
PREFIX = "the installed package `faulty` 1.0 is faulty: "
CODES = "from lumen.language.diagnostics import *\nODD = Code('odd', 'names', WARNING, 'is odd')\n"
CHECK = f"{CODES}def check(draft):\n    "
RULES = "rules=('faulty_code:check',)"
SECTION = "sections={'hall': Section('faulty_code:read')}"
LINT = {
    "manifest that leaves": ("", "", "its manifest `faulty:FEATURE` raised SystemExit: 3"),
    "feature without a name": ("name=None", "", "the name of its feature is `None`, which is no text"),
    "row without a name": (
        "verbs={3: VerbRow('faulty_code')}",
        "",
        "`verbs` of its manifest has the name `3`, which is no text",
    ),
    "rule that leaves": (RULES, f"{CHECK}raise SystemExit", "its rule `faulty_code:check` raised SystemExit: "),
    "rule whose module leaves": (RULES, "exit(2)", "its rule `faulty_code:check` raised SystemExit: 2"),
    "rule with an error of its own": (
        RULES,
        "class Odd(BaseException): pass\ndef check(draft): raise Odd('no')",
        "its rule `faulty_code:check` raised Odd: no",
    ),
    "rule that yields": (RULES, f"{CHECK}yield 3", "its rule `faulty_code:check` returned <generator object check"),
    "rule that returns": (
        RULES,
        f"{CHECK}return [3]",
        "its rule `faulty_code:check` returned [3]: a rule reports its findings, and returns None",
    ),
    "rule that adds no finding": (
        RULES,
        f"{CHECK}draft.loose.append(7)",
        "its rule `faulty_code:check` reported 7, which is no finding",
    ),
    "rule that replaces a part of the draft": (
        RULES,
        f"{CHECK}draft.behaviors = None",
        "its rule `faulty_code:check` changed `behaviors` of the draft: a rule reads the draft, and reports findings",
    ),
    "rule that deletes a part of the draft": (
        RULES,
        f"{CHECK}del draft.reports",
        "its rule `faulty_code:check` changed `reports` of the draft: ",
    ),
    "rule that changes an entry of the draft": (
        RULES,
        f"{CHECK}draft.behaviors['empty'] = None",
        "its rule `faulty_code:check` changed `behaviors` of the draft: ",
    ),
    "rule that empties a part of the draft": (
        RULES,
        f"{CHECK}draft.reports.clear()",
        "its rule `faulty_code:check` changed `reports` of the draft: ",
    ),
    "rule that replaces a part of a report": (
        RULES,
        f"{CHECK}draft.main.diagnostics = None",
        "its rule `faulty_code:check` changed `reports.diagnostics` of the draft: ",
    ),
    "rule that adds to a set of the draft": (
        RULES,
        f"{CHECK}draft.missing.add('behaviors')",
        "its rule `faulty_code:check` changed `missing` of the draft: ",
    ),
    "rule without a place": (
        RULES,
        f"{CHECK}draft.loose.append(ODD.at(None, 'is odd'))",
        "its rule `faulty_code:check` reported Diagnostic(",
    ),
    "rule with a code of another type": (
        RULES,
        "from lumen.language.diagnostics import *\nODD = Code('odd', 7, 'bad', None)\n"
        "def check(draft): draft.main(ODD, ('name',), 'is odd')",
        "its rule `faulty_code:check` reported Diagnostic(",
    ),
    "part that can't be imported": (
        "parts=(PartRow('odd', Phase.WATCH, 'faulty_code:make'),)",
        "raise SystemExit",
        "its module `faulty_code:make` raised SystemExit: ",
    ),
}


@pytest.mark.parametrize("case", LINT)
def test_lint_reports_a_faulty_row_once_and_names_its_package(case: str, installed: Installed) -> None:
    row, code, fault = LINT[case]
    manifest = MANIFEST.format(row=row).replace("name='faulty', name=None", "name=None") if row else "exit(3)"
    installed.write("faulty", manifest, faulty_code=code)
    (finding,) = check_files(BASE, read_files(BASE))[1]
    assert finding.code == "broken-feature"
    assert finding.message.startswith(PREFIX + fault)


def test_what_a_package_prints_does_not_reach_the_json_of_lint(
    installed: Installed, capsys: pytest.CaptureFixture[str]
) -> None:
    manifest = f"print('a manifest')\n{MANIFEST.format(row=RULES)}"
    installed.write("faulty", manifest, faulty_code="print('a module')\ndef check(draft): print('a rule')")
    main(["lint", str(BASE), "--format", "json"])
    printed = capsys.readouterr()
    assert json.loads(printed.out)["diagnostics"] == []
    assert printed.err.split("\n")[:3] == ["a manifest", "a module", "a rule"]


OPTIONS = "modules={{'mood': ModuleRow('faulty_code:Mood', '', {{'odd': {schema}, 'even': {{'type': 'integer'}}}})}}"


@pytest.mark.parametrize("schema", ["{'type': 'text'}", "{'$ref': '#/$defs/here'}", "{'pattern': '('}"])
def test_lint_reports_an_option_whose_schema_cannot_be_used_and_checks_the_others(
    schema: str, installed: Installed
) -> None:
    installed.write("faulty", MANIFEST.format(row=OPTIONS.format(schema=schema)))
    files = read_files(BASE)
    options = f"\nmodules: {{mood: {{odd: 7, even: half}}}}  # {schema}\n"
    found = check_files(BASE, {**files, "lumen.yaml": files["lumen.yaml"] + options.encode()})[1]
    broken, wrong = sorted(found, key=lambda each: each.code != "broken-feature")
    fault = "the schema of the option `odd` of its module `mood` is no JSON Schema, or has `$ref`"
    assert (broken.code, broken.message) == ("broken-feature", PREFIX + fault)
    assert (wrong.code, wrong.message) == ("wrong-type", "`even` should be a whole number, not a text")


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("def read(data, report): pass", "TypeError: `faulty_code:read` returns no dataclass"),
        ("def read(data, report): raise SystemExit('no')", "SystemExit: no"),
        ("raise SystemExit", "SystemExit: "),
    ],
)
def test_lint_reports_a_faulty_reader_of_a_section(code: str, fault: str, installed: Installed) -> None:
    installed.write("faulty", MANIFEST.format(row=SECTION), faulty_code=code)
    files = read_files(BASE)
    files = {
        **files,
        "lumen.yaml": files["lumen.yaml"] + f"\nhall: {{}}  # {fault}\n".encode(),
    }  # a file of the same text is not read again
    (finding,) = [each for each in check_files(BASE, files)[1] if each.code == "broken-feature"]
    assert finding.message == f"{PREFIX}reading `hall` raised {fault}"


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("def repair(*given): pass", "`faulty_code:repair` returned None instead of a list of `Fix`"),
        ("def repair(*given): return [3]", "`faulty_code:repair` returned [3] instead of a list of `Fix`"),
        ("def repair(*given): raise SystemExit", "its module `faulty_code:repair` raised SystemExit: "),
    ],
)
def test_a_faulty_repair_is_an_error_that_names_its_package(code: str, fault: str, installed: Installed) -> None:
    check = f"{CODES}def check(draft): draft.main(ODD, ('name',), 'is odd')\n"
    row = f"{RULES}, fixes={{'odd': 'faulty_code:repair'}}"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=check + code)
    files = read_files(BASE)
    (finding,) = check_files(BASE, files)[1]
    with pytest.raises(LumenError) as raised:
        fixes(finding, files)
    assert str(raised.value).startswith(PREFIX + fault)


def test_lint_makes_the_other_repairs_and_names_the_package_of_a_faulty_one(
    installed: Installed, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    check = f"{CODES}def check(draft): draft.main(ODD, ('name',), 'is odd')\ndef repair(*given): return 3\n"
    row = f"{RULES}, fixes={{'odd': 'faulty_code:repair'}}"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=check)
    project = copied_project(BASE, tmp_path / "project")
    wrong = (project / "lumen.yaml").read_text().replace("name:", "nmae:")
    (project / "lumen.yaml").write_text(f"{wrong}\n")
    main(["lint", str(project), "--fix"])
    said = capsys.readouterr().err
    assert said.startswith(f"{PREFIX}`faulty_code:repair` returned 3 instead of a list of `Fix` (update")
    assert "[unknown-key]" in said
    assert "name:" in (project / "lumen.yaml").read_text()


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("def odd(): 1 / 0", "`odd` raised ZeroDivisionError: division by zero"),
        ("def odd(): raise SystemExit(1)", "`odd` raised SystemExit: 1"),
        ("raise SystemExit(1)", "the function `odd` can't be imported: SystemExit: 1"),
        ("def odd(): return {1}", "`odd` returned a value that is not JSON data"),
        ("def odd(): return 'x'", "`odd` returned text, but its row says number"),
    ],
)
def test_a_faulty_function_names_its_package(code: str, fault: str, installed: Installed) -> None:
    row = "functions={'odd': FunctionRow('faulty_code:odd', (), 'number')}"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=code)
    with pytest.raises(ExpressionError) as raised:
        compile_expression("odd()")(Scope())
    assert fault in raised.value.message
    assert raised.value.message.endswith("(package faulty 1.0)")


@pytest.mark.parametrize(
    ("reading", "fault"),
    [
        (0.7, "returned 0.7 from `read`: it must return a `lumen.ports.Reading` or None"),
        (Joints(0.0, ("HeadYaw",), (), ()), "from `read`: it must return an angle and a stiffness for each name"),
    ],
)
@pytest.mark.parametrize("bounded", [True, False])
def test_a_wrong_reading_of_a_robot_names_its_package(
    reading: Any, fault: str, bounded: bool, installed: Installed
) -> None:
    row = f"robots={{'bot': RobotRow('faulty_code:make', bounded={bounded})}}"
    code = "from lumen.run.setup import set_up_with\nfrom lumen.robot.none import NoRobot\nROBOT = NoRobot()\n"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=f"{code}def make(r): return set_up_with(ROBOT)")
    resolve("faulty_code:ROBOT").read = lambda sense: reading
    robot = set_up("bot", lumen.load(ROOT / "examples/minimal"), "max").robot
    with pytest.raises(LumenError) as raised:
        robot.read(Sense.JOINT)
    assert str(raised.value).startswith(f"{PREFIX}its robot `bot` returned ")
    assert fault in str(raised.value)


SENSE = "senses={'honey': SenseRow('the honey', 'faulty_code:encode', 'faulty_code:decode')}"


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("pass", "returned None instead of the body of a message"),
        ("return [1]", "returned [1] instead of the body of a message"),
        ("raise SystemExit", "raised SystemExit: "),
        ("1 / 0", "raised ZeroDivisionError: division by zero"),
    ],
)
def test_a_faulty_encoder_of_a_sense_names_its_package(code: str, fault: str, installed: Installed) -> None:
    installed.write("faulty", MANIFEST.format(row=SENSE), faulty_code=f"def encode(reading):\n    {code}")
    with pytest.raises(LumenError) as raised:
        encode_reading("honey", object())  # type: ignore[arg-type]
    assert str(raised.value).startswith(PREFIX)
    assert fault in str(raised.value)


def test_a_faulty_decoder_of_a_sense_costs_its_message(installed: Installed) -> None:
    code = "def decode(body, joints):\n    return body['honey'] if 'honey' in body else exit(body['code'])"
    installed.write("faulty", MANIFEST.format(row=SENSE), faulty_code=code)
    assert decode_reading("honey", {"honey": None}, ()) is None
    assert decode_reading("honey", {}, ()) is None
    for body, fault in (({"honey": 7}, "returned 7 instead of a reading or None"), ({"code": 1}, "SystemExit: 1")):
        with pytest.raises(LumenError, match=fault) as raised:
            decode_reading("honey", body, ())
        assert str(raised.value).startswith(PREFIX)


def test_a_robot_in_another_process_refuses_what_a_decoder_cannot_read(installed: Installed, tmp_path: Path) -> None:
    installed.write("faulty", MANIFEST.format(row=SENSE), faulty_code="def decode(body, joints): return 7")
    project = lumen.load(ROOT / "examples/minimal")
    with closing(connect("memory://")) as bus, closing(RemoteRobot(project, bus, lambda: 7.0)) as robot:
        with pytest.raises(Refused, match="returned 7 instead of a reading"):
            robot._sense("honey", Message("honey", {"pots": 2}))
        assert robot.read_other("honey") is None


VOICE = "voices={'growl': 'faulty_code:Growl'}"
GROWL = "class Growl:\n    words = ()\n    mute = False\n    def __init__(self, *given): pass\n"
REST = "    def end(self, now): raise SystemExit\n    def close(self): pass\n"


@pytest.mark.parametrize(
    ("begin", "fault"),
    [
        ("pass", "TypeError: `begin` returned None instead of a number of seconds"),
        ("return 'soon'", "TypeError: `begin` returned 'soon' instead of a number of seconds"),
        ("return -1", "TypeError: `begin` returned -1 instead of a number of seconds"),
        ("1 / 0", "ZeroDivisionError: division by zero"),
        ("return 1.5", "SystemExit: "),
    ],
)
def test_a_voice_is_silent_after_its_first_fault(
    begin: str, fault: str, installed: Installed, caplog: pytest.LogCaptureFixture
) -> None:
    code = f"{GROWL}    def begin(self, *given):\n        {begin}\n{REST}"
    installed.write("faulty", MANIFEST.format(row=VOICE), faulty_code=code)
    voice = AddedVoice(resolve(table("voices")["growl"])(), owner("voices", "growl"), "growl")
    for _ in range(2):
        voice.begin("Hello!", "en", 1.0, 0.0)
        voice.end(1.0)
    assert voice.begin("Hello!", "en", 1.0, 2.0) == speech_duration("Hello!")
    voice.close()
    (record,) = caplog.records
    assert record.getMessage() == f"{PREFIX}its voice `growl` raised {fault}; the robot is silent from now on"


SUBSCRIBER = """
from lumen.run.parts.part import Part

def make(services):
    services.bus.subscribe("lumen.#", heed)
    return Part()

def heed(message):
    if message.key == "lumen.bad":
        {code}
"""


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("1 / 0", "ZeroDivisionError: division by zero"),
        ("exit(3)", "SystemExit: 3"),
        ("Part().leap()", "TypeError: Part.leap() missing 1 required positional argument: 'now'"),
    ],
)
def test_an_exhibition_continues_after_the_fault_of_a_subscriber(
    code: str, fault: str, installed: Installed, caplog: pytest.LogCaptureFixture
) -> None:
    row = "parts=(PartRow('odd', Phase.WATCH, 'faulty_code:make'),)"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=SUBSCRIBER.format(code=code))
    heard: list[str] = []
    with lumen.open(ROOT / "examples/minimal", robot="recording") as exhibition:
        bus = exhibition.services.bus
        bus.subscribe("lumen.bad", lambda message: heard.append(message.key))
        for _ in range(2):
            bus.publish("lumen.bad", {})
        assert exhibition.run(seconds=1) == pytest.approx(1)
        [line] = exhibition.node.faults
    assert heard == ["lumen.bad"] * 2
    assert line.startswith(f"{PREFIX}its subscriber of `lumen.#` raised {fault} (update `faulty`")
    [record] = [record for record in caplog.records if record.levelno >= logging.ERROR]
    assert record.getMessage() == line


def test_the_fault_of_a_subscriber_of_lumen_stays_one(caplog: pytest.LogCaptureFixture) -> None:
    with lumen.open(ROOT / "examples/minimal", robot="recording") as exhibition:
        exhibition.services.bus.subscribe("lumen.bad", lambda message: exhibition.tick(1))  # type: ignore[call-arg]
        exhibition.services.bus.publish("lumen.bad", {})
        assert exhibition.node.faults == []
    assert "a subscriber of `lumen.bad` failed on `lumen.bad`" in caplog.text


@pytest.mark.parametrize(
    ("old", "new", "call", "fault"),
    [
        ("return until", "return 'late'", lambda clock: clock.doze(3.0), "returned 'late' from `doze`"),
        ("realtime = 4.0, 0.5", "realtime = 4.0, None", lambda clock: clock.realtime, "returned None from `realtime`"),
    ],
)
def test_a_wrong_time_of_a_clock_names_its_package(
    old: str, new: str, call: Callable[[Any], object], fault: str, installed: Installed
) -> None:
    row = MANIFEST.format(row="robots={'bot': RobotRow('faulty_code:make')}")
    assert old in CLOCK
    installed.write("faulty", row, faulty_code=CLOCK.replace(old, new))
    clock = set_up("bot", lumen.load(ROOT / "examples/minimal"), "max").clock
    with pytest.raises(LumenError) as raised:
        call(clock)
    expected = f"{PREFIX}the clock of its robot `bot` {fault}: it must return a finite number"
    assert str(raised.value).startswith(expected)


def test_a_clock_of_a_package_keeps_its_abilities(installed: Installed) -> None:
    installed.write("faulty", MANIFEST.format(row="robots={'bot': RobotRow('faulty_code:make')}"), faulty_code=CLOCK)
    clock = set_up("bot", lumen.load(ROOT / "examples/minimal"), "max").clock
    assert isinstance(clock, Dozes)
    assert isinstance(clock, MeasuresPace)
    assert (clock.now(), clock.doze(3.0), clock.realtime) == (1.0, 3.0, 0.5)
    paced = ability(clock, HasSpeed)
    assert paced
    assert paced.speed == 4.0
    clock.hurry()
    clock.wait(2.0)


CLOCK = """
from lumen.run.setup import Setup
from lumen.robot.none import NoRobot

class Clock:
    speed, realtime = 4.0, 0.5
    def now(self): return 1.0
    def wait(self, until): pass
    def doze(self, until): return until
    def hurry(self): pass

def make(request):
    return Setup(NoRobot(), Clock(), None)
"""


def test_a_forgetter_that_leaves_keeps_no_other_from_forgetting(
    installed: Installed,
) -> None:
    code = "FORGOTTEN = []\ndef leave(person): exit()\ndef forget(person): FORGOTTEN.append(person.key)"
    row = "forgets=('faulty_code:leave', 'faulty_code:forget')"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=code)
    told = list[str]()
    FeatureForgetter(lambda kind: None, told.append).forget(PersonName("Ani"))
    forgotten: Any = resolve("faulty_code:FORGOTTEN")
    assert forgotten == ["ani"]
    (fault,) = told
    assert "`faulty` 1.0 is faulty: `faulty_code:leave` raised SystemExit and did not forget a person" in fault


def test_a_faulty_row_keeps_the_others_of_its_package(installed: Installed) -> None:
    installed.write("faulty", MANIFEST.format(row=RULES), faulty_code="def check(draft): exit()")
    assert features()[-1].name == "faulty"
