"""A skill that a keyframe of a motion begins: at its time, until its end, and no longer than a cancelled motion."""

import json
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import complete
from lumen.features.editor.definitions import definitions
from lumen.language.commands import Cancel, Do, Play, Start
from lumen.language.events import Event
from lumen.lint import check_files
from lumen.project import load
from lumen.project.files import read_files
from lumen.run.cues import MotionCues
from lumen.run.rehearsal import rehearse
from tests.features.editor.test_services import place
from tests.features.skills.changing import BEHAVIOR, MANIFEST, STORY, found, project_in
from tests.tables import for_each

MOTION = "motions/wave.yaml"
WAVE = """units: {angle: deg}
keyframes:
  - {at: 1s, joints: {HeadYaw: 20}, SKILL}
  - {at: 2s, joints: {HeadYaw: 0}}
"""
PLAYS = {BEHAVIOR: ("do: {spray: {duration: 3s, nozzle: left}}", "do: {play: wave}")}


def waving(folder: Path, skill: str) -> Path:
    """Return the project with a motion that has this key in its first keyframe, and a behaviour that plays it."""
    changes = {
        **PLAYS,
        MOTION: ("", WAVE.replace("SKILL", skill)),
        STORY: ("sprayed, did: {spray: 3s}, context: {litres: 0.1}", "sprayed"),
    }
    root = project_in(folder, changes)
    behavior = root / BEHAVIOR
    behavior.write_text(behavior.read_text("utf-8").replace("event.data.litres", "1"), "utf-8")
    return root


def test_a_motion_begins_a_skill_and_its_story_sees_that_it_was_done(tmp_path: Path) -> None:
    root = waving(tmp_path / "hall", "spray: {duration: 500ms, nozzle: right}")
    assert found(root) == []
    story = "steps: [{visitor: arrives}, {expect: {state: sprayed, did: {spray: {nozzle: right}}}}]\n"
    (root / STORY).write_text(story, "utf-8")
    project = load(root)
    assert not rehearse(project, project.stories["visitor"]).failed
    [begun] = project.motions["wave"].cues
    assert (begun.time, begun.kind) == (1.0, "skill")
    assert begun.value == {"skill": "spray", "arguments": {"duration": "500ms", "nozzle": "right"}}


def test_a_key_of_keyframes_wins_over_a_skill_of_its_name_and_the_skill_is_reported(tmp_path: Path) -> None:
    root = waving(tmp_path / "hall", "hold: head")
    text = (root / MANIFEST).read_text("utf-8")
    (root / "skills/hold.yaml").write_text(text.replace("spray.py", "hold.py"), "utf-8")
    (root / "skills/hold.py").write_text((root / "skills/spray.py").read_text("utf-8").replace("def spray", "def hold"))
    [finding] = [line for line in found(root) if "skill-keyframe" in line]
    message = "`hold` is a key of keyframes in motions, so no motion can begin this skill"
    assert finding == f"skills/hold.yaml:1:1 skill-keyframe | {message} | give the file another name"
    assert [cue.kind for cue in load(root).motions["wave"].cues] == ["hold"]


@pytest.mark.rest
def test_a_run_with_it_is_replayed_without_the_code(tmp_path: Path) -> None:
    root = waving(tmp_path / "hall", "spray: 500ms")
    assert main(["run", str(root), "--story", "visitor", "--robot", "recording", "--speed", "max"]) == 0
    (root / "skills/spray.py").unlink()
    assert main(["replay", "--project", str(root)]) == 0


def test_coverage_counts_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["test", str(waving(tmp_path / "hall", "spray: 500ms")), "--coverage", "--format", "json"])
    assert json.loads(capsys.readouterr().out)["coverage"]["skills"] == {"covered": 1, "of": 1}


def cue(value: object) -> Event:
    return Event("cue", {"motion": "wave", "kind": "skill", "value": value})


def test_it_ends_with_a_motion_that_is_cancelled_and_not_with_one_that_is_done(tmp_path: Path) -> None:
    project = load(waving(tmp_path, "spray: 1s"))
    for end, ended in (("cancelled", [Cancel("cue1")]), ("error", [Cancel("cue1")]), ("done", [])):
        cues = MotionCues()
        cues.performing(Start("d1", Play("wave")))
        begun = cues.answered(cue({"skill": "spray", "arguments": {"duration": "1s"}}), project, "en")
        assert begun == [Start("cue1", Do("spray", {"duration": "1s"}))]
        assert cues.answered(Event(f"{end}.command.d1"), project, "en") == ended


def test_a_cue_of_another_program_that_names_no_skill_begins_nothing(tmp_path: Path) -> None:
    project = load(project_in(tmp_path))
    for value in (None, "spray", {}, {"skill": 3, "arguments": {}}, {"skill": "spray", "arguments": [1]}):
        assert MotionCues().answered(cue(value), project, "en") == []


@for_each(
    ("key", "finding"),
    [
        (
            "spry: 3s",
            "motions/wave.yaml:3:37 unknown-key | `spry` is not a key of item 1 of",
        ),
        (
            "spray: {duration: 3s, nozle: left}",
            "`nozle` is not a key of `spray` | did you mean `nozzle`?",
        ),
        ("spray: soon", "motions/wave.yaml:3:44 bad-duration | `soon` is not a duration"),
        ("spray: {duration: soon}", "motions/wave.yaml:3:55 bad-duration | `soon` is not a duration"),
        ("spray: {duration: 3s, nozzle: up}", "wrong-value | `nozzle` can't be `up`"),
    ],
)
def test_lint_checks_it(tmp_path: Path, key: str, finding: str) -> None:
    lines = found(waving(tmp_path, key))
    assert [line for line in lines if finding in line], lines
    assert len(lines) == 1, lines


def test_lint_names_a_part_that_the_body_lacks(tmp_path: Path) -> None:
    root = waving(tmp_path, "spray: 1s")
    (root / "lumen.yaml").write_text((root / "lumen.yaml").read_text("utf-8").replace("model: nao", "model: lantern"))
    motion = root / MOTION
    motion.write_text(motion.read_text("utf-8").replace("joints: {HeadYaw:", "roles: {head.yaw:"), "utf-8")
    manifest = root / MANIFEST
    manifest.write_text(manifest.read_text("utf-8").replace("parts: [arms]", "parts: [legs]"), "utf-8")
    assert [line for line in found(root) if "wave.yaml" in line and "left-out" in line and "`spray`" in line]


def test_a_reload_of_the_manifest_reads_the_motion_again(tmp_path: Path) -> None:
    root = waving(tmp_path, "spray: 1s")
    assert found(root) == []
    manifest = root / MANIFEST
    manifest.write_text(manifest.read_text("utf-8").replace("default: left", "default: right"), "utf-8")
    project = check_files(root, read_files(root))[0]
    assert project
    assert project.motions["wave"].cues[0].value == {
        "skill": "spray",
        "arguments": {"duration": "1s", "nozzle": "right"},
    }


def test_an_editor_knows_it(tmp_path: Path) -> None:
    root = waving(tmp_path, "spray: 1s")
    analysis = Analysis(root, read_files(root))
    [definition] = definitions(analysis, *place(analysis, MOTION, "sp|ray: 1s"))
    assert definition.file == MANIFEST
    text = analysis.text(MOTION).replace("spray: 1s", "s")
    changed = analysis.changed(MOTION, text)
    at = place(changed, MOTION, "20}, s|")
    assert "spray" in {item.text.strip(": ") for item in complete(changed, *at)}
