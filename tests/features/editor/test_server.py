"""The language server as an editor meets it: `lumen lsp` over standard input and output."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests import ROOT
from tests.copying import copied_project
from tests.features.editor.client import Client
from tests.tables import for_each

pytestmark = pytest.mark.ordered  # one server for all: what it publishes waits for the test that asks

TOUR = "behaviors/tour.yaml"


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return copied_project(ROOT, tmp_path_factory.mktemp("editor") / "hall and stand")


@pytest.fixture(scope="module")
def client(project: Path) -> Iterator[Client]:
    with Client(project) as client:
        yield client


def at(text: str, piece: str) -> tuple[int, int]:
    """Return the line and the character, from 0 and in UTF-16, of the `|` in a piece of a text."""
    offset = text.index(piece.replace("|", "")) + piece.index("|")
    line = text.count("\n", 0, offset)
    return line, units(text[text.rfind("\n", 0, offset) + 1 : offset])


def units(text: str) -> int:
    return len(text.encode("utf-16-le")) // 2


def shown(text: str, span: dict[str, Any]) -> str:
    """Return the text in a range within one line; its columns count UTF-16 code units."""
    line = text.split("\n")[span["start"]["line"]].encode("utf-16-le")
    return line[2 * span["start"]["character"] : 2 * span["end"]["character"]].decode("utf-16-le")


def test_what_it_can_do(client: Client) -> None:
    able = client.capabilities
    assert able["positionEncoding"] == "utf-16"
    for service in (
        "hover", "definition", "references", "documentSymbol", "completion", "rename", "codeAction", "codeLens",
        "inlayHint", "signatureHelp", "foldingRange", "documentLink", "documentHighlight", "workspaceSymbol",
    ):  # fmt: skip
        assert able[f"{service}Provider"], service


@pytest.mark.once
def test_findings_of_what_is_not_saved(client: Client) -> None:
    """A mistake in an open file is reported in every file it concerns, until it is mended."""
    text = client.open(TOUR)
    assert client.diagnostics(TOUR) == []
    wrong = text.replace("onDone: watching", "onDone: wathing", 1)
    client.change(TOUR, wrong, 3)
    found = client.diagnostics(TOUR)
    assert [(d["code"], d["source"], d["severity"], shown(wrong, d["range"])) for d in found] == [
        ("unknown-state", "lumen", 1, "wathing")
    ]
    assert "did you mean `watching`?" in found[0]["message"]
    client.change(TOUR, text, 4)
    assert client.diagnostics(TOUR) == []


def test_positions_are_counted_in_utf_16(client: Client) -> None:
    """An emoji is one character of ours and two of the client's."""
    text = client.open(TOUR).replace("onDone: watching", 'onDone: {target: wathing, description: "🤖"}', 1)
    text = text.replace(
        "{posture: Stand}", '{say: {en: "🤖🤖 hi", id: "🤖 {{ context.visitr }} {{ context.visitor }}"}}', 1
    )
    client.change(TOUR, text, 5)
    found = client.diagnostics(TOUR)
    while len(found) < 2:
        found = client.diagnostics(TOUR)
    assert {shown(text, d["range"]) for d in found} == {"visitr", "wathing"}
    here = client.ask("definition", TOUR, *at(text, "visitr }} {{ context.vis|itor"))
    assert [shown(text, place["range"]) for place in here] == ["visitor"]
    proposed = client.ask("completion", TOUR, *at(text, "visitr }} {{ context.vis|itor"))
    edit = next(item for item in proposed if item["label"] == "visitor")["textEdit"]
    assert shown(text, edit["range"]) == "vis"
    client.change(TOUR, (client.root / TOUR).read_text("utf-8"), 6)


def test_hover_definition_symbols_and_references(client: Client) -> None:
    text = client.open(TOUR)
    assert "atomic state at `guide.talking.waiting.how_are_you`" in str(
        client.ask("hover", TOUR, *at(text, "target: how|_are"))
    )
    place = client.ask("definition", TOUR, *at(text, "play: dan|ce"))[0]
    assert place["uri"] == client.uri("motions/dance.yaml")
    assert len(client.ask("references", TOUR, *at(text, "play: dan|ce"), context={"includeDeclaration": True})) == 4
    symbols = client.request("textDocument/documentSymbol", textDocument={"uri": client.uri(TOUR)})
    assert {"visitor", "guide", "safety"} <= {symbol["name"] for symbol in symbols}


def test_rename_of_a_motion_moves_its_file(client: Client) -> None:
    text = client.open(TOUR)
    line, character = at(text, "play: dan|ce")
    assert client.ask("prepareRename", TOUR, line, character)["placeholder"] == "dance"
    changes = client.ask("rename", TOUR, line, character, newName="horse")["documentChanges"]
    edited = [change["textDocument"]["uri"] for change in changes if "edits" in change]
    assert client.uri(TOUR) in edited
    assert client.uri("behaviors/stories/visitor.yaml") in edited
    assert changes[-1] == {
        "kind": "rename",
        "oldUri": client.uri("motions/dance.yaml"),
        "newUri": client.uri("motions/horse.yaml"),
    }
    refused = client.ask("rename", TOUR, line, character, newName="sing")
    assert "there is already a motion `sing`" in refused["message"]
    assert client.ask("prepareRename", TOUR, *at(text, "# What the ro|bot remembers")) is None


def test_a_refused_rename_leaves_no_traceback(project: Path) -> None:
    with Client(project) as client:
        text = client.open(TOUR)
        refused = client.ask("rename", TOUR, *at(text, "play: dan|ce"), newName="sing")
        assert "there is already a motion `sing`" in refused["message"]
    assert client.process.stderr
    assert client.process.stderr.read() == b""


def test_lenses_hints_signatures_folds_links_highlights_and_symbols(client: Client) -> None:
    text = client.open(TOUR)
    document = {"uri": client.uri(TOUR)}
    lenses = client.request("textDocument/codeLens", textDocument=document)
    dance = next(e for e in lenses if e["range"]["start"]["line"] == at(text, "dan|ce:                  # 10.")[0])
    assert dance["command"]["title"] == "2 transitions lead here"
    uri, start, places = dance["command"]["arguments"]
    assert (uri, start["line"], len(places)) == (client.uri(TOUR), dance["range"]["start"]["line"], 2)
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 900, "character": 0}}
    hints = client.request("textDocument/inlayHint", textDocument=document, range=whole)
    assert {"24 s after its `do`", "after entering"} <= {hint["label"] for hint in hints}
    asking = text.replace("guard: context.name_tries < 2", "guard: heard(event.data.result, 'english')", 1)
    client.change(TOUR, asking, 7)
    help = client.ask("signatureHelp", TOUR, *at(asking, "heard(event.data.result, 'engl|ish')"))
    client.change(TOUR, text, 8)
    assert (help["signatures"][0]["label"][:6], help["activeParameter"]) == ("heard(", 1)
    assert client.request("textDocument/foldingRange", textDocument=document)
    links = client.request("textDocument/documentLink", textDocument=document)
    assert client.uri("motions/dance.yaml") in {link["target"] for link in links}
    marks = client.ask("documentHighlight", TOUR, *at(text, "context.name_|tries <"))
    assert {shown(text, mark["range"]) for mark in marks} == {"name_tries"}
    assert {mark["kind"] for mark in marks} == {2, 3}
    found = client.request("workspace/symbol", query="danc")
    assert client.uri("motions/dance.yaml") in {symbol["location"]["uri"] for symbol in found}


def test_a_story_is_run_by_its_lens(client: Client) -> None:
    """A client without a command of that name sends it to the server, which reports how the story ended."""
    story = "behaviors/stories/unknown_visitor.yaml"
    client.open(story)
    (lens,) = client.request("textDocument/codeLens", textDocument={"uri": client.uri(story)})
    assert lens["command"]["title"] == "run this story"
    command = {key: lens["command"][key] for key in ("command", "arguments")}
    assert client.request("workspace/executeCommand", **command) is True
    assert "unknown_visitor" in client.message()
    command["arguments"][1] = "nobody"
    assert client.request("workspace/executeCommand", **command) is False
    assert "nobody" in client.message()


def test_a_fix_is_offered(client: Client) -> None:
    text = client.open(TOUR)
    wrong = text.replace("onDone: watching", "onDone: wathing", 1)
    client.change(TOUR, wrong, 9)
    line, character = at(wrong, "onDone: wat|hing")
    here = {"line": line, "character": character}
    actions = client.request(
        "textDocument/codeAction",
        textDocument={"uri": client.uri(TOUR)},
        range={"start": here, "end": here},
        context={"diagnostics": []},
    )
    assert [action["title"] for action in actions] == ["write watching"]
    edit = actions[0]["edit"]["documentChanges"][0]["edits"][0]
    assert (shown(wrong, edit["range"]), edit["newText"]) == ("wathing", "watching")
    client.change(TOUR, text, 10)


@for_each("text", ["", "{{{", "a: b: c", "\t- x", "- 1\n- 2\n", "states: 5\n", "&a [*a]", "\x00", "🤖: {🤖"])
def test_wrong_files_are_answered(client: Client, text: str) -> None:
    file = f"behaviors/wrong-{text.encode().hex()}.yaml"  # its own: after a file is closed, its findings are empty
    client.open(file, text)
    for line, character in ((0, 0), (0, 3), (7, 7)):
        for method in ("completion", "hover", "definition", "references", "prepareRename"):
            more = {"context": {"includeDeclaration": True}} if method == "references" else {}
            answer = client.ask(method, file, line, character, **more)
            assert not (isinstance(answer, dict) and "code" in answer), (method, answer)
    assert client.diagnostics(file)
    client.notify("textDocument/didClose", textDocument={"uri": client.uri(file)})


def test_a_file_of_no_project(client: Client, tmp_path: Path) -> None:
    stranger = tmp_path / "notes.yaml"
    document = {"uri": stranger.as_uri(), "languageId": "yaml", "version": 1, "text": "a: 1"}
    client.notify("textDocument/didOpen", textDocument=document)
    for uri in (stranger.as_uri(), "untitled:Untitled-1"):
        params = {"textDocument": {"uri": uri}, "position": {"line": 0, "character": 0}}
        assert client.request("textDocument/hover", **params) is None
        assert client.request("textDocument/completion", **params) == []


@pytest.mark.slow
def test_utf_8_where_the_client_prefers_it(project: Path) -> None:
    with Client(project, encoding="utf-8") as client:
        assert client.capabilities["positionEncoding"] == "utf-8"
        text = client.open(
            "motions/goodbye.yaml", 'description: "é🤖"\nunits: {angle: deg}\nstart: Stnd # é\nkeyframes: [{at: 1s}]\n'
        )
        assert text
        found = [d for d in client.diagnostics("motions/goodbye.yaml") if d["code"] == "unknown-posture"]
        assert found[0]["range"]["start"] == {"line": 2, "character": 7}
