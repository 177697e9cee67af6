"""The differences of two bundles, in the words of their authors; and `lumen diff` from the shell."""

import json
import shutil
from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.errors import UsageError
from lumen.insight.changes import Change, Risk, change_data, changes, live, risk, summary
from lumen.insight.changes.machines import machine_changes
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project import load, revisions
from lumen.project.files import read_files
from lumen.project.home import Home, home_of
from lumen.project.revisions import files_at
from lumen.run.snapshot_store import SnapshotStore
from lumen.run.versions import version
from lumen.statechart import Machine, initial, step
from tests import ROOT
from tests.guarded import run_guarded
from tests.provided import program
from tests.tables import for_each

FILES = read_files(ROOT)
TOUR = "behaviors/tour.yaml"
FAQ = "behaviors/words/faq.yaml"
VISITORS = "behaviors/words/visitors.yaml"
RENAMING = [
    (TOUR, "              ask_name:", "              asking:"),
    (TOUR, "id: ask_name", "id: asking"),
    (TOUR, "target: ask_name", "target: asking"),
    (TOUR, "what|again: ask_name", "what|again: asking"),
    (TOUR, '"#ask_name"', '"#asking"'),
]


def edited(*edits: tuple[str, str, str]) -> Project:
    """Return the shipped project with these replacements."""
    naming = ("behaviors/stories/", "behaviors/sayings/")  # these name the states
    files = {name: content for name, content in FILES.items() if not name.startswith(naming)}
    files["lumen.yaml"] = files["lumen.yaml"].replace(b"story: visitor", b"")
    for file, old, new in edits:
        assert old in files[file].decode()
        files[file] = files[file].decode().replace(old, new).encode()
    found, diagnostics = check_files(ROOT, files)
    assert found, diagnostics
    return found


PLAIN = edited()
NOT_COMPARED = {"documents", "sections", "verbs"}
"""The places of nodes, and what this project has none of: sections and verbs, whose changes have tests of their own."""

SHOW_CHANGED = "the output to lamps, screens and sound desks (`modules.show`) changed"
CASES: list[tuple[str, list[tuple[str, str, str]], list[str], Risk]] = [
    (
        "how long the journal is kept",
        [("lumen.yaml", "name: Lumen at", "journal: {keep: 3}\nname: Lumen at")],
        ["`journal.keep` is now `3`, not `30`"],
        Risk.COSMETIC,
    ),
    (
        "another name of the robot",
        [("lumen.yaml", "name: NAO", "name: ANA")],
        ["the robot's name changed: it takes effect at the next start"],
        Risk.RESTART,
    ),
    ("comments", [(TOUR, "# What the robot remembers.", "# Things.")], [], Risk.COSMETIC),
    (
        "a lamp",
        [
            (
                "lumen.yaml",
                "  memory: {here: false",
                "  show: {mqtt: {host: h, routes: {state: lamp/state}}}\n  memory: {here: false",
            )
        ],
        ["the settings of the modules changed: it takes effect at the next start", SHOW_CHANGED],
        Risk.RESTART,
    ),
    (
        "a text",
        [(TOUR, "en: Never mind.", "en: No problem.")],
        [f"state `{name}` now says “No problem.” on `hears else` (en)" for name in ("ask_name", "check_name")],
        Risk.COSMETIC,
    ),
    (
        "an answer",
        [(FAQ, "I weigh a little more than five kilograms.", "Five kilograms.")],
        ["`faq` now answers “Five kilograms.”"],
        Risk.COSMETIC,
    ),
    (
        "another order of answers",
        [(FAQ, "[how heavy, your weight, ", "[how heavy, ")],
        ["`faq` listens for different phrases, or in a different order"],
        Risk.BEHAVIOR,
    ),
    ("a motion", [(TOUR, "{play: dance}", "{play: photo}")], ["state `dance` now plays `photo`"], Risk.BEHAVIOR),
    (
        "a delay",
        [(TOUR, "after: {12s: ", "after: {15s: ")],
        ["state `goodbye` waits 15 s, not 12 s"],
        Risk.BEHAVIOR,
    ),
    (
        "a delay of less than a second",
        [(TOUR, "after: {12s: ", "after: {500ms: ")],
        ["state `goodbye` waits 500 ms, not 12 s"],
        Risk.BEHAVIOR,
    ),
    (
        "a motion that is longer",
        [("motions/goodbye.yaml", "return: 1.3s", "return: 1.8s")],
        ["motion `goodbye` is 500 ms longer", "motion `goodbye` moves 20 joints differently"],
        Risk.MOTION,
    ),
    (
        "a motion that moves another joint",
        [("motions/goodbye.yaml", "gather: {joints: {", "gather: {joints: {LWristYaw: 5, ")],
        ["motion `goodbye` also moves `LWristYaw`"],
        Risk.MOTION,
    ),
    (
        "a delay that is computed",
        [(TOUR, "after: {12s: ", 'after: {"{{ context.battery }}s": ')],
        ["state `goodbye` waits `{{ context.battery }}s`, not 12 s"],
        Risk.BEHAVIOR,
    ),
    (
        "a guard",
        [(TOUR, "context.mood_tries < 3", "context.mood_tries < 2")],
        ["state `not_understood` now goes to `how_are_you` when it is done if `context.mood_tries < 2`"],
        Risk.BEHAVIOR,
    ),
    (
        "a target",
        [(TOUR, '  fine: "#fine"', '  fine: "#offer"')],
        ["state `how_are_you` now goes to `offer` on `hears fine`, not `fine`"],
        Risk.BEHAVIOR,
    ),
    ("phrases", [(VISITORS, "dance, dances, danced", "dance, danced")], ["phrases `dance` changed"], Risk.BEHAVIOR),
    (
        "a route",
        [("lumen.yaml", "ttl: 2s, keep: 10", "ttl: 3s, keep: 10")],
        ["route `command` ttl 2 s → 3 s"],
        Risk.WIRING,
    ),
    (
        "images",
        [("lumen.yaml", "schema: image, every", "schema: image, size: 640x480, every")],
        ["route `image` size the camera's → 640 x 480"],
        Risk.WIRING,
    ),
    (
        "a fuzzy rule",
        [("fuzzy/head.yaml", "if FaceXLoc is Zero then AngleX is Zero", "if FaceXLoc is Zero then AngleX is Positive")],
        ["fuzzy rule 2 of `head` changed: `if FaceXLoc is Zero then AngleX is Positive`"],
        Risk.MOTION,
    ),
    (
        "tracking",
        [("fuzzy/head.yaml", "hold: 2s", "hold: 3s")],
        ["the tracking of `head` changed: `hold`"],
        Risk.MOTION,
    ),
    (
        "the stage",
        [("lumen.yaml", "x: [-0.4, 0.4]", "x: [-0.3, 0.4]")],
        ["the stage changed: it takes effect at the next start"],
        Risk.RESTART,
    ),
    (
        "a renamed state",
        [*RENAMING, (TOUR, "type: parallel\n", "renamed: {ask_name: asking}\ntype: parallel\n")],
        ["state `ask_name` is now `guide.talking.waiting.asking`"],
        Risk.BEHAVIOR,
    ),
    (
        "a state gone and another there",
        RENAMING,
        [
            "state `ask_name` removed",
            "state `asking` added",
            "state `greet` now goes to `asking` when it is done, not `ask_name`",
            "state `greet` now goes to `asking` when it fails, not `ask_name`",
            "state `waiting` now begins in `asking`",
            "state `check_name` now goes to `asking` on `hears english|indonesian|what|again`, not `ask_name`",
            "state `check_name` now goes to `asking` on `hears else` if `context.name_tries < 2`, not `ask_name`",
        ],
        Risk.BEHAVIOR,
    ),
]


@for_each(("edits", "told", "greatest"), [c[1:] for c in CASES], ids=[c[0] for c in CASES])
def test_a_change_is_told(edits: list[tuple[str, str, str]], told: list[str], greatest: Risk) -> None:
    found = changes(PLAIN, edited(*edits))
    assert [change.sentence for change in found] == told
    assert risk(found) is greatest


@for_each(
    ("file", "was", "now"),
    [
        ("motions/nao/life/calm.yaml", b"period: 4s", b"period: 5s"),
        ("motions/nao/dance.yaml", b"tempo: 132", b"tempo: 120"),
    ],
)
def test_a_change_of_the_robots_own_file_names_that_file(file: str, was: bytes, now: bytes) -> None:
    shared = FILES[file.replace("nao/", "")]
    versions = (shared, shared.replace(was, now))
    (old, _), (new, _) = (check_files(ROOT, {**FILES, file: content}) for content in versions)
    assert old
    assert new
    assert {change.file for change in changes(old, new)} == {file}
    assert {change.file for change in changes(new, old)} == {file}


@pytest.mark.parametrize(
    "field",
    sorted({one.name for one in fields(Project) if isinstance(getattr(PLAIN, one.name), Mapping)} - NOT_COMPARED),
)
def test_entries_of_each_kind_are_compared(field: str) -> None:
    whole = load(ROOT)
    entries = {"x": None} if field == "robots" else getattr(whole, field)
    full, without = replace(whole, **{field: entries}), replace(whole, **{field: {}})
    assert changes(full, without)


def test_another_time_of_day_is_told() -> None:
    early, late = (
        Machine.from_dict({"id": "m", "states": {"open": {"at": {time: "shut"}}, "shut": {}}})
        for time in ("10:00", "11:30")
    )
    assert [change.sentence for change in machine_changes("m", early, late)] == [
        "state `open` no longer goes to `shut` at 10:00",
        "state `open` now goes to `shut` at 11:30",
    ]


def test_all_changes_in_one_line() -> None:
    other = edited(
        (TOUR, "{play: dance}", "{play: photo}"),
        (TOUR, "en: Never mind.", "en: No problem."),
        (TOUR, "en: Thank you!", "en: Thanks!"),
        ("lumen.yaml", "ttl: 2s, keep: 10", "ttl: 3s, keep: 10"),
    )
    expected = "state `dance` now plays `photo`; route `command` ttl 2 s → 3 s; 3 texts changed"
    assert summary(changes(PLAIN, other)) == expected
    assert summary(()) == "no relevant changes"
    many = [Change("story", "", "", Risk.COSMETIC), Change("behavior", "", "", Risk.BEHAVIOR)]
    assert summary(many * 5) == "5 behaviors changed; 5 stories changed"


def test_a_changed_text_is_whole_before_and_now_with_its_line() -> None:
    """The sentence shows the first 60 characters; what changed may be later."""
    was = FILES[TOUR].decode()
    end = "{{ context.title_en }}. Goodbye!"
    long = next(line for line in was.splitlines() if end in line)
    new = edited((TOUR, end, "{{ context.title_en }}. See you soon, and goodbye!"))
    [change] = changes(PLAIN, new)
    said = change_data(change, new)
    assert "See you soon" not in str(change)
    assert (said["was"].partition("}}. ")[2], said["now"].partition("}}. ")[2]) == (
        "Goodbye!",
        "See you soon, and goodbye!",
    )
    assert (said["file"], said["line"]) == (TOUR, 1 + was.splitlines().index(long))
    assert change_data(change, replace(new, documents={}))["line"] is None


def test_values_are_written_as_in_the_file() -> None:
    one, several = (
        edited(("lumen.yaml", "robot: {name: NAO, model: nao}", robots))
        for robots in ("robot: {name: NAO, model: nao}", "robots: {NAO: {model: nao, at: {x: 1, y: 0}}}")
    )
    assert "`aliases` is now `false`, not `null`" in [change.sentence for change in changes(one, several)]


HOUSE = "robots: {NAO: {model: nao, at: {x: 1, y: 0}}, ANA: {model: nao, at: {x: 0, y: 0}}}"


@for_each(
    "was, now, said",
    [
        ("x: 1", "x: 1.2", "`at` of robot `NAO` changed: it takes effect at the next start"),
        ("x: 0", "x: -1", "robot `ANA` changed"),
        (", ANA: {model: nao, at: {x: 0, y: 0}}", "", "robot `ANA` removed: it takes effect at the next start"),
        ("ANA", "Elodie", "robot `Elodie` added: it takes effect at the next start"),
    ],
)
def test_the_robots_of_a_house_are_named(was: str, now: str, said: str) -> None:
    one = "robot: {name: NAO, model: nao}"
    old, new = (edited(("lumen.yaml", one, robots)) for robots in (HOUSE, HOUSE.replace(was, now)))
    assert said in [change.sentence for change in changes(old, new)]


def test_what_can_not_change_live_stays_as_it_was() -> None:
    other = edited(
        ("lumen.yaml", "x: [-0.4, 0.4]", "x: [-0.3, 0.4]"), ("lumen.yaml", "ttl: 2s, keep: 10", "ttl: 3s, keep: 10")
    )
    assert [c.risk for c in changes(PLAIN, live(PLAIN, other))] == [Risk.WIRING]


@pytest.fixture
def repository(copy: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A small project, committed, in a folder of a repository."""
    root = tmp_path_factory.mktemp("repository") / "ours"
    copy.rename(root)
    shutil.rmtree(root / "behaviors" / "stories")
    shutil.rmtree(root / "behaviors" / "sayings")
    main_file = root / "lumen.yaml"
    main_file.write_text(main_file.read_text("utf-8").replace("story: visitor", ""), "utf-8")
    states = "idle: {on: {touched: talk}}, talk: {states: {ask: {on: {released: dance}}, dance: }}"
    (root / TOUR).write_text(f"id: tour\nstates: {{{states}}}\n", "utf-8")
    for command in ("init -q", "add ours", "-c user.name=x -c user.email=x@x commit -qm one"):
        run_guarded([program("git"), "-C", str(root.parent), *command.split()], check=True)
    monkeypatch.chdir(root)
    return root


@pytest.mark.slow
def test_a_revision_is_compared_and_every_configuration_told(
    repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["diff", "HEAD"]) == 0
    assert capsys.readouterr().out == "no relevant changes\n"
    tour = repository / TOUR
    tour.write_text(tour.read_text().replace("ask: {on: {released: dance}}, ", ""))
    assert main(["diff", "HEAD", "--configurations"]) == 1
    out = capsys.readouterr().out.splitlines()
    changes = [TOUR, "  state `talk.ask` removed (behavior)", "  state `talk` now begins in `talk.dance` (behavior)"]
    assert out[:3] == changes, out
    assert "refused talk.ask: `talk.ask` is active but was removed, and no `onReload` names another state" in out
    assert "kept    idle" in out
    assert out[-1] == "3 configurations: 1 refused, 2 kept"
    tour.write_text(tour.read_text().replace("talk: {", "talk: {onReload: .dance, "))
    assert main(["diff", "HEAD", ".", "--configurations", "--format", "json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["complete"]
    assert {row["outcome"]: row["after"] for row in told["configurations"]}["moved"] == ["talk.dance"]


@pytest.mark.slow
def test_lint_finds_what_a_reload_would_refuse_or_move(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tour = repository / TOUR
    assert main(["lint", "--against", "HEAD", "--ignore", "dead-end", "--format", "concise"]) == 0
    tour.write_text(tour.read_text().replace("ask: {on: {released: dance}}, ", ""))
    capsys.readouterr()
    assert main(["lint", "--against", "HEAD", "--select", "reload", "--format", "concise"]) == 1
    assert f"{TOUR}:2:46: error[reload-refused] a reload would be refused: `talk.ask`" in capsys.readouterr().out
    tour.write_text(tour.read_text().replace("talk: {", "talk: {onReload: .dance, "))
    assert main(["lint", "--against", "HEAD", "--select", "reload", "--format", "concise"]) == 0
    out = capsys.readouterr().out
    assert (
        f"{TOUR}:2:46: info[reload-moves] a reload would move from `talk.ask`, which no longer exists, to `talk.dance`"
        in out
    )
    assert out.count("reload-moves") == 1
    assert main(["lint", "--against", "HEAD", "--select", "reload", "--format", "concise", "fuzzy/head.yaml"]) == 0
    assert "reload-moves" not in capsys.readouterr().out
    assert main(["lint", "--against", "nothing"]) == 2
    assert main(["lint", "--against", "HEAD", "--diff"]) == 2


def test_what_runs_is_compared_with_what_is_saved(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project, home = load(repository), Home(home_of(repository))
    assert home.hold()
    keeper = SnapshotStore(home)
    keeper.store(read_files(repository))
    first = initial(project.machine).snapshot
    keeper.keep(project, step(project.machine, first, Event("touched", {"sensor": "x"})).snapshot, ())
    tour = repository / TOUR
    tour.write_text(tour.read_text().replace("ask: {on: {released: dance}}, ", ""))
    assert main(["diff", "live"]) == 1
    assert "now: refused talk.ask: `talk.ask` is active but was removed" in capsys.readouterr().out
    home.release()
    assert main(["diff", "live"]) == 2


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("HEAD~7", "`HEAD~7` is not a folder, a revision of"),
        ("", "is not a folder, a revision of"),
        ("live", "no exhibition of"),
    ],
)
def test_a_version_that_is_none_is_told(
    repository: Path, capsys: pytest.CaptureFixture[str], name: str, told: str
) -> None:
    assert main(["diff", name]) == 2
    assert told in capsys.readouterr().err


def test_errors_of_either_version_are_told(repository: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (repository / TOUR).write_text("states: 3")
    assert main(["diff", "HEAD"]) == 2
    assert f"has errors: {TOUR}:1:9: error [wrong-type]" in capsys.readouterr().err


def test_what_looks_like_an_option_of_git_is_a_revision_that_is_none(repository: Path) -> None:
    with pytest.raises(UsageError, match="a revision of"):
        version("--output=stolen")
    assert not (repository / "stolen").exists()


def test_a_revision_is_read_as_far_as_a_folder_would_be(repository: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    largest = max(map(len, read_files(repository).values()))
    monkeypatch.setattr(revisions, "MAX_FILE_BYTES", largest - 1)
    found = files_at(repository, "HEAD")
    assert found
    assert found.keys() == read_files(repository).keys()
    assert b"it is too large" in found.values()
    monkeypatch.setattr(revisions, "MAX_PROJECT_BYTES", largest)
    with pytest.raises(UsageError, match="larger than 0 MB at `HEAD`"):
        files_at(repository, "HEAD")


def test_no_file_of_a_revision_is_left_out_if_git_refuses_its_contents(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = {"rev-parse": b"c0ffee\n", "ls-tree": b"100644 blob c0ffee 7\tlumen.yaml\0"}
    monkeypatch.setattr(revisions, "_git", lambda root, command, *words, given=b"": answers.get(command))
    with pytest.raises(ValueError, match="shorter"):
        files_at(tmp_path, "HEAD")


@pytest.mark.process
def test_outside_of_a_repository(
    tmp_path: Path, copy: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    program("git")
    monkeypatch.chdir(copy)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(copy.parent))
    assert main(["diff", "HEAD"]) == 2
    assert "is not in a git repository" in capsys.readouterr().err
