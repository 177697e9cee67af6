"""A stranger's row answers an editor's request; a faulty one is left out, and its distribution is named."""

from pathlib import Path

import pytest

from lumen.features.editor.server import server
from tests import ROOT
from tests.features.editor.client import ENGINE, Client
from tests.stranger.installing import Installed

FAULTY = """
from lumen.feature import EditorRow, Feature

FEATURE = Feature(
    name="faulty",
    editor_requests={
        "textDocument/formatting": EditorRow("faulty_odd:format"),
        "textDocument/hover": EditorRow("faulty_odd:hover"),
    },
    editor_commands={"faulty.act": "faulty_odd:act"},
)
"""


@pytest.mark.process
def test_an_editor_gets_the_answers_of_a_package(stranger: Path) -> None:
    with Client(ROOT / "examples/minimal", path=f"{stranger}:{ENGINE}") as client:
        assert client.capabilities["colorProvider"] == {"workDoneProgress": False}
        client.open("lumen.yaml", "name: red\nrobot: blue\n")
        [colour] = client.request("textDocument/documentColor", textDocument={"uri": client.uri("lumen.yaml")})
        assert colour["color"] == {"red": 1, "green": 0, "blue": 0, "alpha": 1}
        assert client.request("workspace/executeCommand", command="stranger.count", arguments=["red and red"]) == 2


def test_a_faulty_answer_is_left_out_and_its_package_named(
    installed: Installed, caplog: pytest.LogCaptureFixture
) -> None:
    without = server().protocol.fm
    installed.write("faulty", FAULTY)
    made = server().protocol.fm
    assert made.features.keys() == without.features.keys()
    assert made.commands.keys() == without.commands.keys()
    assert [record.getMessage().partition(": ")[0] for record in caplog.records] == [
        "the editor's `textDocument/formatting` is not answered",
        "the editor's `faulty.act` is not answered",
    ]
    assert all("the installed package `faulty` 1.0 is faulty" in each.getMessage() for each in caplog.records)
