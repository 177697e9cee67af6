"""Files as editors, word processors and other tools save them: each error is found at its place, and nothing crashes.

Each input is reduced from a public report about another system.
"""

import contextlib
import errno
import io
import os
import resource
import sys
import unicodedata
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from lumen import check, load
from lumen.cli.main import main
from lumen.errors import ProjectError
from lumen.language.diagnostics import Diagnostic
from lumen.language.text_lines import LineIndex, lines_of
from lumen.lint import check_files
from lumen.lint.repairs import repaired
from lumen.project.files import fingerprint, read_files
from lumen.project.yaml_reader import parse
from lumen.run.live_behavior import local_timezone
from lumen.upkeep import replacing
from lumen.upkeep.replacing import replace_file
from tests import ROOT
from tests.guarded import run_guarded
from tests.tables import for_each

HERE = Path(__file__).parent
INPUTS = HERE / "inputs" / "files"
MINIMAL = ROOT / "examples/minimal"
TOUR, WAVE = "behaviors/tour.yaml", "motions/wave.yaml"
BASE = {
    "lumen.yaml": read_files(MINIMAL)["lumen.yaml"].replace(b"behavior: hello", b"behavior: tour").replace(
        b"story: visitor", b"# no story"
    ),
}  # fmt: skip

STATES = """
states:
  idle:
    on: {touched: greet}
  greet:
    do: {say: Hello}
    onDone: idle
    onError: idle
"""
"""A valid behaviour, which begins with an empty line."""


def project(name: str, content: bytes) -> dict[str, bytes]:
    """Return the files of a small project with that content as its behaviour or motion."""
    sound = {TOUR: STATES.encode()}
    return {**BASE, **sound, (WAVE if name.endswith(".motion.yaml") else TOUR): content}


def found(name: str, content: bytes) -> list[Diagnostic]:
    return list(check_files(HERE, project(name, content))[1])


def told(diagnostic: Diagnostic) -> str:
    return f"{diagnostic.place.line}:{diagnostic.place.column} {diagnostic.code} | {diagnostic.hint}"


def assert_told(diagnostics: list[Diagnostic], expected: list[str]) -> None:
    said = [told(d) for d in diagnostics if d.code not in ("unreachable-state", "unused-file")]
    assert len(said) == len(expected), said
    for one, beginning in zip(said, expected, strict=True):
        assert one.startswith(beginning), one


@for_each(
    ("name", "expected"),
    [
        ("cr-only-crash.yaml", []),
        ("line-separator-crash.yaml", ["6:13 unknown-state | did you mean `idle`?"]),
        ("line-separator-place.yaml", ["7:14 unknown-state | did you mean `idle`?"]),
        ("control-character.yaml", ["11:18 yaml-syntax | replace it with `’`, or delete it"]),
        ("bom-inside.yaml", ["8:1 yaml-syntax | delete it"]),
        ("anchor-twice.yaml", []),
        ("alias-slip.yaml", ["11:9 yaml-syntax | did you mean `*steps`?"]),
        ("phrases-as-text.yaml", ["4:13 foreign-pattern | write separate phrases: [dance, dance for me]"]),
        ("phrases-with-commas.yaml", ["3:15 foreign-pattern | write separate phrases: [dance, dance for me]"]),
        ("braces-of-others.yaml", ["6:15 not-filled-in | write `{{ context.visitor }}`"]),
        ("filter.yaml", ["6:42 expression-syntax | there are no filters: delete `| title`"]),
        (
            "homoglyph.yaml",
            ["6:5 unknown-key | did you mean `onDone`? `о` is a different letter from `o`: U+043E"],
        ),
        ("other-minus.motion.yaml", ["2:32 wrong-type | write `-0.5`: `−` is not the minus sign `-`"]),
        ("at-iso.yaml", ["4:10 bad-time | write `2026-12-24 18:00`"]),
    ],
)
def test_the_error_is_reported_at_its_place_with_a_correction(name: str, expected: list[str]) -> None:
    assert_told(found(name, (INPUTS / name).read_bytes()), expected)


def changed(old: str, new: str, more: str = "") -> bytes:
    assert STATES.count(old) == 1
    return (STATES.replace(old, new) + more).encode()


BREAKS = {"lf": "\n", "crlf": "\r\n", "cr": "\r"}
NO_BREAKS = {"next line": "\x85", "line separator": "\u2028", "paragraph separator": "\u2029"}


@for_each("end", BREAKS.values(), ids=BREAKS)
@for_each("sign", ["", *NO_BREAKS.values()])
def test_lines_are_counted_alike_with_any_ending_and_content(end: str, sign: str) -> None:
    text = changed("say: Hello", f'say: "Hel{sign}{sign}lo"').decode().replace("onError: idle", "onError: idel")
    content = text.replace("\n", end).encode()
    assert_told(found("tour.yaml", content), ["8:14 unknown-state | did you mean `idle`?"])
    after, done = repaired(
        project("tour.yaml", content), lambda files: check_files(HERE, files)[1], lambda diagnostic: True
    )
    assert after[TOUR] == text.replace("idel", "idle").replace("\n", end).encode()
    assert [fix.title for _, fix in done] == ["write idle"]


@for_each("sign", NO_BREAKS.values(), ids=NO_BREAKS)
def test_a_line_break_of_yaml_1_1_alone_is_part_of_a_text(sign: str) -> None:
    document, diagnostics = parse("a.yaml", f"# note{sign}not: read\na: [x{sign}y, '{sign}', \"\\L\"]\n".encode())
    assert not diagnostics
    assert document is not None
    assert document.data == {"a": [f"x{sign}y", sign, "\u2028"]}
    assert document.place(("a", 0)).line == 2


def test_the_placeholders_for_those_breaks_are_kept_in_a_text() -> None:
    text = "a: \ue000\u2028\ue001\x85"
    document, _ = parse("a.yaml", text.encode())
    assert document is not None
    assert document.data == {"a": "\ue000\u2028\ue001\x85"}


@for_each("text", ["", "a", "a\n", "a\rb\r\nc\n\rd", "\u2028a\x0bb\x0c\x1c\x85\n", "\r\r\n\n"])
def test_offsets_and_places_belong_together(text: str) -> None:
    lines, index = lines_of(text), LineIndex(text)
    assert index.line(len(text)) == len(lines)
    for offset in range(len(text) + 1):
        assert index.offset(index.line(offset), index.column(offset)) == offset


def test_the_excerpt_beside_a_finding_is_the_line_that_it_is_about(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for file, content in project("tour.yaml", (INPUTS / "line-separator-place.yaml").read_bytes()).items():
        path = tmp_path / file
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
    assert main(["lint", str(tmp_path)]) == 1
    assert " 7 |     onError: idel\n   |              ^^^^" in capsys.readouterr().out


@for_each(
    ("content", "expected"),
    [
        (STATES.encode("utf-16-le"), "1:1 not-utf8 | save it as UTF-8"),
        (STATES.encode("utf-16-be"), "1:1 not-utf8 | save it as UTF-8"),
        (STATES.encode("utf-16"), "1:1 not-utf8 | save it as UTF-8"),
        (changed("Hello", "It’s").decode().encode("cp1252"), "6:17 not-utf8 | save it as UTF-8"),
        (changed("Hello", "a\x07b"), "6:16 yaml-syntax | delete it"),
        (changed("Hello", "Hé \x93Hello\x94"), "6:18 yaml-syntax | replace it with `“`, or delete it"),
        (
            changed("  greet:", "\u200b  greet:"),
            "5:1 unknown-key | write `greet`: it contains an invisible",
        ),
        (
            changed("  greet:", "  \ufeffgreet:"),
            "5:3 wrong-key | write `greet`: it contains an invisible",
        ),
        (changed("onDone: idle", "onDone: *idle"), '7:13 yaml-syntax | put quotes around it if it is a text: "*idle"'),
        (changed("{say: Hello}", "{say: *Hello*}"), "6:15 yaml-syntax | put quotes around it"),
    ],
)
def test_a_character_that_yaml_does_not_allow_is_named_at_its_place(content: bytes, expected: str) -> None:
    assert_told(found("tour.yaml", content), [expected])


def test_an_alias_refers_to_the_nearest_anchor_above() -> None:
    document, diagnostics = parse("a.yaml", b"a: &x 1\nb: *x\nc: &x [2]\nd: *x\n")
    assert not diagnostics
    assert document is not None
    assert document.data == {"a": 1, "b": 1, "c": [2], "d": [2]}


@for_each(
    ("content", "expected"),
    [
        (changed("{say: Hello}", "{sаy: Hello}"), "6:10 unknown-key | did you mean `say`? `а` is a different letter"),
        (
            changed("onDone: idle", "onDone: іdle"),
            "7:13 unknown-state | did you mean `idle`? `і` is a different letter",
        ),
        (
            changed("onDone: idle", "onDone: idle\u200b"),
            "7:13 unknown-state | did you mean `idle`? it contains an invis",
        ),
        (
            changed("onDone: idle", "ｏｎＤｏｎｅ: idle"),
            "7:5 unknown-key | did you mean `onDone`? `ｏ` is a different",
        ),
        (
            changed("say: Hello", 'say: "{{ context.n − 1 }}"', "context: {n: 1}\n"),
            "6:29 expression-syntax | write `-`: `−` is not the minus sign",
        ),
        (
            changed("say: Hello", 'say: "{{ context.n + １ }}"', "context: {n: 1}\n"),
            "6:31 expression-syntax | write `1`: `１` is a different digit",
        ),
    ],
)
def test_the_difference_between_look_alike_words_is_reported(content: bytes, expected: str) -> None:
    assert_told(found("tour.yaml", content), [expected])


@for_each(
    ("value", "expected"),
    [
        ("０．５", "write `0.5`: `０` is a different digit from `0`: U+FF10"),
        ("–0.5", "write `-0.5`: `–` is not the minus sign"),
        ("−0,5", "write a point: -0.5"),
        ("٣", "write `3`: `٣` is a different digit from `3`"),
    ],
)
def test_a_number_with_look_alike_characters_is_corrected(value: str, expected: str) -> None:
    content = f"keyframes:\n  - {{at: 1s, joints: {{HeadYaw: {value}}}}}\n".encode()
    assert [d.hint[: len(expected)] for d in found("a.motion.yaml", content)] == [expected]


HEARD = """
  heard:
    hears: {dance: idle}
    after: {5s: idle}
"""


@for_each(
    ("phrases", "hints"),
    [
        ('"hello, good morning"', ["write separate phrases: [hello, good morning]"]),
        ('"halt; stop"', ["write separate phrases: [halt, stop]"]),
        ("halt / stop", ["write `(halt|stop)`, or a phrase for each"]),
        ('"halt\\nstop now"', ["write separate phrases: [halt, stop now]"]),
        ('["sit, please", "oh robot, (sit|rest)"]', []),
        ('"(run|walk), please"', []),
        (">\n      jump\n      now", []),
    ],
)
def test_a_text_of_several_phrases_is_reported(phrases: str, hints: list[str]) -> None:
    content = f"phrases:\n  dance:\n    en: {phrases}{STATES.replace('greet}', 'heard}', 1)}{HEARD}"
    said = [d.hint for d in found("tour.yaml", content.encode()) if d.code == "foreign-pattern"]
    assert said == hints


@for_each(
    ("text", "expected"),
    [
        ("Hello, ${visitor}!", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, #{visitor}!", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, %visitor%", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, %(visitor)s", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, <visitor>", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, { visitor }", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, {name}", "not-filled-in | write `{{ context.NAME }}`; `context` has no `name`"),
        ("{% if context.visitor %}Hi{% endif %}", "not-filled-in | texts have no `{% … %}`"),
        ("{# a note #} Hi", "not-filled-in | texts have no `{# … #}`"),
        (
            "Hello, {{{ context.visitor }}}!",
            "expression-syntax | write two braces on each side: `{{ context.visitor }}`",
        ),
        ("{{ context.visitor | length }}", "expression-syntax | there are no filters: write `size(context.visitor)`"),
        (
            "{{ context.visitor | default('you') }}",
            "expression-syntax | there are no filters: write `has(context.visitor) ? context.visitor : 'you'`",
        ),
        ("{{ context.a | context.c }}", "expression-syntax | write `||`"),
        ("5 % of [them] cost $5, <b>really</b>, {{ {'a': 1}.a }}", ""),
    ],
)
def test_a_placeholder_of_another_tool_is_corrected(text: str, expected: str) -> None:
    content = changed("say: Hello", f'say: "{text}"', "context: {visitor: my friend, a: true, c: true}\n")
    said = [f"{d.code} | {d.hint}" for d in found("tour.yaml", content) if d.code != "unused-context-key"]
    assert [each[: len(expected)] for each in said] == [expected] * bool(expected)


@for_each(
    ("time", "hint"),
    [
        ("2026-12-24T18:00:00", "write `2026-12-24 18:00`"),
        ("2026-12-24T18:00:00Z", "write `2026-12-24 18:00`; convert it to the project's time zone"),
        ("2026-12-24t8:00+01:00", "write `2026-12-24 08:00`; convert it to the project's time zone"),
        ("0 18 * * 1-5", "this is cron syntax: write `mon-fri 18:00`"),
        ("0 18 * * 0-7", "this is cron syntax: write `18:00`"),
        ("2026-99-99T99:99Z", "write `2026-12-24 18:00`"),
        ("30 9,14 * * *", "this is cron syntax: write `09:30, 14:30`"),
        ("0 0 18 ? * MON-FRI", "this is cron syntax: write `mon-fri 18:00`"),
        ("*/5 * * * *", "this is cron syntax: write days before times"),
        ("18:00-19:00", "`at` is one moment, not a period"),
    ],
)
def test_a_time_of_another_tool_is_corrected_for_at(time: str, hint: str) -> None:
    content = changed("    on: {touched: greet}", f'    on: {{touched: greet}}\n    at: {{"{time}": greet}}')
    assert_told(found("tour.yaml", content), [f"5:10 bad-time | {hint}"])


def placed(root: Path, files: dict[str, bytes]) -> Path:
    for file, content in files.items():
        path = root / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return root


MISSPELT = changed("onError: idle", "onError: idel")
CHART = '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0"><state id="a"/></scxml>'
WRITERS = {
    "import": ["import", "chart.scxml", "-o", "OUT.yaml"],
    "export": ["export", "scxml", "-o", "OUT.scxml"],
    "graph": ["graph", "-o", "OUT.dot"],
    "plot": ["plot", "motions/wave.yaml", "-o", "OUT.svg"],
    "schema": ["schema", "behavior", "-o", "OUT.json"],
    "test": ["test", "--format", "junit", "-o", "OUT.xml"],
}


@pytest.mark.parametrize("verb", [*sorted(WRITERS.keys() - {"plot"}), pytest.param("plot", marks=pytest.mark.process)])
def test_a_full_disk_leaves_the_file_that_was_there(
    verb: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    placed(tmp_path, read_files(MINIMAL))
    (tmp_path / "chart.scxml").write_text(CHART)
    output = tmp_path / WRITERS[verb][-1]
    monkeypatch.chdir(tmp_path)
    assert main(WRITERS[verb]) == 0  # Matplotlib looks for fonts when it is first used
    output.write_text("kept")
    before = sorted(tmp_path.rglob("*"))

    def full(handle: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as disk:
        disk.setattr(os, "fsync", full)
        assert main(WRITERS[verb]) == 2
    assert f"can't write {output.name}: no space left on device" in capsys.readouterr().err
    assert output.read_text() == "kept"
    assert sorted(path for path in tmp_path.rglob("*") if ".lumen" not in path.parts) == before
    assert main(WRITERS[verb]) == 0
    assert output.read_text() != "kept"


def test_a_disk_that_refuses_half_of_a_file_leaves_the_whole_one(tmp_path: Path) -> None:
    file, kept = tmp_path / "a", resource.getrlimit(resource.RLIMIT_FSIZE)
    file.write_bytes(b"kept")
    resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, kept[1]))
    try:
        with pytest.raises(OSError, match="large"):
            replace_file(file, b"x" * 100_000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, kept)
    assert file.read_bytes() == b"kept"
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_a_repaired_file_keeps_its_owner_its_rights_and_its_link(tmp_path: Path) -> None:
    placed(tmp_path, project("tour.yaml", MISSPELT))
    file, real = tmp_path / TOUR, tmp_path / "behaviors" / "real.txt"
    file.rename(real)
    file.symlink_to("real.txt")
    real.chmod(0o640)
    if os.geteuid() == 0:
        os.chown(real, 65534, 65534)
    before = real.stat()
    assert main(["lint", "--fix", str(tmp_path)]) == 0
    after = real.stat()
    assert real.read_bytes() == STATES.encode()
    assert file.is_symlink()
    assert (after.st_uid, after.st_gid, after.st_mode) == (before.st_uid, before.st_gid, before.st_mode)
    assert after.st_mtime_ns >= before.st_mtime_ns


def test_a_file_of_another_owner_is_written_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a"
    file.write_bytes(b"a longer text")
    number, stat = file.stat().st_ino, os.stat

    def of_another(path: Path, **options: bool) -> os.stat_result:
        found = stat(path, **options)
        return os.stat_result((*found[:4], found.st_uid + (path == file), *found[5:]))

    def refused(*given: object) -> None:
        raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))

    with monkeypatch.context() as patch:
        patch.setattr(os, "stat", of_another)
        patch.setattr(os, "chown", refused)
        replace_file(file, b"new")
    assert (file.read_bytes(), file.stat().st_ino) == (b"new", number)
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_a_file_that_a_container_mounts_alone_is_written_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a"
    file.write_bytes(b"a longer text")

    def busy(*given: object) -> None:
        raise OSError(errno.EBUSY, os.strerror(errno.EBUSY))

    monkeypatch.setattr(os, "replace", busy)
    replace_file(file, b"new")
    assert file.read_bytes() == b"new"
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


@for_each("number", [errno.EACCES, errno.EROFS])
def test_a_file_in_a_folder_without_room_for_another_is_written_to(number: int) -> None:
    """For example a writable file in a folder that only its owner may write."""
    with TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        file = Path(folder, "a")
        file.write_bytes(b"a longer text")

        def refused(*given: object) -> None:
            raise OSError(number, os.strerror(number))

        patch.setattr(replacing, "_write", refused)
        replace_file(file, b"new")
        assert file.read_bytes() == b"new"
        with pytest.raises(OSError, match=os.strerror(number)):
            replace_file(Path(folder, "b"), b"new")


def test_a_file_that_may_not_be_written_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a"
    file.write_bytes(b"kept")
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(PermissionError):
        replace_file(file, b"new")
    assert file.read_bytes() == b"kept"


def test_a_folder_called_dev_holds_files_like_any_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "robots" / "dev" / "a"
    file.parent.mkdir(parents=True)
    file.write_bytes(b"old")
    before = file.stat().st_ino
    monkeypatch.chdir(tmp_path)
    replace_file(Path("robots/dev/a"), b"new")
    assert file.read_bytes() == b"new"
    assert file.stat().st_ino != before


def test_a_target_that_is_no_regular_file_is_written_to(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    replace_file(Path("/dev/stdout"), b"printed")
    replace_file(Path(os.devnull), b"gone")
    assert capfd.readouterr().out == "printed"
    assert not Path(os.devnull).is_file()
    with pytest.raises(OSError, match="irectory"):
        replace_file(tmp_path, b"no")
    loop = tmp_path / "loop"
    loop.symlink_to("loop")
    with pytest.raises(OSError, match="symbolic links"):
        replace_file(loop, b"no")


@pytest.mark.network
def test_a_recording_under_another_name_prints_that_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    placed(tmp_path, read_files(MINIMAL))
    file = tmp_path / "a.mcap"
    command = ["run", str(tmp_path), "--robot", "recording", "--speed", "max", "--story", "visitor"]
    assert main([*command, "--record", str(file)]) == 0
    assert "is there already" not in capsys.readouterr().out
    first = file.read_bytes()
    assert main([*command, "--record", str(file)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert f"{file} already exists: this recording is saved as {tmp_path / 'a-2.mcap'}" in told
    assert file.read_bytes() == first


def small(root: Path) -> Path:
    """Write a small project to the disk; its behaviour plays a motion."""
    return placed(root, read_files(MINIMAL))


def findings(root: Path) -> list[str]:
    return [f"{d.place.file}:{d.place.line} {d.code} | {d.hint}" for d in check(root)]


@for_each(
    ("old", "new", "expected"),
    [
        ("motions/wave.yaml", "motions/wave.yaml.txt", "motions/wave.yaml.txt to motions/wave.yaml"),
        ("motions/wave.yaml", "motions/wave.YAML", "motions/wave.YAML to motions/wave.yaml"),
        ("motions/wave.yaml", "motions/wave.Yml", "motions/wave.Yml to motions/wave.yaml"),
        ("motions/wave.yaml", "motions/Wave.yaml .txt", "motions/Wave.yaml .txt to motions/Wave.yaml"),
        ("motions", "Motions", "Motions/ to motions/"),
        ("behaviors/hello.yaml", "behaviors/hello.yaml.text", "behaviors/hello.yaml.text to behaviors/hello.yaml"),
        ("behaviors/stories", "behaviors/Stories", "behaviors/Stories/ to behaviors/stories/"),
    ],
)
def test_a_file_whose_name_is_nearly_right_is_named(old: str, new: str, expected: str) -> None:
    with TemporaryDirectory() as folder:
        root = small(Path(folder))
        (root / old).rename(root / new)
        told = findings(root)
        assert any(each.endswith(f" | rename {expected}") for each in told), told
        meant = expected.partition(" to ")[2]
        assert f"{new}:1 not-read | rename it to {meant if meant.endswith('/') else Path(meant).name}" in told


def test_a_copy_in_the_same_folder_is_not_part_of_the_project(tmp_path: Path) -> None:
    root = small(tmp_path)
    for copy in ("motions/wave.yaml.txt", "motions/wave.YAML", "motions/notes.txt", "motions/.wave.yaml.txt"):
        (root / copy).write_text("a")
    assert findings(root) == []


@for_each("name", ["lumen.yml", "Lumen.yaml", "lumen.yaml.txt", "lumen.YAML"])
@for_each("command", [["lint"], ["lint", "."], ["run", "--story", "visitor"], ["doctor"], ["graph"]])
def test_a_main_file_under_another_name_is_named(name: str, command: list[str]) -> None:
    with TemporaryDirectory() as folder, contextlib.chdir(folder):
        root = small(Path(folder))
        (root / "lumen.yaml").rename(root / name)
        told = io.StringIO()
        with contextlib.redirect_stderr(told), contextlib.redirect_stdout(told):
            assert main(command) != 0
        assert f"rename {name} to lumen.yaml" in told.getvalue()


def test_a_folder_elsewhere_shows_no_names(tmp_path: Path) -> None:
    root = small(tmp_path / "project")
    (tmp_path / "secrets").mkdir()
    (tmp_path / "secrets" / "tops3cret.yaml.txt").write_text("a")
    (root / "fuzzy").symlink_to(tmp_path / "secrets")
    hint = "replace it with a folder inside the project: Lumen reads nothing outside the project"
    assert findings(root) == [f"fuzzy:1 unreadable-file | {hint}"]


def closed(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Let the system refuse to list that folder, as `chmod 000` does for all users except root."""
    listdir = os.listdir

    def refuse(path: Path | str = ".") -> list[str]:
        if Path(path) == folder:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return listdir(path)

    monkeypatch.setattr(os, "listdir", refuse)


@pytest.mark.parametrize("folder", ["knowledge", "motions", "behaviors/stories", "behaviors", "motions/life", "models"])
def test_a_folder_that_can_not_be_read_is_not_an_empty_one(
    folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = small(tmp_path)
    (root / folder).mkdir(exist_ok=True)
    closed(monkeypatch, root / folder)
    told = findings(root)
    assert f"{folder}:1 unreadable-file | make it a readable folder, or delete it" in told
    assert not [each for each in told if "missing" in each], told
    with pytest.raises(ProjectError, match="this can't be read: permission denied"):
        load(root)


@for_each("folder", ["stories", "words"])
def test_a_closed_folder_outside_the_project_is_ignored(folder: str) -> None:
    with TemporaryDirectory() as name, pytest.MonkeyPatch.context() as patch:
        root = small(Path(name))
        (root / folder).mkdir()
        closed(patch, root / folder)
        assert findings(root) == []


def test_a_closed_folder_is_a_change_that_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root = small(tmp_path)
    (root / "knowledge").mkdir()
    (root / "knowledge" / "hours.md").write_text("# Opening hours\n\nWe are open from nine to five.\n")
    here = read_files(root)
    closed(monkeypatch, root / "knowledge")
    there = read_files(root)
    assert fingerprint(there) != fingerprint(here)
    project, diagnostics = check_files(root, there)
    assert project is None
    assert [(d.code, d.place.file) for d in diagnostics] == [("unreadable-file", "knowledge")]


CAFE = "caf\u00e9"
DECOMPOSED = unicodedata.normalize("NFD", CAFE)


def french(root: Path, name: str) -> Path:
    """Write the small project with the motion `café` instead of `wave`, in a file called `name`."""
    small(root)
    (root / WAVE).rename(root / "motions" / f"{name}.yaml")
    for file in root.rglob("*.yaml"):
        text = file.read_text().replace("play: wave", f"play: {CAFE}")
        file.write_text(text.replace("played: wave", f"played: {CAFE}"))
    return root


def test_a_file_name_of_a_mac_is_found(tmp_path: Path) -> None:
    there, root = french(tmp_path / "a", CAFE), french(tmp_path / "b", DECOMPOSED)
    assert findings(root) == []
    assert list(load(root).motions) == [CAFE]
    assert load(root).hash == load(there).hash
    assert main(["lint", str(root / "motions" / f"{DECOMPOSED}.yaml")]) == 0


@pytest.mark.process
def test_a_motion_with_a_file_name_of_a_mac_is_plotted(tmp_path: Path) -> None:
    root = french(tmp_path, DECOMPOSED)
    assert main(["plot", f"{root}/motions/{DECOMPOSED}.yaml", "-o", str(tmp_path / "a.svg")]) == 0


def test_a_repair_is_written_into_the_file_of_a_mac(tmp_path: Path) -> None:
    root = placed(tmp_path, project("tour.yaml", MISSPELT))
    file = root / "behaviors" / f"{DECOMPOSED}.yaml"
    (root / TOUR).rename(file)
    (root / "lumen.yaml").write_text((root / "lumen.yaml").read_text().replace("behavior: tour", f"behavior: {CAFE}"))
    before = sorted(root.rglob("*.yaml"))
    assert main(["lint", "--fix", str(root)]) == 0
    assert file.read_bytes() == STATES.encode()
    assert sorted(root.rglob("*.yaml")) == before


def test_one_of_two_files_with_the_same_name_is_reported(tmp_path: Path) -> None:
    root = french(tmp_path, DECOMPOSED)
    (root / "motions" / f"{CAFE}.yaml").write_bytes((root / "motions" / f"{DECOMPOSED}.yaml").read_bytes())
    if len(list((root / "motions").iterdir())) == 1:
        pytest.skip("this file system holds one file of that name")
    [told] = findings(root)
    assert told.endswith("not-read | combine them, or rename one of them")


def lumen(root: Path, *words: str, **settings: str) -> tuple[int, str]:
    """Run `lumen` with these environment variables; return its exit code and its whole output."""
    environment = {name: value for name, value in os.environ.items() if name not in ("MUJOCO_GL", "DISPLAY")}
    command = [sys.executable, "-m", "lumen", *words]
    done = run_guarded(command, cwd=root, env=environment | settings, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.physics
@pytest.mark.parametrize(
    ("setting", "why"),
    [
        ({"MUJOCO_GL": "nonsense"}, "MUJOCO_GL=nonsense does not work here (invalid value"),
        ({"MUJOCO_GL": "glfw"}, "MUJOCO_GL=glfw draws on a screen, but this machine has none"),
        ({"MUJOCO_GL": "disable"}, "there is no OpenGL library"),
    ],
    ids=["nonsense", "glfw", "disable"],
)
def test_without_pictures_everything_else_still_runs(setting: dict[str, str], why: str, tmp_path: Path) -> None:
    placed(tmp_path, read_files(MINIMAL))
    code, told = lumen(tmp_path, "play", "wave", "--speed", "max", **setting)
    assert (code, told.count("\n")) == (0, 2), told
    code, told = lumen(tmp_path, "play", "wave", "--speed", "max", "--video", "a.mp4", **setting)
    assert (code, told.count("\n")) == (2, 1), told
    assert told.startswith(f"lumen play: {why}")


@pytest.mark.physics
def test_a_backend_without_its_library_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    from lumen.features.simulation import gl  # imported here: it takes 0.5 s

    monkeypatch.setattr(gl, "_loads", lambda library: False)
    assert gl._fault("osmesa") == (
        "MUJOCO_GL=osmesa needs libOSMesa.so.8, which is not installed: unset it, or set it to egl, osmesa or disable"
    )
    assert gl.choose() == "disable"


@pytest.mark.physics
@pytest.mark.pictures
@pytest.mark.slow
def test_a_program_that_is_no_ffmpeg_is_named(tmp_path: Path) -> None:
    placed(tmp_path, read_files(MINIMAL))
    code, told = lumen(
        tmp_path, "play", "wave", "--speed", "max", "--video", "a.mp4", IMAGEIO_FFMPEG_EXE=str(tmp_path / "none")
    )
    assert code == 2
    assert f"IMAGEIO_FFMPEG_EXE={tmp_path / 'none'} is not ffmpeg: unset it" in told
    assert "Traceback" not in told


SETTINGS = {
    "LANG": "xx_YY.UTF-9", "TZ": "Nowhere", "COLUMNS": "abc", "LINES": "-1", "TERM": "nonsense", "NO_COLOR": "",
    "TMPDIR": "/nowhere", "HOME": "/dev/null", "XDG_CACHE_HOME": "/dev/null", "XDG_STATE_HOME": "relative",
    "MPLBACKEND": "nonsense", "MPLCONFIGDIR": "/dev/null", "MUJOCO_GL": "nonsense", "PYTHONIOENCODING": "ascii",
    "PYTHONTZPATH": "/nowhere", "LUMEN_BUS_CREDENTIALS": "/nowhere", "LUMEN_HOUSE": "none",
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ["lint"],
        ["run", "--robot", "recording", "--speed", "max", "--story", "visitor"],
        ["plot", "motions/wave.yaml", "-o", "wave.svg"],
        ["explain", "yaml-syntax"],
    ],
    ids=lambda words: words[0],
)
def test_a_wrong_setting_that_is_not_needed_is_ignored(words: list[str], tmp_path: Path) -> None:
    placed(tmp_path, read_files(MINIMAL))
    code, told = lumen(tmp_path, *words, **SETTINGS)
    assert code == 0, told
    assert "Traceback" not in told


def test_an_unknown_time_zone_of_the_environment_is_named(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("TZ", "Nowhere")
    used = local_timezone()
    assert f"TZ=Nowhere is not a known time zone: times of day are in {used}" in caplog.text
    caplog.clear()
    monkeypatch.setenv("TZ", ":Europe/Berlin")
    assert local_timezone() == "Europe/Berlin"
    assert not caplog.records


def test_without_a_temporary_folder_the_error_names_the_setting(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def none(options: object) -> int:
        raise FileNotFoundError(errno.ENOENT, "No usable temporary directory found in ['/nowhere']")

    monkeypatch.setattr("lumen.cli.lint.run", none)
    assert main(["lint"]) == 2
    assert "set TMPDIR to one that is" in capsys.readouterr().err
