"""The language services for `hears`, for phrases, and for the words that come with Lumen."""

from pathlib import Path

import pytest

from lumen.errors import UsageError
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import complete
from lumen.features.editor.definitions import definitions, uses
from lumen.features.editor.hover import hover
from lumen.features.editor.renaming import applied, renamable, rename
from lumen.features.editor.symbols import search
from lumen.project.common_words import COMMON_FILE, common_words
from tests.tables import for_each

MAIN = """\
name: Test
behavior: tour
languages: [en, id]
robot: {name: NAO, model: nao}
hall: hall.xml
routes:
  heard: {key: "lumen.{robot}.audio.speech.recognition", direction: in, schema: speech.recognition, event: heard}
"""
TOUR = """\
words: [common, visitors]
context: {who: ""}
states:
  ask:
    hears:
      my_name: {target: offer, actions: {assign: {who: heard.name}}}
      no: offer
      else: .
  offer:
    hears:
      dance: dance
      not  dance | sing: .
      tour_of:
        - guard: heard.exhibits.id == 'rex'
          target: dance
      faq: {actions: {say: "{{ heard.answer }}"}}
      else: {guard: "heard(event.data.result, 'sing')", target: dance}
  dance:
    for: {each: lists.exhibits, as: exhibit}
    states:
      quiz: {hears: {exhibit.phrases: over}}
      over: {type: final}
"""
WORDS = """\
phrases:
  dance: {en: [dance, dancing], id: [menari]}
  sing: {en: [sing], anyhow: true}
  tour_of:
    en:
      - (show|take) me [to] {exhibits}
      - "{exhibits}, please."
      - exhibit {number:n}
answers:
  faq:
    - {phrases: {en: [how tall]}, value: 57 cm}
lists:
  exhibits:
    - {id: rex, phrases: {en: [the rex]}}
"""
T, W = "behaviors/tour.yaml", "behaviors/words/visitors.yaml"
FILES = {"lumen.yaml": MAIN.encode(), T: TOUR.encode(), W: WORDS.encode()}
PROJECT = Analysis(Path("/nowhere"), FILES)


def place(analysis: Analysis, file: str, text: str) -> tuple[str, int, int]:
    """Return the place of the `¦` in a piece of the file's text."""
    whole = analysis.text(file)
    at = whole.index(text.replace("¦", "")) + text.index("¦")
    return file, whole.count("\n", 0, at) + 1, at - whole.rfind("\n", 0, at)


def written(file: str, old: str, new: str) -> tuple[Analysis, tuple[str, int, int]]:
    """Return the project with `new` in place of `old`, and the place of the `¦` in it."""
    text = PROJECT.text(file)
    assert text.count(old) >= 1
    at = text.index(old) + new.index("¦")
    analysis = PROJECT.changed(file, text.replace(old, new.replace("¦", ""), 1))
    whole = analysis.text(file)
    return analysis, (file, whole.count("\n", 0, at) + 1, at - whole.rfind("\n", 0, at))


def rows_of(analysis: Analysis) -> int:
    """Return the number of transitions with `hears` in the behaviour."""
    machine = analysis.draft.behaviors["tour"]
    return sum(transition.hears is not None for state in machine.states.values() for transition in state.transitions)


def test_lumens_own_words_are_none_of_the_files() -> None:
    assert COMMON_FILE not in PROJECT.files
    assert rows_of(PROJECT) == 9


@for_each(
    ("file", "old", "new", "some", "none"),
    [
        (T, "      dance: dance\n", "      ¦\n", ["dance: ", "faq: ", "yes: ", "my_name: ", "not ", "asked "], [
            "fillers: ", "numbers: ", "else: ",
        ]),
        (T, "      else: .\n", "      ¦\n", ["else: "], []),
        (T, "      dance: dance\n", "      not da¦\n", ["dance: "], ["sing: ", "not ", "else: "]),
        (T, "      dance: dance\n", "      dance|s¦\n", ["sing: "], ["asked ", "dance: "]),
        (T, "      dance: dance\n", "      asked dance|¦: dance\n", ["sing: ", "faq: "], ["not "]),
        (T, "{exhibit.phrases: over}", "{¦}", ["exhibit.id: ", "exhibit.phrases: ", "dance: "], []),
        (T, "      dance: dance\n", "      exhibit.¦\n", [], ["exhibit.id: "]),
        (T, "dance: dance\n", "dance: ¦\n", [".", "ask", '"#offer"'], ["dance: "]),
        (T, "{who: heard.name}", "{who: heard.¦}", ["text", "phrase", "name"], ["answer", "n"]),
        (T, "heard.exhibits.id", "heard.¦", ["text", "exhibits", "n"], ["answer", "name"]),
        (T, "{{ heard.answer }}", "{{ heard.¦ }}", ["text", "answer"], ["name"]),
        (T, "{{ heard.answer }}", "{{ ¦ }}", ["heard", "heard(", "context"], []),
        (T, "words: [common, visitors]", "words: [¦", ["common", "visitors"], []),
        (W, "- exhibit {number:n}", '- "exhibit {¦', ["name}", "name?}", "number}", "text}", "exhibits}"], ["dance"]),
        (W, "- exhibit {number:n}", "- exhibit {n¦", ["name}", "number}"], ["text}"]),
        (W, "[how tall]", '["how tall {¦"]', ["name}"], []),
        (W, "  sing: {en: [sing], anyhow: true}", "  sing: {en: [sing], ¦}", ["anyhow: ", "id: "], []),
    ],
)  # fmt: skip
def test_completion(file: str, old: str, new: str, some: list[str], none: list[str]) -> None:
    analysis, here = written(file, old, new)
    proposed = [item.text for item in complete(analysis, *here)]
    assert set(some) <= set(proposed), proposed
    assert not set(none) & set(proposed), proposed


@for_each(
    ("file", "text", "where"),
    [
        (T, "      dan¦ce: dance", f"{W}: dance:"),
        (T, "not  dan¦ce | sing", f"{W}: dance:"),
        (T, "not  dance | si¦ng", f"{W}: sing:"),
        (T, "      fa¦q:", f"{W}: faq:"),
        (T, "dance: dan¦ce\n", f"{T}: dance:"),
        (T, "      ¦no: offer", ""),
        (T, "my_¦name:", ""),
        (T, "words: [comm¦on", ""),
        (T, "el¦se: .", ""),
        (W, "any¦how: true", ""),
    ],
)
def test_definition(file: str, text: str, where: str) -> None:
    """The definition of a name that comes with Lumen is in no file of the project."""
    found = definitions(PROJECT, *place(PROJECT, file, text))
    name, _, key = where.partition(": ")
    assert [place.file for place in found] == ([name] if name else [])
    for one in found:
        assert PROJECT.text(name).split("\n")[one.line - 1][one.column - 1 :].startswith(key)


def test_a_words_file_of_the_project_replaces_lumens_own() -> None:
    own = Analysis(PROJECT.root, {**FILES, COMMON_FILE: common_words() + b"# ours\n"})
    assert [found.file for found in definitions(own, *place(own, T, "      ¦no: offer"))] == [COMMON_FILE]
    visitors = PROJECT.changed(W, WORDS.replace("phrases:\n", "phrases:\n  no: {en: [never]}\n", 1))
    assert [found.file for found in definitions(visitors, *place(visitors, T, "      ¦no: offer"))] == [W]


@for_each(
    ("file", "text", "said"),
    [
        (T, "      dan¦ce: dance", ["**hears dance**: taken if one of its phrases is said", "- “dance”", "id: menari"]),
        (T, "not  dan¦ce | sing", ["**hears not dance|sing**: taken if the visitor refuses it", "phrase `dance`"]),
        (T, "tour¦_of:", ['- “show me the rex”: `heard.exhibits` is {"id": "rex"', "- en: (show|take) me [to] {"]),
        (T, "my_¦name:", ["taken if one of its phrases is said", '`heard.name` is "Budi"', "phrase `my_name`"]),
        (T, "my_¦name:", ["It comes with Lumen. To replace it, define it in a file in behaviors/words/"]),
        (T, "      fa¦q:", ['- “how tall”: `heard.answer` is "57 cm"', "answers table `faq`"]),
        (
            T,
            "el¦se: .",
            ["**hears else**: taken if no other row of the active states matches", "- “lorem ipsum dolor sit amet”"],
        ),
        (W, "tour_¦of:", ["- “exhibit 3”: `heard.n` is 3"]),
        (W, "(show|ta¦ke) me", ["- “take me to the rex”: `heard.exhibits` is "]),
        (W, "{exhibits}, ple¦ase.", ["found in, as a whole clause:", "- “the rex , please”"]),
        (W, "[dance, dan¦cing]", ["- “dancing”"]),
        (W, "any¦how: true", ["Whether the phrases count in `hears` even if they are negated"]),
        (T, "he¦ars:\n      dance", ["What the robot reacts to in what a visitor says"]),
    ],
)
def test_hover(file: str, text: str, said: list[str]) -> None:
    shown = hover(PROJECT, *place(PROJECT, file, text))
    assert [sentence for sentence in said if sentence not in shown] == [], shown


@for_each(
    ("file", "text", "name", "rows"),
    [
        (T, "      dan¦ce: dance", "moves", ["      moves: dance\n", "      not  moves | sing: .\n"]),
        (W, "  sin¦g:", "song", ["      not  dance | song: .\n", "heard(event.data.result, 'song')"]),
        (T, "      fa¦q:", "quiz", ["      quiz: {"]),
        (T, "dance: dan¦ce\n", "moving", ["      dance: moving\n"]),
    ],
)
def test_a_renaming_reaches_the_keys_of_hears(file: str, text: str, name: str, rows: list[str]) -> None:
    use = renamable(PROJECT, *place(PROJECT, file, text))
    assert use
    after = applied(PROJECT, rename(PROJECT, use, name))
    assert [row for row in rows if row not in after.text(T)] == []
    assert rows_of(after) == rows_of(PROJECT)


@for_each(
    ("name", "reason"),
    [
        ("not", "keys of `hears`"), ("asked", "keys of `hears`"), ("else", "keys of `hears`"),
        ("fillers", "word list"), ("not_names", "word list"), ("questions", "word list"), ("numbers", "word list"),
    ],
)  # fmt: skip
def test_what_means_something_to_hears_is_no_name(name: str, reason: str) -> None:
    """Such words can name neither phrases nor answers."""
    for text in ("      dan¦ce: dance", "      fa¦q:"):
        use = renamable(PROJECT, *place(PROJECT, T, text))
        assert use
        with pytest.raises(UsageError, match=reason):
            rename(PROJECT, use, name)


@for_each("text", ["      ¦no: offer", "my_¦name:", "words: [comm¦on", "el¦se: .", "{¦exhibit.phrases: over}"])
def test_what_comes_with_lumen_can_not_be_renamed(text: str) -> None:
    assert renamable(PROJECT, *place(PROJECT, T, text)) is None


def test_uses_of_a_phrase_in_rows_and_calls() -> None:
    found = {(use.file, use.line, use.column) for use in uses(PROJECT, *place(PROJECT, W, "  sin¦g:"))}
    assert found == {place(PROJECT, *where) for where in (
        (W, "  ¦sing:"), (T, "not  dance | ¦sing"), (T, "heard(event.data.result, '¦sing')"),
    )}  # fmt: skip
    assert [use.text for use in PROJECT.index.uses if use.place.file == COMMON_FILE and use.text] == []
    assert {use.place.file for use in search(PROJECT, "greeting")} <= set(FILES)


def test_lumens_words_are_known_before_a_behaviour_can_be_read() -> None:
    text = "words: [common]\nstates:\n  a:\n    hears:\n      y"
    plain = Analysis(PROJECT.root, {**FILES, T: text.encode()})
    assert "yes: " in {item.text for item in complete(plain, T, 5, 8)}


SAYINGS = """\
tour:
  offer:
    dance: {en: ["Dance, please."]}
    not  dance|sing: {en: [Please don't sing]}
    no: {en: [Never]}
  dance.quiz: {else: {en: [Hm]}}
"""
S = "behaviors/sayings/visitors.yaml"
WITH_SAYINGS = Analysis(PROJECT.root, {**FILES, S: SAYINGS.encode()})


@for_each(
    ("file", "text", "name", "lines"),
    [
        (T, "      dan¦ce: dance", "moves", ["    moves: {en: ", "    not  moves|sing: {en: "]),
        (S, "dance|si¦ng:", "song", ["    not  dance|song: {en: "]),
        (S, "  off¦er:", "asking", ["  asking:\n"]),
        (T, "  dan¦ce:\n", "moving", ["  moving.quiz: {else: ", "    dance: {en: "]),
    ],
)
def test_a_renaming_reaches_sayings(file: str, text: str, name: str, lines: list[str]) -> None:
    use = renamable(WITH_SAYINGS, *place(WITH_SAYINGS, file, text))
    assert use
    after = applied(WITH_SAYINGS, rename(WITH_SAYINGS, use, name))
    assert [line for line in lines if line not in after.text(S)] == [], after.text(S)
    assert rows_of(after) == rows_of(PROJECT)


def test_the_keys_of_sayings_are_completed() -> None:
    keys = (
        ("  offer:\n", "  ¦:\n", {"ask: ", "offer: ", "dance.quiz: "}),
        ("    no: ", "    n¦: ", {"no: ", "sing: "}),
    )
    for old, new, some in keys:
        text = SAYINGS.replace(old, new.replace("¦", ""))
        analysis = WITH_SAYINGS.changed(S, text)
        line = text[: SAYINGS.index(old)].count("\n") + 1
        assert some <= {item.text for item in complete(analysis, S, line, new.index("¦") + 1)}
