"""A skill in the YAML, from its manifest alone: read, linted at the word, timed, drawn and compared."""

from pathlib import Path

from lumen.insight.changes.actions import described
from lumen.language.commands import Do
from lumen.lint import check_files
from lumen.project import load
from lumen.project.added_verbs import time_taken
from lumen.project.files import read_files
from tests.features.skills.changing import BEHAVIOR, CODE, HERE, MANIFEST, found, lint, project_in
from tests.tables import for_each

USE = "spray: {duration: 3s, nozzle: left}"


def test_a_sound_project_has_no_findings_and_its_code_is_not_run(tmp_path: Path) -> None:
    root = project_in(tmp_path, {CODE: ("from lumen", "raise SystemExit(3)\nfrom lumen")})
    assert found(root) == []


@for_each(
    ("written", "arguments"),
    [
        (USE, {"duration": "3s", "nozzle": "left"}),
        ("spray: 2s", {"duration": "2s", "nozzle": "left"}),
        ("spray: {nozzle: right, duration: 2min}", {"duration": "2min", "nozzle": "right"}),
    ],
)
def test_a_skill_is_read_as_a_verb_with_its_short_form(tmp_path: Path, written: str, arguments: dict[str, str]) -> None:
    root = project_in(tmp_path, {BEHAVIOR: (USE, written)})
    (step,) = load(root).behaviors["fog"].states["spraying"].do
    assert step.action == Do("spray", arguments)
    assert isinstance(step.action, Do)
    assert time_taken(step.action) == {"3s": 3.0, "2s": 2.0, "2min": 120.0}[step.action.arguments["duration"]]


def test_a_project_has_the_rows_of_its_skills_with_its_folder_and_robot() -> None:
    row = load(HERE / "project").verbs["spray"]
    assert (row.root, row.robot, row.parts) == (str(HERE / "project"), "NAO", ("arms",))
    assert row.description == "Sprays water"
    assert row.arguments["properties"]["duration"]["description"] == "How long"


def test_two_projects_in_one_process_have_skills_of_their_own(tmp_path: Path) -> None:
    other = project_in(tmp_path / "other", {MANIFEST: ("default: left", "default: right")})
    for root, nozzle in [(HERE / "project", "left"), (other, "right"), (HERE / "project", "left")]:
        project = check_files(root, read_files(root))[0]
        assert project
        (step,) = project.behaviors["fog"].states["spraying"].do
        assert isinstance(step.action, Do)
        assert step.action.row
        assert step.action.row.arguments["properties"]["nozzle"]["default"] == nozzle


USES = [
    ("spry: 3s", "5:10 unknown-key | `spry` is not a key of `do` | did you mean `spray`?"),
    ("spray: {duraton: 3s}", "5:18 unknown-key | `duraton` is not a key of `spray` | did you mean `duration`?"),
    ("spray: soon", "5:17 bad-duration | `soon` is not a duration | write a number and its unit, such as `500ms`"),
    ("spray: 3", "5:17 wrong-type | `spray` should be a text, not a number | write the unit too: `3s`, or `3ms`"),
    ("spray: {nozzle: left}", "5:10 missing-key | `spray` needs the key `duration` | "),
    (
        "spray: {duration: 3s, nozzle: top}",
        "5:40 wrong-value | `nozzle` can't be `top` | allowed: `left`, `right`",
    ),
    (
        "spray: '{{ context.litre }}s'",
        "5:29 unknown-context-key | the context has no `litre` | did you mean `litres`?",
    ),
]


@for_each(("use", "finding"), USES)
def test_lint_reports_a_wrong_use_at_the_word(tmp_path: Path, use: str, finding: str) -> None:
    first, *_ = found(project_in(tmp_path, {BEHAVIOR: (USE, use)}))
    assert first.startswith(f"{BEHAVIOR}:{finding}")


@for_each(
    ("changes", "finding"),
    [
        (
            {BEHAVIOR: ("event.data.litres", "event.data.liters")},
            "behaviors/fog.yaml:8:45 unknown-field | `event.data` has no `liters` | did you mean `litres`?",
        ),
        (
            {BEHAVIOR: ("    onDone:\n", "    after: {2s: waiting}\n    onDone:\n")},
            "behaviors/fog.yaml:6:13 cut-short | `spraying` is left after 2 s, but its `do` takes about 3.0 s",
        ),
        (
            {
                BEHAVIOR: (f"do: {{{USE}}}", "do: [{rest: true}, {spray: 3s}]"),
                MANIFEST: ("parts:", "moves: true\nparts:"),
            },
            "behaviors/fog.yaml:5:25 moves-at-rest | the robot rests here, so it can't perform `spray`",
        ),
        (
            {"lumen.yaml": ("model: nao", "model: lantern"), MANIFEST: ("[arms]", "legs")},
            "behaviors/fog.yaml:5:10 left-out | Lantern has no legs, so it leaves out `spray`",
        ),
        (
            {
                BEHAVIOR: (f"do: {{{USE}}}", "do: {wait: 3s}"),
                "behaviors/stories/visitor.yaml": (", did: {spray: 3s}", ""),
            },
            "skills/spray.yaml:1:1 unused-skill | no behaviour uses the skill `spray` | write `spray:` in a `do`",
        ),
    ],
)
def test_lint_reports_what_follows_from_the_manifest(
    tmp_path: Path, changes: dict[str, tuple[str, str]], finding: str
) -> None:
    assert any(one.startswith(finding) for one in found(project_in(tmp_path, changes)))


@for_each(
    ("old", "new", "finding"),
    [
        (
            "{python: skills/spray.py}",
            "{command: [node, skills/spray.mjs]}",
            "10:32 skill-program | there is no file skills/spray.mjs | write this file",
        ),
        (
            "{enum: [left, right], default: left}",
            '{$ref: "#/$defs/side"}',
            "6:14 skill-schema | a skill can't use `$ref`: its schema becomes a part of another one"
            " | write the definition in its place",
        ),
    ],
)
def test_lint_marks_the_word_of_a_manifest(tmp_path: Path, old: str, new: str, finding: str) -> None:
    assert found(project_in(tmp_path, {MANIFEST: (old, new)})) == [f"{MANIFEST}:{finding}"]


def test_a_broken_manifest_is_the_only_finding(tmp_path: Path) -> None:
    root = project_in(tmp_path, {MANIFEST: ("takes: ", "take: ")})
    assert [(each.code, each.place.file, each.place.line) for each in lint(root)] == [("unknown-key", MANIFEST, 8)]


@for_each(
    ("old", "new", "code"),
    [
        ("in:\n", "in: [\n", "yaml-syntax"),
        ("type: string,", "type: text,", "wrong-value"),
        ("performed-by: {python: skills/spray.py}", "moves: true", "missing-key"),
        ("skills/spray.py", "../spray.py", "skill-file"),
        ("skills/spray.py", "skills/sprai.py", "skill-program"),
    ],
)
def test_nothing_else_is_reported_of_what_uses_a_skill_with_a_faulty_manifest(
    tmp_path: Path, old: str, new: str, code: str
) -> None:
    assert [(each.code, each.place.file) for each in lint(project_in(tmp_path, {MANIFEST: (old, new)}))] == [
        (code, MANIFEST)
    ]


def test_a_diff_and_a_transcript_name_it() -> None:
    assert described(Do("spray", {"duration": "3s"})) == "does `spray` with duration 3s"
