"""While a file is not YAML, everything else in it and in other files is still known."""

import pytest

from lumen.errors import UsageError
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import complete
from lumen.features.editor.hover import hover
from lumen.features.editor.mending import mended
from lumen.features.editor.renaming import renamable, rename
from lumen.features.editor.symbols import Symbol, symbols
from lumen.project.files import read_files
from tests import ROOT
from tests.tables import for_each

FILES = read_files(ROOT)
TOUR, VISITOR = "behaviors/tour.yaml", "behaviors/stories/visitor.yaml"
SOUND = Analysis(ROOT, FILES)
BREAKS = {
    "a quote that is not closed": ("en: Never mind.", 'en: "Never mind.'),
    "an apostrophe that is not closed": ("en: Never mind.", "en: 'Never mind."),
    "a bracket that is not closed": ("{play: dance}", "{play: dance"),
    "a list that is not closed": ('en: ["What else can I do for you?"', 'en: ["What else can I do for you?", [oh'),
    "a colon that is missing": ("        onDone: watching\n", "        onDone watching\n"),
    "a state without its colon": ("              check_name:\n", "              check_name\n"),
    "a tab": ("        onDone: watching\n", "\tonDone: watching\n"),
    "text with a colon": ("en: Never mind.", "en: Never mind: not you."),
    "a mark that begins nothing": ("en: Never mind.", "en: @home"),
    "a line that stands too deep": ('        onError: "#helpless"\n', '            onError: "#helpless"\n'),
}


def broken(how: str, *, before: Analysis | None = SOUND) -> Analysis:
    old, new = BREAKS[how]
    text = SOUND.text(TOUR)
    assert old in text
    return Analysis(ROOT, {**FILES, TOUR: text.replace(old, new, 1).encode()}, before)


def at(analysis: Analysis, file: str, piece: str) -> tuple[str, int, int]:
    whole = analysis.text(file)
    offset = whole.index(piece.replace("|", "", 1)) + piece.index("|")
    return file, whole.count("\n", 0, offset) + 1, offset - whole.rfind("\n", 0, offset)


def count(found: tuple[Symbol, ...]) -> int:
    return sum(1 + count(symbol.children) for symbol in found)


@for_each("how", BREAKS)
def test_the_rest_of_the_file_is_known(how: str) -> None:
    """The editor still has nearly all symbols, hover above and below the fault, and completion."""
    analysis = broken(how, before=None)
    assert count(symbols(analysis, TOUR)) > 0.9 * count(symbols(SOUND, TOUR))
    assert "atomic state" in hover(analysis, *at(analysis, TOUR, "      idle|:  "))
    assert "atomic state" in hover(analysis, *at(analysis, TOUR, "      robot_l|ost: {id"))
    assert "atomic state" in hover(analysis, *at(analysis, VISITOR, "{state: gr|eet"))
    names = {item.text for item in complete(analysis, *at(analysis, TOUR, "battery.low: {target: |battery_low"))}
    assert {"fallen", "watching"} <= names
    assert "goodbye" in {item.text for item in complete(analysis, *at(analysis, VISITOR, "expect: {state: |greet"))}


def test_half_of_a_character_does_not_hide_the_rest() -> None:
    """JSON can contain half of a surrogate pair, which UTF-8 can't."""
    found = mended(TOUR, "a: \ud800\nb: [\nc: 2\n")
    assert found is not None
    assert found.text == "\n\nc: 2\n"


@for_each("how", BREAKS)
def test_it_is_one_finding_and_hides_no_other(how: str) -> None:
    """The fault itself is one finding, without any that follow from it; those of other files are reported, too."""
    analysis = broken(how)
    assert [d.place.file for d in analysis.diagnostics] == [TOUR], [str(d) for d in analysis.diagnostics]
    text = analysis.text(TOUR).replace("{assign: {battery: event", "{assign: {batery: event", 1)
    story = analysis.text(VISITOR).replace("played: dance", "played: dnce", 1)
    worse = Analysis(ROOT, {**FILES, TOUR: text.encode(), VISITOR: story.encode()}, SOUND)
    said = [(d.place.file, d.code) for d in worse.diagnostics]
    assert (TOUR, "unknown-context-key") in said
    assert (VISITOR, "unknown-motion") in said


def test_what_was_read_last_stands_for_what_cannot_be_read_at_all() -> None:
    assert not [found for found in SOUND.diagnostics if found.place.file == TOUR]  # it was read
    nothing = Analysis(ROOT, {**FILES, TOUR: b"\xff\xfe{{{"}, SOUND)
    assert "atomic state" in hover(nothing, *at(nothing, VISITOR, "{state: gr|eet"))
    assert {d.place.file for d in nothing.diagnostics} == {TOUR}
    again = nothing.changed(TOUR, "\x00")
    assert "atomic state" in hover(again, *at(again, VISITOR, "{state: gr|eet"))


def test_nothing_is_renamed_where_uses_cannot_be_seen() -> None:
    analysis = broken("a quote that is not closed")
    word = renamable(analysis, *at(analysis, TOUR, "play: dan|ce"))
    assert word is not None
    with pytest.raises(UsageError, match="can't rename while a file can't be read"):
        rename(analysis, word, "horse")
