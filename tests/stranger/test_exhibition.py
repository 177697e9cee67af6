"""A stranger's robot, sense, bus, module, voice and function work wherever a user meets those of Lumen."""

from contextlib import closing
from pathlib import Path
from types import SimpleNamespace

import pytest

import lumen
from lumen.cli.main import main
from lumen.errors import ExpressionError, LumenError, UsageError
from lumen.expressions import Scope, compile_expression
from lumen.feature import resolve
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import complete
from lumen.features.editor.hover import hover
from lumen.features.editor.signatures import signature
from lumen.language.events import robot_events
from lumen.language.routes import route_meanings
from lumen.language.stories import Visitor
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.schema import load_schema
from lumen.robot.bounded_robot import BoundedRobot
from lumen.robot.remote import RemoteRobot
from lumen.run.exhibition import Exhibition
from lumen.run.making.modules import ModulesPlan
from lumen.run.parts.module import make_module
from lumen.run.plan import Plan
from lumen.run.presence import all_parts, unique_parts
from lumen.run.setup import set_up, set_up_house
from lumen.run.voices import speaker
from tests import ROOT
from tests.features.editor.test_services import place
from tests.stranger.installing import Installed, Lumen
from tests.waiting import HANG, until

HELLO, MAIN = "behaviors/hello.yaml", "lumen.yaml"


def findings(root: Path) -> list[str]:
    return [str(each.message) for each in check_files(root, read_files(root))[1]]


@pytest.mark.process
def test_lumen_run_performs_the_exhibition(stranger_lumen: Lumen, hall: Path) -> None:
    words = "--robot", "teddy", "--robot-voice", "high", "--story", "visitor", "--speed", "max"
    sound = "--voice", "growl", "--sound", "growls.wav"
    done = stranger_lumen(hall, "run", *words, *sound)
    assert done.returncode == 0, done.stderr
    assert "“HELLO!!”" in done.stdout
    assert (hall / "growls.wav").read_text() == "grrr HELLO!!"


@pytest.mark.process
def test_help_and_completion_list_its_rows(stranger_lumen: Lumen, hall: Path) -> None:
    shown = " ".join(stranger_lumen(hall, "run", "--help").stdout.split())
    for text in (
        "none,teddy}",
        "{none,espeak,growl}",
        "with --robot teddy: ",
        "answers, mood",
        "or postbox://hall",
    ):
        assert text in shown
    offered = stranger_lumen(hall, "completion", "words", ".run", ".--robot", ".te")
    assert offered.stdout.split() == ["teddy"]


def test_a_robot_is_opened_by_name_within_the_limits_of_its_body(stranger: Path, hall: Path) -> None:
    with lumen.open(hall, robot="teddy") as exhibition:
        exhibition.visitor.arrive(Visitor())
        exhibition.run(seconds=3)
        robot = exhibition.services.setup.robot
        assert isinstance(robot, BoundedRobot)
        assert robot.robot.said == ["deep: HELLO!!"]


def test_a_module_takes_part_in_an_exhibition(stranger: Path, hall: Path) -> None:
    entered: list[str] = []
    project = lumen.load(hall)
    plan = Plan(project, set_up("teddy", project, "max"), project.bus, options={"modules": ModulesPlan()})
    with Exhibition(plan) as exhibition:
        exhibition.observe(lambda step: entered.extend(step.entered))
        exhibition.start()
        exhibition.visitor.arrive(Visitor())
        exhibition.run(seconds=1)
        exhibition.node.bus.publish(exhibition.project.key_of("heard"), {"result": "a great and lovely bear"})

        def laughs() -> bool:
            exhibition.run(seconds=0.1)
            return "laughing" in entered

        until(laughs, HANG)


def test_an_option_belongs_to_the_robots_that_take_it(stranger: Path, hall: Path) -> None:
    project = lumen.load(hall)
    assert set_up("teddy", project, "max", options={"voice": "high"}).robot
    with pytest.raises(UsageError, match="--robot-voice needs --robot reachy or teddy"):
        set_up("recording", project, "max", options={"voice": "high"})
    with pytest.raises(UsageError, match="--robot-url needs --robot naoqi or reachy"):
        set_up("teddy", project, "max", options={"url": "nao.local"})
    assert set_up_house("teddy", {"a": project, "b": project}, "max", {"a": None, "b": None}).keys() == {"a", "b"}


def test_a_module_is_a_part_with_settings_and_events(stranger: Path, hall: Path, capsys) -> None:
    assert (all_parts()[-1], unique_parts()[-1]) == ("mood", "mood")
    assert {"mood.lost", "mood.back"} <= robot_events().keys()
    text = (hall / MAIN).read_text()
    (hall / MAIN).write_text(text.replace("cheerful: [", "cheeful: ["))
    (message,) = findings(hall)
    assert "cheeful" in message
    main(["schema", "lumen"])
    assert "How cheerful the visitors are" in capsys.readouterr().out
    analysis = Analysis(hall, read_files(hall))
    assert "cheerful" in {
        item.text.rstrip(": ") for item in complete(analysis, *place(analysis, MAIN, "true, |cheeful"))
    }
    analysis = analysis.changed(MAIN, text)
    assert "Words of cheerful visitors" in hover(analysis, *place(analysis, MAIN, "cheer|ful"))


def test_a_module_hears_and_publishes(stranger: Path, hall: Path) -> None:
    project, heard = lumen.load(hall), []
    with closing(lumen.bus.connect(project.bus)) as bus:
        bus.subscribe(project.key_of("mood"), lambda message: heard.append(message.body))
        module = make_module("mood", project, bus, heard.append, None)
        module.begin()
        bus.publish(project.key_of("heard"), {"result": "a great and lovely bear"})
        module.close()
    assert heard == [{"cheer": 2}]


def test_a_behaviour_hears_a_sense_through_its_route(stranger: Path, hall: Path) -> None:
    with lumen.open(hall, robot="teddy") as exhibition:
        exhibition.visitor.arrive(Visitor())
        exhibition.run(seconds=3)
        assert exhibition.configuration == {"content"}
        assert exhibition.robot.server.counts["slow_honey"].off == ""


def test_a_robot_in_another_process_has_the_sense(stranger: Path, hall: Path) -> None:
    project = lumen.load(hall)
    with closing(lumen.bus.connect("memory://")) as bus, closing(RemoteRobot(project, bus, lambda: 7.0)) as robot:
        assert robot.read_other("honey") is None
        bus.publish(project.key_of("honey"), {"pots": "many"})
        assert robot.read_other("honey") is None
        bus.publish(project.key_of("honey"), {"pots": 2, "time": 5.0})
        assert (robot.read_other("honey").pots, robot.time()) == (2, 5.0)


def test_lint_and_editor_know_the_sense(stranger: Path, hall: Path) -> None:
    assert route_meanings()["honey"] == "the pots of honey"
    analysis = Analysis(hall, read_files(hall))
    assert "honey" in {item.text for item in complete(analysis, *place(analysis, MAIN, "of: |honey"))}
    text = (hall / MAIN).read_text()
    (hall / MAIN).write_text(text.replace("of: honey", "of: honeycomb"))
    (message,) = findings(hall)
    assert "honey" in message


def test_a_scheme_opens_its_bus_and_is_allowed_in_a_project(stranger: Path, hall: Path) -> None:
    postbox = resolve("lumen_stranger.postbox:Postbox")
    posted = postbox.posted
    with closing(lumen.bus.connect("postbox://hall")) as bus:
        bus.publish("lumen.letter", {})
    assert postbox.posted == posted + 1
    assert findings(hall) == []
    assert load_schema("lumen")["properties"]["bus"]["pattern"] == "^(memory|amqp|amqps|postbox)://"
    with pytest.raises(lumen.BusAddressError, match="amqps://HOST or postbox://NAME"):
        lumen.bus.connect("pigeon://hall")


def test_a_function_is_checked_completed_and_described(stranger: Path, hall: Path) -> None:
    text = (hall / HELLO).read_text()
    for wrong, message in (
        ("shout('hello')", "takes 2 arguments"),
        ("shout('hello', true)", "a number is needed by `shout`"),
    ):
        (hall / HELLO).write_text(text.replace("shout('hello', 2)", wrong))
        assert [finding for finding in findings(hall) if message not in finding] == []
    analysis = Analysis(hall, read_files(hall)).changed(HELLO, text)
    assert "shout(" in {item.text for item in complete(analysis, *place(analysis, HELLO, "{{ sh|out"))}
    found = signature(analysis, *place(analysis, HELLO, "shout('hello', |2"))
    assert found
    assert (found.label, found.active) == ("shout(text: text, marks: number)", 1)
    assert found.documentation == "The text in capital letters, with exclamation marks. Returns text."


FUNCTIONS = """
from lumen.feature import Feature, FunctionRow

FEATURE = Feature(name="odd", functions={
    "odd": FunctionRow("odd_functions:odd", ("text",), "any"),
    "gone": FunctionRow("odd_functions:gone", (), "any"),
    "size": FunctionRow("odd_functions:odd", ("text",), "any"),
})
"""
ODD = """
def odd(text):
    return {"raises": lambda: 1 / 0, "nan": lambda: float("nan"), "object": object, "long": lambda: "x" * 10**6}[text]()
"""


def test_a_faulty_function_is_an_error_of_its_expression(installed: Installed) -> None:
    installed.write("odd", FUNCTIONS, odd_functions=ODD)
    for argument, message in (
        ("'raises'", "this can't be evaluated: `odd` raised ZeroDivisionError: division by zero"),
        ("'nan'", "`odd` returned a value that is not JSON data"),
        ("'object'", "`odd` returned a value that is not JSON data"),
        ("'long'", "the value becomes too large"),
        ("context.number", "but `odd` needs a text"),
    ):
        with pytest.raises(ExpressionError) as raised:
            compile_expression(f"odd({argument})")(Scope(context={"number": 1}))
        assert message in str(raised.value)
    with pytest.raises(ExpressionError, match="the function `gone` can't be imported: AttributeError"):
        compile_expression("gone()")
    assert compile_expression("size('abc')")(Scope()) == 3


FAULTY = """
from lumen.feature import BusRow, Feature, ModuleRow, RobotRow

FEATURE = Feature(
    name="faulty",
    robots={"gone": RobotRow("faulty_gone:set_up"), "broken": RobotRow("faulty_code:broken")},
    buses={"broken": BusRow("faulty_code:broken", ("broken://",))},
    modules={"broken": ModuleRow("faulty_code:Gone")},
    voices={"broken": "faulty_code:broken"},
)
"""
CODE = "def broken(*arguments): 1 / 0"


def test_faulty_code_of_a_package_is_an_error_that_names_it(installed: Installed) -> None:
    exhibit = lumen.load(ROOT)
    installed.write("faulty", FAULTY, faulty_code=CODE)
    bus, speaking = lumen.bus.connect("memory://"), SimpleNamespace(speak_with=print)
    for call, what in (
        (lambda: set_up("gone", exhibit, "max"), "No module named 'faulty_gone'"),
        (lambda: set_up("broken", exhibit, "max"), "`faulty_code:broken` raised ZeroDivisionError"),
        (lambda: lumen.bus.connect("broken://"), "`faulty_code:broken` raised ZeroDivisionError"),
        (lambda: make_module("broken", exhibit, bus, print, None), "has no attribute 'Gone'"),
        (lambda: speaker("broken", None, speaking, "en"), "`faulty_code:broken` raised ZeroDivisionError"),
    ):
        with pytest.raises(LumenError, match="the installed package `faulty`") as raised:
            call()
        assert what in str(raised.value)
