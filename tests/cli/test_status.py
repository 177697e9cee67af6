"""`lumen status` and `lumen goto`, to an exhibition that runs and to none."""

import io
import json
from datetime import UTC, datetime
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.cli.person import person
from lumen.run.exhibition import Exhibition
from tests.cli.conftest import Terminal
from tests.waiting import until

KEYS = {
    "robot", "configuration", "since", "language", "visitor", "battery", "ears", "timers", "stopped", "stopped_by",
    "realtime", "bundle", "last_reload",
}  # fmt: skip


@pytest.mark.slow
def test_the_object_says_how_the_exhibition_is(copy: Path) -> None:
    with lumen.open(copy) as exhibition:
        exhibition.send("face", {"x": 160, "y": 120})
        exhibition.run(0.5)
        status = exhibition.status()
        assert set(status) == KEYS
        assert (status["robot"], status["language"], status["visitor"]) == ("NAO", "en", None)
        assert {"talking", "greet"} <= set(status["configuration"])
        [timer] = status["timers"]
        assert timer["event"] == "after 30 s in greet"
        due, since = (datetime.fromisoformat(text) for text in (timer["due"], status["since"]))
        assert (due - since).total_seconds() == pytest.approx(30.0)
        assert due.tzinfo == UTC
        assert (status["bundle"], status["realtime"]) == (exhibition.project.hash, 1.0)
        assert (status["stopped"], status["stopped_by"], status["last_reload"]) == (False, None, None)
        assert status["ears"] is None
        exhibition.send("recognised", {"name": "Budi"})
        exhibition.send("listening", {"listening": False, "because": "nobody"})
        exhibition.run(0.1)
        assert exhibition.status()["ears"] == {"listening": False, "because": "nobody"}
        exhibition.stop()
        exhibition.run(0.5)
        later = exhibition.status()
        assert (later["visitor"], later["stopped"], later["stopped_by"]) == ("Budi", True, "the program")
        assert later["since"] > status["since"]


@pytest.mark.network
@pytest.mark.slow
def test_it_is_printed_for_people_and_programs(
    exhibition: Exhibition, copy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["stop", str(copy)]) == 0
    until(lambda: "stopped" in exhibition.configuration)
    capsys.readouterr()
    assert main(["status", str(copy), "--format", "json"]) == 0
    assert set(json.loads(capsys.readouterr().out)) == KEYS
    assert main(["status", str(copy)]) == 0
    text = capsys.readouterr().out
    assert f"stopped   by {person()}: to let it move again, hold its head, or run `lumen resume`" in text
    assert "visitor   no name known, spoken to in en" in text
    assert main(["goto", "offer", str(copy), "--yes"]) == 0
    said = capsys.readouterr().out
    assert said.endswith(f"{person()} stopped the robot: to let it move again, hold its head, or run `lumen resume`\n")


@pytest.mark.network
@pytest.mark.slow
def test_it_goes_where_a_person_wants_it(
    exhibition: Exhibition, copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    entered: list[str] = []
    exhibition.observe(lambda step: entered.extend(step.entered))
    assert main(["goto", "ofer", str(copy)]) == 1
    assert "lumen goto: there is no state `ofer`: did you mean `offer`?" in capsys.readouterr().err
    monkeypatch.setattr("sys.stdin", io.StringIO())
    assert main(["goto", "offer", str(copy)]) == 2
    said = capsys.readouterr()
    assert "enters talking, waiting, guide.talking.waiting.wishes, offer, face.watched" in said.out
    assert "add --yes" in said.err
    monkeypatch.setattr("sys.stdin", Terminal("no\n"))
    assert main(["goto", "offer", str(copy)]) == 1
    assert "offer" not in entered
    monkeypatch.setattr("sys.stdin", Terminal("y\n"))
    assert main(["goto", "offer", str(copy)]) == 0
    assert entered[:4] == ["talking", "waiting", "guide.talking.waiting.wishes", "offer"]


@pytest.mark.parametrize("verb", [["status"], ["goto", "idle"]])
def test_where_none_runs_that_is_one_line(copy: Path, capsys: pytest.CaptureFixture[str], verb: list[str]) -> None:
    assert main([*verb, str(copy)]) == 2
    said = capsys.readouterr()
    assert (said.out, said.err.count("\n")) == ("", 1)
    assert "start it with `lumen run`" in said.err
