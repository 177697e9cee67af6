"""Features are found in installed distributions; a faulty one is one finding, and everything else works without it."""

import re
import sys
from collections.abc import Iterable, Iterator
from importlib.metadata import entry_points
from pathlib import Path

import pytest
from written_distribution import on_path, write_distribution

from lumen import distributions, feature
from lumen.cli.main import main
from lumen.feature import BUILT_IN, Feature, features, resolve, wrong_rows
from lumen.features.simulation.trials import outcome_cache
from lumen.lint import check_files
from lumen.project import engine_files
from lumen.project.files import read_files
from lumen.project.packaged import PACKAGE
from lumen.run.workers import tasks
from tests import ROOT
from tests.copying import copied_project
from tests.guarded import run_guarded
from tests.stranger.installing import Installed
from tests.tables import for_each
from tests.waiting import HANG

PROJECT = ROOT / "tests/lint/pages/base"
GOOD = 'from lumen.feature import Feature\nFEATURE = Feature(name="greeter", extras=("waving",))\n'
IMPORT_STRING = re.compile(r"lumen(\.\w+)+(:\w+)?")


def findings() -> list[str]:
    """Return the findings in a project that is sound by itself."""
    return [f"{each.place.file} {each.code} | {each.message}" for each in check_files(PROJECT, read_files(PROJECT))[1]]


def test_a_feature_of_an_installed_distribution_comes_after_those_of_lumen(installed: Installed) -> None:
    built_in = features()
    installed.write("lumen-greeter", GOOD)
    *first, greeter = features()
    assert tuple(first) == built_in
    assert greeter == Feature(name="greeter", extras=("waving",))
    assert str(feature.distribution_of(greeter)) == "lumen-greeter 1.0"
    assert feature.distribution_of(built_in[0]) is None
    assert list(feature.rows("extras"))[-1] == (greeter, "waving")
    assert findings() == []


def with_row(kind: str, row: str) -> str:
    """Return the source of a manifest with one row, named `wave`."""
    return f'from lumen.feature import *\nFEATURE = Feature(name="greeter", {kind}={{"wave": {row}}})\n'


FAULTY = {
    "raises": ("1 / 0\n", "its manifest `lumen_greeter:FEATURE` raised ZeroDivisionError: division by zero"),
    "lacks an import": (
        "import not_installed\n",
        "its manifest `lumen_greeter:FEATURE` raised ModuleNotFoundError: No module named 'not_installed'",
    ),
    "is no feature": ("FEATURE = 1\n", "its entry point names `lumen_greeter:FEATURE`, which is no `Feature`"),
    "another API": (
        GOOD.replace("extras", "api=2, extras"),
        "its manifest is written for API 2, and this Lumen has API 1",
    ),
    "no rows": (GOOD.replace('("waving",)', "None"), "`extras` of its manifest is no tuple"),
    "a text for a tuple": (GOOD.replace('("waving",)', '"waving"'), "`extras` of its manifest is no tuple"),
    "no mapping": (GOOD.replace("extras=", "subcommands="), "`subcommands` of its manifest is no mapping"),
    "a row of another type": (
        GOOD.replace('extras=("waving",)', 'subcommands={"wave": "waving"}'),
        "`subcommands` of its manifest has the row `'waving'`, which is no `Subcommand`",
    ),
    "a name that no option can have": (
        with_row("robots", 'RobotRow(options=(RobotOption("name", "NAME", "a name"),))'),
        "`robots` of its manifest is faulty: no robot can have an option `--robot-name`: choose another word",
    ),
    "an option of another type": (
        with_row("robots", 'RobotRow(options=("name",))'),
        "a row of `robots` of its manifest has `'name'` in `options`, which is no RobotOption",
    ),
    "no kind of value": (
        with_row("functions", 'FunctionRow("waving:wave", ("text|colour",), "text")'),
        "`functions` of its manifest is faulty: there is no kind of value `colour`: there are null, boolean, number,"
        " text, list, map, any",
    ),
    "no risk": (
        with_row("sections", 'Section(read="waving:read", risk="great")'),
        "`sections` of its manifest is faulty: a section has no risk `great`: choose one of cosmetic, behavior, motion,"
        " wiring, restart",
    ),
    "a field of another type": (
        GOOD.replace("import Feature", "import *").replace(
            'extras=("waving",)', 'verbs={"wave": VerbRow(performer="a", parts="arms")}'
        ),
        "a row of `verbs` of its manifest has `parts='arms'`, which is no tuple",
    ),
    "a list with an entry of another type": (
        GOOD.replace("import Feature", "import *").replace(
            'extras=("waving",)', 'verbs={"wave": VerbRow(performer="a", parts=(1,))}'
        ),
        "a row of `verbs` of its manifest has `1` in `parts`, which is no str",
    ),
    "a name of Lumen's": (
        GOOD.replace('"greeter"', '"core"'),
        "its feature has the name `core`, as one of Lumen has",
    ),
}


@pytest.mark.parametrize("case", FAULTY)
def test_a_faulty_manifest_is_one_finding_that_names_its_distribution(case: str, installed: Installed) -> None:
    built_in = features()
    manifest, message = FAULTY[case]
    installed.write("lumen-greeter", manifest)
    assert features() == built_in
    assert findings() == [f"lumen.yaml broken-feature | the installed package `lumen-greeter` 1.0 is faulty: {message}"]


@pytest.mark.process
def test_a_run_reports_a_faulty_feature_once_and_continues(
    installed: Installed, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    project = copied_project(ROOT / "examples/minimal", tmp_path / "minimal")
    installed.write("lumen-greeter", "1 / 0\n")
    assert main(["run", str(project), "--story", "visitor", "--robot", "recording", "--speed", "max"]) == 0
    error = capsys.readouterr().err
    assert error.count("broken-feature") == 1
    assert "the installed package `lumen-greeter` 1.0 is faulty: its manifest" in error


def test_of_two_distributions_with_the_same_feature_the_first_counts(installed: Installed) -> None:
    installed.write("lumen-a", GOOD)
    installed.write("lumen-b", GOOD)
    assert str(feature.distribution_of(features()[-1])) == "lumen-a 1.0"
    (finding,) = findings()
    assert "`lumen-b` 1.0" in finding
    assert "the name `greeter`, as one of lumen-a 1.0 has" in finding


METADATA = {
    "a module": ("waving.py,,\n", "[lumen.features]\nwaving = waving\n", [("waving", ("waving",))]),
    "an object": (
        "",
        "[lumen.features]\nwaving = waving.manifest:FEATURE\n",
        [("waving.manifest:FEATURE", ("waving",))],
    ),
    "blanks and comments": (
        "",
        "# a = b\n\n[ lumen.features ]\n; a = b\n  x = waving : FEATURE [extra]\n\n[console_scripts]\ny = a:b\n",
        [("waving:FEATURE", ("waving",))],
    ),
    "lines that end as on Windows": (
        "waving.py,,\r\n",
        "[lumen.features]\r\nwaving = waving:FEATURE\r\n",
        [("waving:FEATURE", ("waving",))],
    ),
    "two manifests": (
        "",
        "[lumen.features]\nb = b:FEATURE\na = a:FEATURE",
        [("a:FEATURE", ("a",)), ("b:FEATURE", ("b",))],
    ),
    "other packages": (
        'help/x.py,sha256=abc,12\nwaving/__init__.py,,\n"data/a,b.txt",,\n../../bin/run.py,,\nalone.py,,\n',
        "[lumen.features]\nwaving = waving:FEATURE\n",
        [("waving:FEATURE", ("alone", "help", "waving"))],
    ),
    "another group": ("", "[console_scripts]\nlumen.features = waving:main\n", []),
    "no entry points": ("", "", []),
}


@for_each("case", METADATA)
def test_the_metadata_of_a_distribution_is_read(case: str, tmp_path: Path) -> None:
    record, entry_points, expected = METADATA[case]
    folder = tmp_path / "waving-2.0.dist-info"
    folder.mkdir()
    about = "Metadata-Version: 2.1\nName: Waving\nVersion: 2.0\nAuthor: Zoë\n\nName: other\n"
    (folder / "METADATA").write_text(about, encoding="latin-1")
    (folder / "RECORD").write_text(record)
    (folder / "entry_points.txt").write_text(entry_points)
    with on_path(tmp_path):
        found = distributions.distributions()
    assert [(each.manifest, each.packages) for each in found] == expected
    assert {str(each) for each in found} <= {"Waving 2.0"}


def test_of_two_folders_with_the_same_distribution_the_first_counts(tmp_path: Path) -> None:
    for version, name in (("1.0", "lumen-greeter"), ("2.0", "Lumen_Greeter")):
        write_distribution(tmp_path / version, name, "lumen_greeter:FEATURE", {"lumen_greeter.py": GOOD}, version)
    with on_path(tmp_path / "2.0"), on_path(tmp_path / "1.0"):
        assert [str(each) for each in distributions.distributions()] == ["lumen-greeter 1.0"]


def test_the_metadata_is_read_as_python_reads_it(installed: Installed) -> None:
    installed.write("lumen-greeter", GOOD)
    (entry,) = entry_points(group=distributions.GROUP)
    (found,) = distributions.distributions()
    assert (entry.dist.name, entry.dist.version, entry.value) == found[:3]


def fingerprints() -> dict[str, str]:
    """Return what findings, worlds, outcomes of motions and workers depend on."""
    return {
        "findings": engine_files.engine(),
        "worlds": engine_files.files_hash(PACKAGE / "features/simulation"),
        "outcomes": engine_files.code_hash(*outcome_cache.CODE),
        "workers": tasks.engine(),
    }


def test_every_fingerprint_depends_on_name_version_and_files(installed: Installed) -> None:
    seen = [fingerprints()]
    for text, version in ((GOOD, "1.0"), (f"{GOOD}# more\n", "1.0"), (f"{GOOD}# more\n", "1.1")):
        for metadata in installed.folder.glob("*.dist-info/*"):
            metadata.unlink()
        installed.write("lumen-greeter", text, version)
        seen.append(fingerprints())
    installed.write("lumen-other", GOOD.replace("greeter", "other"))
    seen.append(fingerprints())
    for name in seen[0]:
        assert len({each[name] for each in seen}) == len(seen), name


def test_code_that_is_written_again_has_the_same_fingerprint(installed: Installed) -> None:
    installed.write("lumen-greeter", GOOD)
    before = engine_files.code_hash("lumen.language")
    installed.write("lumen-greeter", GOOD)
    assert engine_files.code_hash("lumen.language") == before


def test_every_import_string_of_the_features_that_come_with_lumen_names_something() -> None:
    found = [text for where in BUILT_IN for text in import_strings(resolve(where))]
    assert len(found) > 100
    for text in found:
        assert resolve(text) is not None


def test_the_rows_of_the_features_that_come_with_lumen_can_be_used() -> None:
    assert [fault for where in BUILT_IN for fault in wrong_rows(resolve(where))] == []


def test_no_two_features_that_come_with_lumen_have_rows_of_the_same_name() -> None:
    built_in = [resolve(where) for where in BUILT_IN]
    for kind in Feature._fields:
        named = [value for each in built_in if isinstance(value := getattr(each, kind), dict)]
        assert len({name for rows in named for name in rows}) == sum(map(len, named)), kind


def test_help_lists_the_subcommands_of_all_features_without_dataclasses() -> None:
    """Every start of `lumen` reads the manifests."""
    code = (
        "import sys; from lumen.cli.main import main; from lumen.feature import features; main([]); features()\n"
        "sys.exit(str({'dataclasses', 'inspect', 'lumen.language.diagnostics'} & set(sys.modules)))"
    )
    environment = {"PYTHONPATH": str(ROOT / "engine")}
    done = run_guarded([sys.executable, "-c", code], env=environment, timeout=HANG, capture_output=True, text=True)
    assert "console" in done.stdout
    assert done.stderr == "set()\n"


def import_strings(value: object) -> Iterator[str]:
    """Iterate over the import strings in a manifest or in a part of it."""
    if isinstance(value, str):
        if IMPORT_STRING.fullmatch(value):
            yield value
        return
    if isinstance(value, dict):
        value = value.values()
    for part in value if isinstance(value, Iterable) else ():
        yield from import_strings(part)
