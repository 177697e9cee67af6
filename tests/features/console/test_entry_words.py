"""Lines about entries, in the languages of the pages."""

import re
from dataclasses import asdict
from string import Formatter
from typing import Any

import pytest

from lumen.features.console.entry_words import ENGLISH, OTHERS, told_of

PERSON = ["person", "", "", "Aisyah", 0.0]
SAID = {"Start": {"id": "d1", "command": {"Say": {"text": "Selamat datang", "language": "id"}}}}


@pytest.mark.parametrize(
    ("entry", "english", "indonesian"),
    [
        ({"heard": "face", "entered": ["greet"], "commands": [SAID]}, "face: → greet, says “Selamat datang”",
         "face: → greet, berkata “Selamat datang”"),
        ({"timer": "after.12s.goodbye", "entered": ["idle"]}, "time is up: → idle", "waktu habis: → idle"),
        ({"heard": "opens", "entered": ["open", "open.idle"]}, "opens: → open.idle", None),
        ({"heard": "touched", "entered": ["talking", "greet"]}, "touched: → talking, greet", None),
        ({"goto": "goto", "data": {"state": "offer"}, "cause": PERSON}, "sent to offer, by Aisyah",
         "dikirim ke offer, oleh Aisyah"),
        ({"jump": "start"}, "the behaviour begins", "perilaku dimulai"),
        ({"jump": "dropped timer"}, "a timer is dropped", "sebuah pewaktu dibatalkan"),
        ({"jump": "keyframe", "said": {"mark": "he waved", "by": "Budi"}}, "mark: he waved, by Budi",
         "tanda: he waved, oleh Budi"),
    ],
)  # fmt: skip
def test_a_line_is_told_in_the_language_of_the_page(
    entry: dict[str, Any], english: str, indonesian: str | None
) -> None:
    told = told_of(entry)
    assert (told["text"], told.get("texts")) == (english, indonesian and {"id": indonesian})


@pytest.mark.parametrize("entry", [{"heard": "touched"}, {"heard": "face"}, {"jump": "keyframe"}, {"jump": "unheard"}])
def test_what_is_the_same_in_all_languages_is_told_once(entry: dict[str, Any]) -> None:
    assert "texts" not in told_of(entry)


def test_each_language_has_all_phrases_with_the_same_places() -> None:
    english = asdict(ENGLISH)
    for other in map(asdict, OTHERS.values()):
        for name, phrase in english.items():
            assert bool(other[name]) == bool(phrase), name
            assert len([*Formatter().parse(other[name])]) == len([*Formatter().parse(phrase)]), name
            assert other[name] != phrase or not re.search(r"\w", phrase), f"{name} is English"
