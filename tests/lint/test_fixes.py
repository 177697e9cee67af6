"""`--fix` and `--diff`: repairs, mistakes left to the author, and no change for the worse."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.cli.main import main
from lumen.language.diagnostics import Diagnostic, Place, has_errors
from lumen.lint import check_files
from lumen.lint.fixes import edited, fixes
from lumen.lint.fixes.misspellings import near
from lumen.lint.repairs import repaired
from lumen.project.files import read_files
from tests.copying import copied_project
from tests.tables import for_each

HERE = Path(__file__).parent
BASE = read_files(HERE / "base")
TOUR, WAVE = "behaviors/tour.yaml", "motions/wave.yaml"


def fixed(file: str, old: str, new: str) -> bytes:
    """Return that file of the small project with `old` replaced by `new`, after all possible repairs."""
    text = BASE[file].decode()
    assert text.count(old) == 1
    files = {**BASE, file: text.replace(old, new).encode()}
    return repaired(files, lambda f: check_files(HERE, f)[1], lambda d: True)[0][file]


@for_each(
    ("file", "right", "wrong"),
    [
        (TOUR, "onError: idle", "onError: idel"),
        (WAVE, "left: 1.0", "left: 1,0"),
        (TOUR, "onError: idle", "onError: idle   # lumen: ignore[no-effect] x"),
        (TOUR, "onError: idle", "onError: idle\n    # lumen: ignore[no-effect] x"),
        (TOUR, "    onDone: talk", "    ondone: talk"),
        (TOUR, "play: wave", "paly: wave"),
        (TOUR, "play: wave", "play: Wave"),
        (TOUR, "posture: Stand", "posture: Stnad"),
        (TOUR, "{{ context.visitor }}", "{{ context.visitr }}"),
        (TOUR, "      - wait: 500ms", "\t\t\t- wait: 500ms"),
        (TOUR, "    onError: idle\n", "    onError: idle\n    onDone: talk\n"),
        (WAVE, "joints: {LShoulderPitch: -60}", 'joints: {LSholderPitch: "-60"}'),
        (TOUR, "    onError: idle\n", "    onError: idle\n    onError: idle\n"),
        (TOUR, "{{ context.visitor }}", "{context.visitor}"),
        (TOUR, '{en: "I am small."', "{en: “I am small.”"),
        ("fuzzy/head.yaml", "Turn is Left", "Turn is Lfet"),
        ("fuzzy/head.yaml", "if Face is Left then", "if Face is Left than"),
        ("lumen.yaml", "story: hello", "story: helo"),
    ],
)
def test_a_slip_is_repaired(file: str, right: str, wrong: str) -> None:
    assert fixed(file, right, wrong) == BASE[file]


@for_each(
    ("file", "old", "new"),
    [
        (WAVE, "LShoulderPitch: -60", "RShoulderPitch: -60"),
        (TOUR, "onError: idle", "onError: somewhere"),
        (TOUR, "onError: idle\n", "onError: idle\n    onDone: idle\n"),
        (TOUR, "  talk:\n", "  greet: {}\n  talk:\n"),
        (TOUR, "onError: idle\n", "onError: idle  # home\n    onError: idle  # away\n"),
        (TOUR, "    entry:\n      - {posture: Stand}\n", "    entry:\n      - {posture: Stand}\n    entry:\n"),
        (TOUR, "onDone: talk", "onDone: [talk"),
        (TOUR, "{raise: over}", "{raise: unheard}"),
    ],
)
def test_what_only_its_author_can_know_is_left(file: str, old: str, new: str) -> None:
    assert fixed(file, old, new).decode() == BASE[file].decode().replace(old, new)


def test_where_the_definition_has_the_slip_the_references_stay() -> None:
    controller = BASE["fuzzy/head.yaml"]
    text = controller.replace(b"Face: {range", b"Faec: {range")
    files = {**BASE, "fuzzy/head.yaml": text}
    assert repaired(files, lambda f: check_files(HERE, f)[1], lambda d: True)[0] == files


def test_line_ends_comments_and_a_byte_order_mark_stay() -> None:
    text = BASE[TOUR].decode().replace("onError: idle", "onError: idel   # home").replace("\n", "\r\n")
    files = {**BASE, TOUR: b"\xef\xbb\xbf" + text.encode()}
    after = repaired(files, lambda f: check_files(HERE, f)[1], lambda d: True)[0][TOUR]
    assert after == files[TOUR].replace(b"idel", b"idle")


def test_one_code_of_a_comment_goes_and_the_other_stays() -> None:
    after = fixed(
        TOUR,
        "- {raise: over}",
        "- {raise: over}\n          - {raise: hi}  # lumen: ignore[no-effect, unused-event] soon",
    )
    assert b"- {raise: hi}  # lumen: ignore[unused-event] soon" in after


def test_every_repair_of_many_mistakes_leaves_less_to_say() -> None:
    text = BASE[TOUR].decode().replace("idle", "idel", 1).replace("play:", "paly:").replace("Halo", "Halo\t")
    files = {**BASE, TOUR: text.encode(), WAVE: BASE[WAVE].replace(b"Stand", b"Stnad")}
    after, done = repaired(files, lambda f: check_files(HERE, f)[1], lambda d: True)
    assert len(check_files(HERE, after)[1]) <= len(check_files(HERE, files)[1]) - len(done)
    assert (
        check_files(HERE, repaired(after, lambda f: check_files(HERE, f)[1], lambda d: True)[0])[1]
        == (check_files(HERE, after)[1])
    )


def test_of_two_lines_the_one_with_the_comment_stays() -> None:
    after = fixed(TOUR, "    onError: idle\n", "    onError: idle\n    onError: idle  # home\n")
    assert after.decode() == BASE[TOUR].decode().replace("    onError: idle\n", "    onError: idle  # home\n")


def test_many_slips_cost_few_looks() -> None:
    names = "".join(f"  s{i:03}: {{do: {{play: wvae}}}}\n" for i in range(64))
    looks = []

    def check(files: Mapping[str, bytes]) -> Sequence[Diagnostic]:
        looks.append(1)
        wrong = [n for n, line in enumerate(files["a.yaml"].decode().splitlines(), 1) if "wvae" in line]
        bad = "there is no motion `wvae`"
        return [Diagnostic("unknown-key", bad, Place("a.yaml", n, 21, n, 25), "did you mean `wave`?") for n in wrong]

    after, done = repaired({"a.yaml": names.encode()}, check, lambda d: True)
    assert after == {"a.yaml": names.replace("wvae", "wave").encode()}
    assert (len(done), len(looks)) == (64, 2)


@pytest.mark.slow
@settings(max_examples=40)
@given(st.sampled_from(sorted(f for f in BASE if f.endswith(".yaml"))), st.data())
def test_every_proposal_is_within_the_file_and_makes_its_finding_go_or_is_not_made(
    file: str, data: st.DataObject
) -> None:
    text = BASE[file].decode()
    at = data.draw(st.integers(0, len(text) - 1))
    new = data.draw(st.sampled_from(["", "\t", "\r\n", "# lumen: ignore[tab] x\n", text[at : at + 2][::-1], "\u2028"]))
    files = {**BASE, file: (text[:at] + new + text[at + data.draw(st.integers(0, 2)) :]).encode()}
    found = check_files(HERE, files)[1]
    for diagnostic in found:
        for fix in fixes(diagnostic, files):
            for edit in fix.edits:
                assert edit.place.line >= 1
                assert edit.place[1:3] <= edit.place[3:5]
            assert edited(files[file], fix.edits) != files[file]
    after, done = repaired(files, lambda f: check_files(HERE, f)[1], lambda d: True)
    left = check_files(HERE, after)[1]
    assert bool(done) == (after != files)
    assert not (has_errors(left) and not has_errors(found))


@for_each(
    ("word", "meant", "is_near"),
    [
        ("idel", "idle", True), ("gret", "greet", True), ("greeet", "greet", True), ("graet", "great", True),
        ("Wave", "wave", True), ("LHand", "RHand", False), ("state1", "state2", False), ("in", "on", False),
        ("danse", "goodbye", False), ("greting", "greet", False), ("wave", "waves", True), ("", "", True),
    ],
)  # fmt: skip
def test_near(word: str, meant: str, is_near: bool) -> None:
    assert near(word, meant) is is_near


@pytest.fixture
def project(tmp_path: Path) -> Path:
    copied_project(HERE / "base", tmp_path / "p")
    file = tmp_path / "p" / TOUR
    file.write_text(file.read_text().replace("onError: idle", "onError: idel   # home"))
    file.chmod(0o640)
    return tmp_path / "p"


def test_diff_shows_and_changes_nothing(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(Path(__file__).parent)  # from where its path is shortest in full
    before = (project / TOUR).read_bytes()
    assert main(["lint", str(project), "--diff"]) == 1
    shown = capsys.readouterr().out
    assert "-    onError: idel   # home\n+    onError: idle   # home\n" in shown
    assert f"--- {project}/{TOUR}" in shown
    assert (project / TOUR).read_bytes() == before


def test_fix_writes_what_diff_showed(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", str(project), "--fix"]) == 0
    said = capsys.readouterr()
    assert said.out.startswith("nothing wrong; ")
    assert "[unknown-state] write idle\n1 finding fixed\n" in said.err
    assert b"onError: idle   # home" in (project / TOUR).read_bytes()
    assert (project / TOUR).stat().st_mode & 0o777 == 0o640
    assert main(["lint", str(project), "--diff"]) == 0
    assert sorted(file.name for file in (project / "behaviors").iterdir()) == ["stories", "tour.yaml"]


def test_fix_keeps_to_what_is_selected_and_named(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", str(project), "--diff", "--select", "speech"]) == 0
    assert main(["lint", str(project / WAVE), "--diff"]) == 0
    assert main(["lint", str(project / TOUR), "--diff"]) == 1


def test_a_folder_that_can_not_be_written_to(
    project: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> tuple[int, str]:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("os.replace", refuse)
    monkeypatch.setattr("lumen.upkeep.replacing._overwrite", refuse)  # nor the file itself
    assert main(["lint", str(project), "--fix"]) == 2
    assert "can't write" in capsys.readouterr().err
