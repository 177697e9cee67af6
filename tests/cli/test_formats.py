"""`lumen import` and `lumen export`."""

import os
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.statechart import Machine

CHART = """<scxml xmlns="http://www.w3.org/2005/07/scxml" initial="a">
  <state id="a"><transition event="go" target="b"/></state>
  <state id="b">{}</state>
</scxml>
"""


@pytest.mark.slow
@pytest.mark.parametrize("format", ["scxml", "xstate"])
def test_the_tour_goes_out_and_comes_back(format: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, back = tmp_path / "tour", tmp_path / "back.yaml"
    assert main(["export", format, "-o", str(file)]) == 0
    assert "behaviors/tour.yaml:" in capsys.readouterr().err
    assert main(["import", str(file), "-o", str(back)]) == 0
    assert capsys.readouterr().err == ""
    assert back.read_text("utf-8").startswith("# yaml-language-server: $schema=")
    tour = lumen.load().behaviors["tour"]
    assert {s.name for s in Machine.load(back).states.values()} == {s.name for s in tour.states.values()}


@pytest.mark.parametrize(("format", "first"), [("mermaid", "stateDiagram-v2"), ("dot", "digraph {")])
def test_diagrams(format: str, first: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", format, "tour"]) == 0
    assert capsys.readouterr().out.splitlines()[0] == first


def test_what_is_left_out_is_listed_with_its_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "chart.scxml"
    file.write_text(CHART.format('<invoke type="x-other" src="x"/>'), "utf-8")
    assert main(["import", str(file)]) == 1
    printed = capsys.readouterr()
    assert f"{file}:3:17 error[not-carried-over] `<invoke>`" in printed.err
    assert "id: chart" in printed.out
    assert main(["import", str(file), "--format", "json"]) == 1
    assert '"code": "not-carried-over"' in capsys.readouterr().err
    assert "For more: `lumen explain not-carried-over`" in printed.err
    assert main(["explain", "not-carried-over"]) == 0
    assert "left out" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "arguments", "words"),
    [
        ("<a", ["import", "FILE"], "this is not XML"),
        ("hello", ["import", "FILE"], "is not SCXML, XState's JSON, a motion"),
        (None, ["import", "FILE"], "can't read"),
        (CHART.format(""), ["import", "FILE", "-o", "/no/such/folder/x.yaml"], "can't write"),
        (None, ["export", "scxml", "tuor"], "did you mean `tour`?"),
    ],
)
def test_mistakes_are_one_line(
    content: str | None, arguments: list[str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "chart"
    if content is not None:
        file.write_text(content, "utf-8")
    assert main([str(file) if a == "FILE" else a for a in arguments]) == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1


@pytest.mark.parametrize("verb", ["import", "play"])
def test_a_pipe_or_a_device_is_no_file(verb: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pipe, device = tmp_path / "wave.motion", tmp_path / "zero.motion"
    os.mkfifo(pipe)
    device.symlink_to("/dev/zero")
    for file in (pipe, device):
        assert main([verb, str(file)]) == 2
        assert capsys.readouterr().err == f"lumen {verb}: can't read {file}: it is a device or a pipe, not a file\n"
