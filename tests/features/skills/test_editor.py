"""Skills in an editor: completed, described, found, and renamed with their manifest."""

from pathlib import Path

from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import complete
from lumen.features.editor.definitions import definitions, uses
from lumen.features.editor.hover import hover
from lumen.features.editor.renaming import applied, refuse_harm, rename
from lumen.project.files import read_files
from tests.features.editor.test_services import place
from tests.features.skills.changing import BEHAVIOR, HERE, MANIFEST, STORY, project_in
from tests.tables import for_each

DO = "do: {spray: {duration: 3s, nozzle: left}}"
PROJECT = Analysis(HERE / "project", read_files(HERE / "project"))


@for_each(
    ("file", "old", "new", "some"),
    [
        (BEHAVIOR, "do: {spray: {duration: 3s, nozzle: left}}", "do: {s|", {"spray": "Sprays water", "say": None}),
        (
            BEHAVIOR,
            "do: {spray: {duration: 3s, nozzle: left}}",
            "do: {spray: {n|",
            {"nozzle": "", "duration": "How long"},
        ),
        (BEHAVIOR, "nozzle: left", "nozzle: |", {"left": "", "right": ""}),
        (STORY, "did: {spray: 3s}", "did: {s|", {"spray": "Sprays water"}),
        (STORY, "- visitor: arrives", "- skills: {s|", {"spray": "Sprays water"}),
    ],
)
def test_a_skill_is_completed(file: str, old: str, new: str, some: dict[str, str | None]) -> None:
    text = PROJECT.text(file).replace(old, new.replace("|", ""), 1)
    analysis = PROJECT.changed(file, text)
    at = place(analysis, file, new, PROJECT.text(file).index(old))
    found = {item.text.strip(": "): item.documentation for item in complete(analysis, *at)}
    assert {name: said for name, said in found.items() if name in some and some[name] is not None} == {
        name: said for name, said in some.items() if said is not None
    }
    assert some.keys() <= found.keys()


def test_hover_describes_a_skill_and_its_arguments() -> None:
    shown = hover(PROJECT, *place(PROJECT, BEHAVIOR, "do: {sp|ray:"))
    assert shown.startswith(
        "**skill `spray`**\n\nSprays water\n\narguments: `duration`, `nozzle`; takes `{{ duration }}`"
    )
    assert "How long" in hover(PROJECT, *place(PROJECT, BEHAVIOR, "{dur|ation: 3s"))


@for_each(("file", "text"), [(BEHAVIOR, "do: {sp|ray:"), (STORY, "did: {sp|ray:")])
def test_the_definition_of_a_skill_is_its_manifest(file: str, text: str) -> None:
    assert [found.file for found in definitions(PROJECT, *place(PROJECT, file, text))] == [MANIFEST]
    assert {found.file for found in uses(PROJECT, *place(PROJECT, file, text))} >= {BEHAVIOR, STORY}


def test_a_skill_is_renamed_with_its_manifest_and_lint_names_the_function_to_rename(tmp_path: Path) -> None:
    root = project_in(tmp_path)
    analysis = Analysis(root, read_files(root))
    use = analysis.index.at(*place(analysis, BEHAVIOR, "do: {sp|ray:"))
    assert use
    renaming = rename(analysis, use, "mist")
    assert renaming.moved == (MANIFEST, "skills/mist.yaml")
    after = applied(analysis, renaming)
    refuse_harm(analysis.diagnostics, after.diagnostics)
    assert "do: {mist: {duration" in after.text(BEHAVIOR)
    assert "did: {mist: 3s}" in after.text(STORY)
    assert [(each.code, each.hint) for each in after.diagnostics] == [
        ("skill-code", "rename `spray` to `mist`, or write `@skill` above `def mist(call, …):`")
    ]
