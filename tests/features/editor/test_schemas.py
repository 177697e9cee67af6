"""The published schemas in an editor that has the YAML language server: what it completes, explains and refuses."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests import ROOT
from tests.copying import SHIPPED_FOLDERS
from tests.features.editor.client import Client
from tests.fetched import fetched
from tests.provided import program

SERVER = "node_modules/yaml-language-server/bin/yaml-language-server"
FILES = [
    "lumen.yaml", "behaviors/tour.yaml", "behaviors/stories/visitor.yaml", "fuzzy/head.yaml", "models/nao.yaml",
    "models/v6.yaml", "models/passages/sit-straddle.yaml", "motions/dance.yaml", "motions/goodbye.yaml",
    "motions/photo.yaml", "motions/sing.yaml",
]  # fmt: skip
TOUR, GOODBYE, SILENCE = "behaviors/tour.yaml", "motions/goodbye.yaml", "behaviors/stories/silence.yaml"

COMPLETED = {
    "a state": (TOUR, "onDone: watching\n", "onDone: watching\n        |\n", {"on", "always", "entry", "invoke"}),
    "a list of actions": (TOUR, "- say:\n", "- |\n              - say:\n", {"say", "play", "walk", "publish", "if"}),
    "actions in one line": (TOUR, "entry: {", "entry: {|", {"say", "assign", "raise"}),
    "a light": (TOUR, "eyes: turquoise", "eyes: turquoise, c|", {"chest", "left_ear"}),
    "a colour": (TOUR, "eyes: turquoise", "eyes: |", {"turquoise", "rebeccapurple"}),
    "an interpolation": (GOODBYE, "keyframes:\n", "interpolation: |\nkeyframes:\n", {"cubic", "bezier", "linear"}),
    "a keyframe": (GOODBYE, "leds: {eyes: cyan}", "leds: {eyes: cyan}, j|", {"joints", "pose", "say", "play"}),
    "operators": ("fuzzy/head.yaml", "operators: {", "operators: {n|, ", {"conjunction", "accuracy"}),
    "the robot": ("lumen.yaml", "robot: {name: NAO, model: nao}", "robot:\n  n|", {"name", "model"}),
    "a step of a story": (SILENCE, "- visitor: arrives", "- |", {"visitor", "says", "touch", "expect"}),
    "a visitor": (SILENCE, "visitor: arrives", "visitor: |", {"arrives", "leaves"}),
}
"""File, text, its replacement, and the labels that are completed at the `|` of the replacement."""

EXPLAINED = [
    ("motions/dance.yaml", "te|mpo: 132", "Beats per minute"),
    ("fuzzy/head.yaml", "resol|ution: 1000", "points"),
    ("lumen.yaml", "rel|oad: {", "How a running exhibition takes saved files"),
    (TOUR, "onD|one: watching", "Taken when"),
    ("lumen.yaml", "lang|uages: [", "The languages that the robot speaks"),
]


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the shipped project; the first line of each file names its schema."""
    root = tmp_path_factory.mktemp("editor").resolve()
    shutil.copy(ROOT / "lumen.yaml", root)
    for folder in SHIPPED_FOLDERS:
        shutil.copytree(ROOT / folder, root / folder, ignore=shutil.ignore_patterns("*.obj", "*.png"))
    return root


def server(root: Path) -> Client:
    return Client(root, [str(program("node", "npm")), str(fetched("yaml") / SERVER), "--stdio"])


@pytest.fixture(scope="module")
def editor(project: Path) -> Iterator[Client]:
    with server(project) as client:
        yield client


def place(text: str, offset: int) -> tuple[int, int]:
    """Return the line and the character of an offset, from 0."""
    return text.count("\n", 0, offset), offset - text.rfind("\n", 0, offset) - 1


@pytest.mark.parametrize("what", COMPLETED)
def test_the_editor_completes_by_our_schemas(what: str, editor: Client) -> None:
    file, old, new, expected = COMPLETED[what]
    text = (editor.root / file).read_text("utf-8")
    assert old in text
    at = text.index(old) + new.index("|")
    other = file.replace(".yaml", f".{what.replace(' ', '-')}.yaml")  # a text that it has not seen yet
    editor.open(other, text.replace(old, new.replace("|", ""), 1))
    found = editor.ask("completion", other, *place(text[: text.index(old)] + new, at))
    labels = {item["label"] for item in found["items"]}
    assert expected <= labels


@pytest.mark.parametrize(("file", "spot", "word"), EXPLAINED)
def test_the_editor_explains_a_key(file: str, spot: str, word: str, editor: Client) -> None:
    text = editor.open(file)
    before, _, after = spot.partition("|")
    answer = editor.ask("hover", file, *place(text, text.index(before + after) + len(before)))
    assert word in answer["contents"]["value"]


def test_the_editor_finds_nothing_in_the_shipped_files_and_something_in_a_broken_one(project: Path) -> None:
    with server(project) as client:
        for file in FILES:
            client.open(file)
            assert client.diagnostics(file) == [], file
        text = client.open("motions/bow.yaml", (project / GOODBYE).read_text("utf-8") + "\nnonsense: 1\n")
        assert [d["range"]["start"]["line"] for d in client.diagnostics("motions/bow.yaml")] == [text.count("\n") - 1]
