"""Additions to the lines of a file: lenses, hints, signatures, folds, links, and the search for symbols by name."""

from lumen.features.editor.analysis import Analysis
from lumen.features.editor.folding import folds
from lumen.features.editor.hints import hints
from lumen.features.editor.lenses import ACTIVE_NOW, PLAY_MOTION, RUN_STORY, active_places, lenses
from lumen.features.editor.links import links
from lumen.features.editor.signatures import signature
from lumen.features.editor.symbols import search
from lumen.project.files import read_files
from tests import ROOT
from tests.tables import for_each

SHIPPED = Analysis(ROOT, read_files(ROOT))
TOUR, VISITOR = "behaviors/tour.yaml", "behaviors/stories/visitor.yaml"


def line_of(file: str, text: str) -> int:
    """Return the number of the first line that begins with this text, blanks included."""
    return next(i for i, row in enumerate(SHIPPED.text(file).split("\n"), 1) if row.startswith(text))


def test_lenses_of_stories_and_motions() -> None:
    (story,) = lenses(SHIPPED, VISITOR)
    (motion,) = lenses(SHIPPED, "motions/dance.yaml")
    assert (story.title, story.command, story.name, story.place.line) == ("run this story", RUN_STORY, "visitor", 1)
    assert (motion.title, motion.command, motion.name) == ("play this motion", PLAY_MOTION, "dance")
    assert list(lenses(SHIPPED, "models/passages/sit-straddle.yaml")) == []


def test_lenses_of_states_count_the_transitions_that_lead_there() -> None:
    """`dance` is the target of two transitions in the file; `greet` of none, for it is initial."""
    found = {(each.name, each.place.line): each for each in lenses(SHIPPED, TOUR)}
    dance = found["dance", line_of(TOUR, "              dance:")]
    assert dance.title == "2 transitions lead here"
    text = SHIPPED.text(TOUR).split("\n")
    assert ['"#dance"' in text[place.line - 1] for place in dance.places] == [True, True]
    assert found["robot_lost", line_of(TOUR, "      robot_lost:")].title == "1 transition leads here"
    assert not any(name == "greet" for name, _ in found)


def test_active_states_are_marked() -> None:
    marked = [each for each in lenses(SHIPPED, TOUR, ("talking", "fine", "watching")) if each.title == ACTIVE_NOW]
    assert [each.place.line for each in marked] == [
        line_of(TOUR, "      talking:"),
        line_of(TOUR, "              fine:"),
        line_of(TOUR, "      watching:"),
    ]
    assert [place.line for place in active_places(SHIPPED, ("fine",))] == [line_of(TOUR, "              fine:")]
    assert active_places(SHIPPED, ()) == []


def test_hints_say_what_an_after_and_a_beat_mean() -> None:
    found = {each.place.line: each for each in hints(SHIPPED, TOUR)}
    greet = line_of(TOUR, "          greet:")
    here = next(line for line in sorted(found) if line > greet)
    assert SHIPPED.text(TOUR).split("\n")[here - 1].strip() == "after: {30s: goodbye}"
    assert found[here].text == "24 s after its `do`"
    assert "takes about 6.0 s" in found[here].more
    touched = found[line_of(TOUR, "      touched: {on: {released: free}, after: {2s: ")]
    assert touched.text == "after entering"
    dance = list(hints(SHIPPED, "motions/dance.yaml"))
    text = SHIPPED.text("motions/dance.yaml").split("\n")
    for each in dance:
        beat = float(text[each.place.line - 1][each.place.column - 1 : each.place.end_column - 1])
        assert each.text == f"{beat * 60 / 132:.2f} s"
    assert len(dance) > 10


@for_each(
    ("written", "label", "active"),
    [
        ("guard: \"heard(event.data.result, '|", "heard(", 1),
        ('guard: "heard(|', "heard(", 0),
        ('guard: "size(words(event.data.result)) > 0 && has(|', "has(", 0),
        ("guard: \"contains(lower('a, b('), |", "contains(", 1),
        ('guard: "(|', None, 0),
        ('guard: "size(words(x)) |', None, 0),
    ],
)
def test_signatures(written: str, label: str | None, active: int) -> None:
    text = SHIPPED.text(TOUR).replace("guard: context.name_tries < 2", written.replace("|", ""), 1)
    line = next(i for i, row in enumerate(text.split("\n"), 1) if row.endswith(written.replace("|", "")))
    found = signature(SHIPPED.changed(TOUR, text), TOUR, line, len(text.split("\n")[line - 1]) + 1)
    assert (found and found.label[: len(label or "")]) == label
    assert (found.active if found else 0) == active
    if found:
        assert found.parameters
        assert "Returns" in found.documentation


def test_folds_end_where_a_part_ends() -> None:
    found = {fold.first: fold for fold in folds(SHIPPED.documents[TOUR])}
    lines = SHIPPED.text(TOUR).split("\n")
    greet = found[line_of(TOUR, "          greet:")]
    assert lines[greet.last - 1].strip() == "after: {30s: goodbye}"
    assert found[1].comment
    assert lines[found[1].last].strip() == "id: tour"
    assert all(fold.last > fold.first for fold in found.values())


def test_links_lead_to_files() -> None:
    text = SHIPPED.text(TOUR).split("\n")
    found = {
        (text[e.place.line - 1][e.place.column - 1 : e.place.end_column - 1], e.target) for e in links(SHIPPED, TOUR)
    }
    assert {("dance", "motions/dance.yaml"), ("faq", "behaviors/words/faq.yaml")} <= found
    assert "behaviors/tour.yaml" in {link.target for link in links(SHIPPED, "lumen.yaml")}


def test_search_finds_by_letters_in_their_order() -> None:
    found = {(use.kind.value, use.name) for use in search(SHIPPED, "Danc")}
    assert {("motion", "dance"), ("state", "guide.talking.performing.dance"), ("phrase", "dance")} <= found
    assert not list(search(SHIPPED, "zzzz"))
