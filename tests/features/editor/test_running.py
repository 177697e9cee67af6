"""The active states of a running exhibition, as the editor shows them."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.run.exhibition import Exhibition
from tests.cli.conftest import bus, copy, exhibition, project
from tests.features.editor.client import Client

__all__ = ["bus", "copy", "exhibition", "project"]
TOUR = "behaviors/tour.yaml"


@pytest.mark.slow
def test_the_active_states_are_told_and_marked(exhibition: Exhibition, copy: Path) -> None:
    with Client(copy) as client:
        text = client.open(TOUR).split("\n")
        told = client.notified("lumen/active")
        assert told["root"] == copy.as_uri()
        while not told["states"]:  # an exhibition that answers late counts as one that does not run
            told = client.notified("lumen/active")
        assert {"idle", "watching"} <= set(told["states"])
        assert main(["goto", "robot_lost", str(copy), "--yes"]) == 0
        while "robot_lost" not in told["states"]:
            told = client.notified("lumen/active")
        marked = {text[place["range"]["start"]["line"]].split()[0] for place in told["places"]}
        assert {"paused:", "robot_lost:"} <= marked
        assert {place["uri"] for place in told["places"]} == {client.uri(TOUR)}
        lenses = client.request("textDocument/codeLens", textDocument={"uri": client.uri(TOUR)})
        active = [e["range"]["start"]["line"] for e in lenses if e["command"]["title"] == "● active now"]
        assert "robot_lost:" in {text[line].split()[0] for line in active}
