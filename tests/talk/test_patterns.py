"""Phrases as patterns: their forms, and unreadable ones."""

import pytest

from lumen.talk.patterns import MAX_FORMS, PatternError, Slot, forms, read_pattern
from tests.tables import for_each


def _shown(phrase: str) -> list[str]:
    return [
        " ".join(f"<{p.type}:{p.name}>" if isinstance(p, Slot) else p for p in form.parts) for form in forms(phrase)
    ]


@for_each(
    "phrase, expected",
    [
        ("Dance!", ["dance"]),
        ("(show|take) me [to] the {exhibits}", ["show me the <exhibits:exhibits>", "show me to the <exhibits:exhibits>",
         "take me the <exhibits:exhibits>", "take me to the <exhibits:exhibits>"]),
        ("exhibit {number:n}", ["exhibit <number:n>"]),
        ("I am {name?}", ["i am <name?:name>"]),
        ("light[s] on", ["light on", "lights on"]),
        ("[please|do] dance", ["dance", "please dance", "do dance"]),
        ("(a (b|c)|d) e", ["a b e", "a c e", "d e"]),
        ("[[a] b] c", ["c", "b c", "a b c"]),
        ("(a|a)", ["a"]),
        ("{name}", ["<name:name>"]),
        ("...", []),
    ],
)  # fmt: skip
def test_a_pattern_has_its_forms(phrase: str, expected: list[str]) -> None:
    assert _shown(phrase) == expected


@for_each("phrase, whole", [("no.", True), ("no", False), ("(a|b). ", True), ("3.5", False), ("no!", False)])
def test_a_full_stop_means_the_whole_clause(phrase: str, whole: bool) -> None:
    assert {form.whole for form in forms(phrase)} == {whole}


@for_each(
    "phrase, offset, says",
    [
        ("(a|b", 0, "is not closed"),
        ("a [b", 2, "is not closed"),
        ("a)", 1, "closes nothing"),
        ("a|b", 1, "inside"),
        ("a (|b)", 2, "is empty"),
        ("a () b", 2, "is empty"),
        ("exhibit {number: n}", 8, "is not a slot"),
        ("{ name }", 0, "is not a slot"),
        ("{name", 0, "is not a slot"),
        ("(a|b) (a|b) (a|b) (a|b) (a|b) (a|b) (a|b) (a|b)", 0, f"more than {MAX_FORMS} forms"),
    ],
)
def test_what_is_no_pattern_is_said_and_counts_as_its_words(phrase: str, offset: int, says: str) -> None:
    with pytest.raises(PatternError) as error:
        read_pattern(phrase)
    assert error.value.offset == offset
    assert says in error.value.message
    assert error.value.hint
    assert all(form.plain for form in forms(phrase))
