"""A faulty package breaks neither a command nor other packages: each fault is a sentence that names its package."""

from pathlib import Path

import pytest
from written_distribution import on_path, write_distribution

import lumen
from lumen.cli.main import main
from lumen.errors import ExpressionError
from lumen.expressions import Scope, compile_expression
from lumen.feature import VerbRow, features
from lumen.language.added_verbs import arguments_of, durations_of, short_argument
from lumen.lint import check_files
from lumen.project.broken_features import shown
from lumen.project.files import read_files
from lumen.project.formats.importers import recognised
from lumen.run.forgetting.added import Forgetting
from lumen.run.forgetting.files import forget_in
from tests import ROOT
from tests.copying import copied_project
from tests.stranger.installing import Installed
from tests.tables import for_each

MANIFEST = "from lumen.feature import *\n\nFEATURE = Feature(name='faulty', {row})\n"
FAULT = "the installed package `faulty` 1.0 is faulty: "
MUTE = "class Odd(Exception):\n    def __str__(self): return None\n    __repr__ = __str__\n"
RUN = ("run", "--robot", "recording", "--speed", "max", "--story", "visitor")


@pytest.fixture
def hall(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    root = copied_project(ROOT / "examples/minimal", tmp_path / "hall")
    monkeypatch.chdir(root)
    return root


@pytest.mark.process
@for_each(
    ("manifest", "code", "words", "fault"),
    [
        (f"{MUTE}raise Odd", "", ["lint"], "its manifest `faulty:FEATURE` raised Odd"),
        (
            MANIFEST.format(row="rules=('faulty_code:check',)"),
            f"{MUTE}def check(draft): raise Odd",
            ["lint"],
            "its rule `faulty_code:check` raised Odd",
        ),
        (
            MANIFEST.format(row="rules=('faulty_code:check',)"),
            f"{MUTE}def check(draft): draft.loose.append(Odd())",
            ["lint"],
            "its rule `faulty_code:check` reported <Odd>, which is no finding",
        ),
        (
            MANIFEST.format(row="parts=(PartRow('odd', Phase.WATCH, 'faulty_code:make'),)"),
            f"from lumen.run.parts.part import Part\n{MUTE}\n"
            "class make(Part):\n    def __init__(self, services): super().__init__()\n"
            "    def tick(self, now, changes): raise Odd\n",
            RUN,
            "its part `odd` is stopped, because it raised Odd",
        ),
    ],
)
def test_an_error_without_words_is_named_by_its_type(
    manifest: str, code: str, words: list[str], fault: str, installed: Installed, hall: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    installed.write("faulty", manifest, faulty_code=code)
    main(words)
    told = capsys.readouterr()
    assert FAULT + fault in told.out + told.err


def test_a_value_without_a_repr_is_named_by_its_type() -> None:
    class Odd:
        def __repr__(self) -> str:
            raise ValueError

    assert shown(Odd()) == "<Odd>"


@for_each(
    ("row", "fault"),
    [
        (
            "subcommands={'odd': Subcommand('', 'faulty_code')}",
            "a row of `subcommands` of its manifest has `summary=''`, which is empty",
        ),
        (
            "verbs={'odd': VerbRow(' ')}",
            "a row of `verbs` of its manifest has `performer=' '`, which is empty",
        ),
        (
            "robots={'bot': RobotRow(options=(RobotOption('zap', 'X', 7),))}",
            "a row of `robots` of its manifest has `help=7`, which is no str",
        ),
    ],
)
def test_a_row_without_a_needed_text_is_a_fault_of_its_manifest(
    row: str, fault: str, installed: Installed, hall: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.write("faulty", MANIFEST.format(row=row))
    assert main([]) == 2
    assert main(["lint"]) == 0
    assert FAULT + fault in capsys.readouterr().out


@for_each(
    ("row", "words", "shown"),
    [
        ("subcommands={'odd': Subcommand('be 100% odd (%s)', 'faulty_code')}", ["--help"], "be 100% odd (%s)"),
        ("subcommands={'odd': Subcommand('be odd', 'faulty_code')}", ["odd", "--help"], "is 100% odd, by default 3"),
        ("buses={'box': BusRow('faulty_code:make', ('box://',), '50% box://')}", ["run", "--help"], "50% box://"),
        (
            "robots={'bot': RobotRow(options=(RobotOption('zap', 'X', '100% of %(foo)s'),))}",
            ["run", "--help"],
            "100% of %(foo)s",
        ),
    ],
)
def test_the_help_shows_the_texts_of_a_package_with_percent_signs(
    row: str, words: list[str], shown: str, installed: Installed, capsys: pytest.CaptureFixture[str]
) -> None:
    code = (
        "def configure(parser):\n    parser.add_argument('--zap', default=3, help='{}')\ndef run(options): return 0\n"
    )
    helps = "is 100% odd, by default 3"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=code.format(helps))
    with pytest.raises(SystemExit) as raised:
        main(words)
    assert raised.value.code == 0
    assert shown in capsys.readouterr().out


@for_each("words", [["--version"], ["--help"], ["lint"], []])
def test_ctrl_c_during_the_import_of_a_manifest_ends_a_command_quietly(
    words: list[str], installed: Installed, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.write("faulty", "raise KeyboardInterrupt")
    assert main(words) == 130
    assert capsys.readouterr() == ("", "")


WAITING = MANIFEST.replace("faulty", "{name}").format(
    name="{name}", row="parts=(PartRow('{part}', Phase.WATCH, 'faulty_code:make', after='{after}'),)"
)


def test_a_package_whose_parts_close_a_circle_is_left_out(
    installed: Installed, hall: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = "def make(services): return None"
    installed.write("early", WAITING.format(name="early", part="one", after="two"), faulty_code=code)
    installed.write("faulty", WAITING.format(name="faulty", part="two", after="one"))
    assert [feature.name for feature in features()][-1] == "early"
    assert main(["lint"]) == 0
    assert f"{FAULT}its parts wait for each other: one, two" in capsys.readouterr().out
    with lumen.open(hall, robot="recording") as exhibition:
        assert exhibition.run(seconds=1) == pytest.approx(1)


@pytest.mark.parametrize("needs", ["7", "'brain'", "(7,)", "None"])
def test_a_part_with_wrong_needs_is_left_out(needs: str, installed: Installed) -> None:
    code = f"from lumen.run.parts.part import Part\n\nclass make(Part):\n    needs = {needs}\n"
    code += "    def __init__(self, services): pass\n"
    row = "parts=(PartRow('odd', Phase.WATCH, 'faulty_code:make'),)"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=code)
    with lumen.open(ROOT / "examples/minimal", robot="recording") as exhibition:
        [fault] = exhibition.node.faults
    assert f"raised TypeError: `needs` of the part is {needs}: write a tuple of names" in fault


EXTRA = """
class Zap:
    def configure(self, parser): {configure}
    def check(self, *given): {check}
    def wishes(self, *given): {wishes}
    def more(self, found, *given): {more}
"""
SOUND = {"configure": "pass", "check": "pass", "wishes": "return {}", "more": "return found"}


@pytest.mark.process
@pytest.mark.parametrize(
    ("kind", "faulty", "fault"),
    [
        ("run", None, "ModuleNotFoundError: No module named 'nosuch'"),
        ("run", {"configure": "exit(0)"}, "SystemExit: 0"),
        (
            "run",
            {"configure": "parser.add_argument('--voice')"},
            "ArgumentError: argument --voice: conflicting option string: --voice",
        ),
        ("run", {"wishes": "pass"}, "TypeError: it returned None instead of a mapping of str"),
        ("run", {"wishes": "return {3: 4}"}, "TypeError: it returned {3: 4} instead of a mapping of str"),
        ("lint", None, "ModuleNotFoundError: No module named 'nosuch'"),
        ("lint", {"configure": "1 / 0"}, "ZeroDivisionError: division by zero"),
        ("lint", {"check": "1 / 0"}, "ZeroDivisionError: division by zero"),
        ("lint", {"more": "pass"}, "TypeError: it returned None instead of a list of Findings"),
        ("lint", {"more": "return [3]"}, "TypeError: it returned [3] instead of a list of Findings"),
    ],
)
def test_faulty_options_are_left_out_of_a_command(
    kind: str, faulty: dict[str, str] | None, fault: str, installed: Installed, hall: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    where = "faulty_code:Zap" if faulty else "nosuch:Zap"
    code = EXTRA.format(**SOUND | (faulty or {}))
    installed.write("faulty", MANIFEST.format(row=f"{kind}_options=('{where}',)"), faulty_code=code)
    assert main(RUN if kind == "run" else ["lint"]) == 0
    told = capsys.readouterr()
    [line] = told.err.splitlines()
    assert f"{FAULT}its options `{where}` raised {fault} (update" in line
    assert ("All well" if kind == "run" else "files checked") in told.out


def test_of_two_packages_with_the_same_option_the_second_is_left_out(
    installed: Installed, hall: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = EXTRA.format(**SOUND | {"configure": "parser.add_argument('--zap', action='store_true')"})
    row = "lint_options=('faulty_code:Zap',)"
    installed.write("early", MANIFEST.format(row=row).replace("faulty'", "early'", 1), faulty_code=code)
    installed.write("faulty", MANIFEST.format(row=row))
    assert main(["lint", "--zap"]) == 0
    [line] = capsys.readouterr().err.splitlines()
    assert f"{FAULT}its options `faulty_code:Zap` raised ArgumentError: argument --zap: conflicting" in line


@pytest.mark.process
def test_a_run_starts_without_what_a_package_should_do_before(
    installed: Installed, hall: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.write("faulty", MANIFEST.format(row="before_start=('nosuch:finish',)"))
    assert main(RUN) == 0
    assert capsys.readouterr().err.count(f"{FAULT}its `nosuch:finish` raised ModuleNotFoundError") == 1


@pytest.mark.process
def test_a_faulty_report_does_not_hide_the_error_of_a_run(
    installed: Installed, hall: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.write(
        "faulty", MANIFEST.format(row="failures=('faulty_code:tell',)"), faulty_code="def tell(failure): return exit"
    )
    main_file = hall / "lumen.yaml"
    main_file.write_text(f"{main_file.read_text()}\nlights: 3\n")
    assert main(["run"]) == 1
    told = capsys.readouterr()
    assert f"{FAULT}its `faulty_code:tell` raised SystemExit" in told.err
    assert "`lights` is not a key" in told.out + told.err


def test_an_exact_function_that_cannot_be_imported_fails_only_where_it_is_called(installed: Installed) -> None:
    installed.write(
        "faulty", MANIFEST.format(row="functions={'odd': FunctionRow('nosuch:odd', (), 'text', exact=True)}")
    )
    assert compile_expression("contains('ab', 'a')")(Scope()) is True
    with pytest.raises(ExpressionError, match=r"No module named 'nosuch' \(package faulty 1\.0\)"):
        compile_expression("odd()")(Scope())


def test_a_property_of_a_verb_may_have_true_or_false_as_its_schema() -> None:
    row = VerbRow("a", arguments={"properties": {"no": False, "any": True}, "required": ["any"]}, result={"a": True})
    assert short_argument(row) == ""
    assert durations_of(row) == frozenset()
    assert arguments_of(row, {"any": 3}) == {"any": 3}


SETTINGS = (
    "from dataclasses import dataclass\nSCHEMA = {}\n@dataclass(frozen=True)\nclass Hall:\n    size: object = 1\n"
)


@pytest.mark.process
@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("return Hall(lambda: 1)", "Can't pickle"),
        ("report.diagnostics.append(7); return Hall(2)", "TypeError: `faulty_code:read` reported [7], which"),
        ("report.diagnostics = None; return Hall(2)", "TypeError: `faulty_code:read` reported None, which"),
        ("1 / 0", "ZeroDivisionError: division by zero"),
    ],
)
def test_lint_and_run_report_once_that_a_section_cannot_be_read(
    code: str, fault: str, installed: Installed, hall: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.setenv("PYTHONPATH", f"{installed.folder}:{ROOT / 'engine'}")  # for the process that reads the files
    row = "sections={'zap': Section('faulty_code:read', 'faulty_code:SCHEMA')}"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=f"{SETTINGS}def read(data, report): {code}\n")
    main_file = hall / "lumen.yaml"
    main_file.write_text(f"{main_file.read_text()}\nzap: {{}}  # {fault}\n")
    assert main(["lint"]) == 0
    assert capsys.readouterr().out.count(f"{FAULT}reading `zap` raised ") == 1
    assert main(RUN) == 0
    [line] = capsys.readouterr().err.splitlines()
    assert f"warning [broken-feature] {FAULT}reading `zap` raised " in line
    assert fault in line


@for_each(
    ("where", "code", "fault"),
    [
        ("nosuch:f", "", "ModuleNotFoundError: No module named 'nosuch'"),
        ("faulty_code:f", "def f(*given, **named): 1 / 0", "ZeroDivisionError: division by zero"),
        (
            "faulty_code:f",
            "def f(*given, **named): return 7",
            "TypeError: `faulty_code:f` returned 7, which is no",
        ),
        (
            "faulty_code:f",
            "from lumen.feature import *\ndef f(*given, **named): return VerbRow(3)",
            "TypeError: `faulty_code:f` returned VerbRow(performer=3,",
        ),
    ],
)
def test_lint_reports_a_faulty_reader_of_verbs_at_the_file(
    where: str, code: str, fault: str, installed: Installed, hall: Path
) -> None:
    installed.write("faulty", MANIFEST.format(row=f"verb_files={{'motions': '{where}'}}"), faulty_code=code)
    wave = hall / "motions/wave.yaml"
    wave.write_text(f"{wave.read_text()}# {fault}\n")
    (finding,) = [each for each in check_files(hall, read_files(hall))[1] if each.code == "broken-feature"]
    assert finding.place.file == "motions/wave.yaml"
    assert finding.message.startswith(f"{FAULT}reading the verb `wave` raised {fault}")


def test_a_fault_of_one_package_leaves_the_rows_of_others(
    installed: Installed, hall: Path, capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    row = "pages=('nosuch',), importers={'.odd': Importer('behavior', 'nosuch:read', begins='nosuch:begins')}"
    installed.write("faulty", MANIFEST.format(row=row))
    assert main(["explain", "cut-short"]) == 0
    (hall / "chart.odder").write_text("odd")
    assert recognised(b"odd") is None
    assert f"{FAULT}its `nosuch:begins` raised ModuleNotFoundError" in caplog.text


def test_a_forgetter_that_fails_is_listed_and_the_others_forget(installed: Installed, tmp_path: Path) -> None:
    code = "def forget(folder, name, found): found.visitors += 1\n"
    row = "file_forgetters=('nosuch:forget', 'faulty_code:leave', 'faulty_code:forget')"
    installed.write("faulty", MANIFEST.format(row=row), faulty_code=f"{code}def leave(*given): exit()\n")
    found = Forgetting()
    forget_in(tmp_path, "Ani", found)
    assert found.visitors == 1
    assert [place.where for place in found.left] == ["a package"] * 2
    assert all(place.what.startswith(FAULT) for place in found.left)


@for_each("option", ["RobotOption('speed', 'X', 'h', short=True)", "RobotOption('verb', 'X', 'h', short=True)"])
def test_a_robot_cannot_have_an_option_of_lumen(option: str, installed: Installed, hall: Path) -> None:
    installed.write("faulty", MANIFEST.format(row=f"robots={{'bot': RobotRow(options=({option},))}}"))
    (finding,) = check_files(hall, read_files(hall))[1]
    name = option.split("'")[1]
    assert finding.message.endswith(f"no robot can have an option `--{name}`: choose another word")


def test_an_api_that_is_no_number_is_shown_as_it_is_written(installed: Installed, hall: Path) -> None:
    installed.write("faulty", MANIFEST.format(row="api='1'"))
    (finding,) = check_files(hall, read_files(hall))[1]
    assert finding.message == f"{FAULT}its manifest is written for API '1', and this Lumen has API 1"


@for_each("manifest", ['"faulty:FEATURE"', ":::", "faulty FEATURE"])
def test_an_entry_point_that_names_nothing_is_a_finding(manifest: str, tmp_path: Path, hall: Path) -> None:
    write_distribution(tmp_path, "faulty", manifest, {"faulty.py": MANIFEST.format(row="")})
    with on_path(tmp_path):
        (finding,) = check_files(hall, read_files(hall))[1]
    assert finding.message.startswith(f"{FAULT}its manifest `")
