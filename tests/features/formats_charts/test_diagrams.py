"""Diagrams of behaviours: what they show, and that nothing in them overlaps."""

from collections.abc import Iterator
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

import lumen
from lumen.cli.main import main
from lumen.language.actions import Expression
from lumen.language.machines import MachineDefinition
from lumen.run.diagrams import dot_text, neighbourhood, overview, region, svg
from lumen.run.diagrams.diagram import Diagram
from lumen.run.diagrams.layering import GAP, Extent, layered
from lumen.run.diagrams.placing import ROW, PlacedBox, place, text_width
from lumen.run.diagrams.transition_rows import guard_phrase
from lumen.statechart import Machine
from tests import ROOT
from tests.tables import for_each

TOUR = lumen.load(ROOT).machine


@pytest.fixture(scope="module")
def museum() -> MachineDefinition:
    return lumen.load(ROOT / "examples/museum").machine


def pictures(machine: MachineDefinition) -> Iterator[Diagram]:
    yield overview(machine)
    for state in machine.states.values():
        if state.path:
            yield neighbourhood(machine, state.path)
            if state.children:
                yield region(machine, state.path)


def nested(boxes: tuple[PlacedBox, ...]) -> Iterator[tuple[PlacedBox, ...]]:
    """Yield the boxes that are side by side, for each frame."""
    yield boxes
    for box in boxes:
        yield from nested(box.within)


def overlap(one: PlacedBox, other: PlacedBox) -> bool:
    return all(a.corner[i] < b.corner[i] + b.size[i] for i in (0, 1) for a, b in ((one, other), (other, one)))


def test_nothing_lies_on_anything_and_every_text_fits(museum: MachineDefinition) -> None:
    for diagram in (*pictures(TOUR), *pictures(museum)):
        placement = place(diagram)
        for boxes in nested(placement.boxes):
            assert not any(overlap(one, other) for one, other in combinations(boxes, 2)), diagram.title
            for box in boxes:
                assert all(text_width(row, ROW) < box.size.width for row in box.box.rows)
                for inner in box.within:
                    assert box.corner.x < inner.corner.x
                    assert inner.corner.x + inner.size.width < box.corner.x + box.size.width
                    assert inner.corner.y + inner.size.height < box.corner.y + box.size.height


def test_a_picture_is_read_at_1400_px_and_the_same_each_time(museum: MachineDefinition) -> None:
    for diagram in (overview(TOUR), region(TOUR, "guide"), region(TOUR, "safety"), overview(museum)):
        text = svg(diagram)
        assert text == svg(diagram)
        root = ElementTree.fromstring(text)
        width, drawn = float(root.attrib["width"]), float(root.attrib["viewBox"].split()[2])
        assert width <= 1400
        assert width / drawn > 0.8, "letters of 12 px stay readable"


def test_the_whole_has_every_state_that_somebody_wrote() -> None:
    texts = {element.text for element in ElementTree.fromstring(svg(overview(TOUR))).iter() if element.text}
    assert {
        state.path.rpartition(".")[2] for state in TOUR.states.values() if state.path and state.name != "visit"
    } <= texts


def test_a_state_is_shown_with_those_around_it() -> None:
    shown = neighbourhood(TOUR, "offer")
    boxes = {box.title: box for box in shown.boxes}
    assert boxes["offer"].marked
    assert "hears dance → dance" in boxes["offer"].rows
    assert "safety.alarm → interrupted" in boxes["offer"].rows
    assert boxes["reaction"].rows == ("done.do.*, error.do.* → offer",)
    assert boxes["dance"].rows == ("done → offer",)
    assert (boxes["offer"].id, boxes["goodbye"].id) in shown.arrows
    assert "greet" not in boxes


def test_the_ends_of_a_do_that_lead_to_one_state_are_one_row() -> None:
    boxes = {box.title: box for box in neighbourhood(TOUR, "watching").boxes}
    assert boxes["brain_lost"].rows == ("done, failed, after 30 s → watching",)


def test_of_a_for_only_what_somebody_wrote_is_shown(museum: MachineDefinition) -> None:
    [quiz] = region(museum, "quiz").boxes
    assert [box.title for box in quiz.within] == ["ask", "right", "wrong", "next"]
    assert quiz.rows == ("for each question", "done → praise")
    assert quiz.within[0].first
    assert quiz.within[0].rows[0] == "hears question.right → right"


@for_each(
    ("guard", "phrase"),
    [
        ("heard(event.data.result, 'dance')", "“dance”"),
        ("heard(event.data.result, 'dance') || heard(event.data.result, 'sing')", "“dance” or “sing”"),
        ("heard(event.data.result, context.names)", "“…” in context.names"),
        ("lookup(event.data.result, 'faq') != null", "“…” in faq"),
        ("after(event.data.result, 'i am') != ''", "“i am …”"),
        ("context.tries <  2", "context.tries < 2"),
    ],
)
def test_a_guard_is_what_has_to_be_said(guard: str, phrase: str) -> None:
    assert guard_phrase(Expression(guard)) == phrase


@given(
    st.lists(st.tuples(st.floats(10, 400), st.floats(10, 90)), min_size=1, max_size=9),
    st.lists(st.tuples(st.integers(0, 8), st.integers(0, 8)), max_size=20, unique=True),
)
def test_any_graph_is_laid_out_in_layers(sizes: list[tuple[float, float]], pairs: list[tuple[int, int]]) -> None:
    nodes = {f"n{i}": Extent(*size) for i, size in enumerate(sizes)}
    edges = [(f"n{a}", f"n{b}") for a, b in pairs if a != b and max(a, b) < len(nodes)]
    found = layered(nodes, edges, 900)
    assert found == layered(nodes, edges, 900)
    assert found.corners.keys() == nodes.keys()
    for one, other in combinations(nodes, 2):
        (x, y), (u, v) = found.corners[one], found.corners[other]
        beside = x + nodes[one].width + GAP <= u + 0.01 or u + nodes[other].width + GAP <= x + 0.01
        assert beside or y + nodes[one].height < v or v + nodes[other].height < y
    for (one, other), way in found.ways.items():
        heights = [found.corners[one].y, *(point.y for point in way), found.corners[other].y + nodes[str(other)].height]
        down = found.corners[one].y < found.corners[other].y
        assert not down or heights == sorted(heights)


def test_graphviz_gets_the_same_boxes_and_arrows() -> None:
    diagram = region(TOUR, "touch")
    text = dot_text(diagram)
    assert text.count("{") == text.count("}")
    assert 'label="● free\\ltouched if event.data.sensor in ' in text
    assert text.count(" -> ") == len(diagram.arrows)
    assert "subgraph cluster_s0 {" in text


@pytest.mark.process
def test_a_program_called_dot_draws_where_there_is_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "dot"
    program.write_text('#!/bin/sh\necho "$1"\ncat\n', "utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    file = tmp_path / "touch.png"
    assert main(["graph", "--region", "touch", "-o", str(file)]) == 0
    assert file.read_text("utf-8").startswith("-Tpng\ndigraph {")
    program.write_text("#!/bin/sh\necho 'syntax error' >&2\nexit 1\n", "utf-8")
    assert main(["graph", "-o", str(file)]) == 2
    assert "failed: syntax error; use --layout own" in capsys.readouterr().err
    assert main(["graph", "-o", str(tmp_path / "tour.svg"), "--layout", "own"]) == 0
    assert (tmp_path / "tour.svg").read_text("utf-8") == svg(overview(TOUR))


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--state", "ofer", "-o", "x.svg"], "`tour` has no state `ofer`: did you mean `offer`?"),
        (["--region", "offer", "-o", "x.svg"], "no state `offer`"),
        (["--state", "offer"], "Mermaid shows the whole"),
        (["-o", "x.png"], "a PNG needs Graphviz"),
        (["-o", "x.svg", "--layout", "dot"], "`dot` is not installed"),
    ],
)
def test_what_can_t_be_drawn_is_one_line(
    words: list[str], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["graph", "--project", str(ROOT), *words]) == 2
    said = capsys.readouterr().err
    assert says in said
    assert said.count("\n") == 1


def test_a_long_row_of_states_is_drawn_in_whatever_order_it_is_written() -> None:
    count = 1_500
    states = {f"s{i}": {"on": {"go": f"s{(i + 1) % count}"}} for i in reversed(range(count))}
    machine = Machine.from_dict({"initial": "s0", "states": states, "events": {"go": None}}, "row")
    boxes = place(overview(machine)).boxes
    assert len(boxes) == count
    assert len({box.corner for box in boxes}) == count
