"""Files saved while a show runs: a good one is active with the next sentence, a broken one changes nothing."""

import shutil
from pathlib import Path

import pytest

from lumen.language.stories import Visitor
from tests.live.shows import Live


@pytest.mark.slow
def test_a_saved_text_is_the_next_sentence(live: Live) -> None:
    live.edit('en: "I am sorry, I did not understand that."', 'en: "Come again, please?"')
    live.until_told("are active")
    walker = live.show.visitor
    assert walker
    walker.arrive(Visitor())
    live.until_told("ask_name")
    walker.speak("my name is Ada")
    live.until_told("how_are_you")
    walker.speak("purple")
    live.until_told("“Come again, please?”")


@pytest.mark.once
@pytest.mark.slow
def test_the_visitors_name_survives(live: Live) -> None:
    walker = live.show.visitor
    assert walker
    walker.arrive(Visitor())
    live.until_told("ask_name")
    walker.speak("my name is Ada")
    live.until(lambda: "how_are_you" in live.states)
    live.edit(
        *("en: [I am glad to hear that.,", 'en: ["Wonderful, {{ context.visitor }}!",', "behaviors/tour.yaml"),
        *('"That is good to hear, {{ context.title_en }}."]', '"Wonderful, {{ context.visitor }}!"]'),
    )
    live.until_told("are active")
    assert "how_are_you" in live.states
    walker.speak("fine")
    live.until_told("“Wonderful, Ada!”")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('done.do.*: "#any_question"', 'done.do.*: "#any_questoin"', "did you mean `#any_question`?"),
        ("id: tour", "id: tour\n\tx: 1", "[tab]"),
        ("{play: sing}", "{play: sign}", "did you mean `sing`?"),
    ],
)
def test_a_broken_file_is_reported_with_its_place_and_changes_nothing(
    live: Live, old: str, new: str, told: str
) -> None:
    before = live.show.loop.project
    live.edit(old, new)
    live.until_told("refused: the exhibition continues unchanged")
    assert told in live.transcript
    assert "behaviors/tour.yaml:" in live.transcript
    assert live.show.loop.project is before
    live.edit(new, old, "behaviors/tour.yaml", "en: Never mind.", "en: No problem.")
    live.until_told("are active")


@pytest.fixture
def storyless(copy: Path) -> None:
    """A project whose states may be renamed: no story and no saying names them."""
    shutil.rmtree(copy / "behaviors" / "stories")
    shutil.rmtree(copy / "behaviors" / "sayings")
    main = copy / "lumen.yaml"
    main.write_text(main.read_text("utf-8").replace("story: refuses", "#"), "utf-8")


@pytest.mark.slow
@pytest.mark.usefixtures("storyless")
def test_a_state_that_is_active_is_not_taken_away(live: Live) -> None:
    walker = live.show.visitor
    assert walker
    walker.arrive(Visitor())
    live.until(lambda: "ask_name" in live.states)
    for old, new in (
        ("              ask_name:", "              asking:"),
        ("id: ask_name", "id: asking"),
        ("target: ask_name", "target: asking"),
        ("what|again: ask_name", "what|again: asking"),
        ('"#ask_name"', '"#asking"'),
    ):
        live.edit(old, new)
    live.until_told("waiting for `ask_name`: `ask_name` is active but was removed")
    walker.speak("my name is Ada")
    live.until_told("are active")
    assert "how_are_you" in live.states
