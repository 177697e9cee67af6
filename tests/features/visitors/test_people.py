"""Names of people: equal however they are written, found as whole words, and removed from texts."""

import unicodedata

from hypothesis import given
from hypothesis import strategies as st

from lumen.language.people import PersonName, name_key
from tests.tables import for_each


@for_each(
    ("one", "other"),
    [
        ("ünal", "Ünal"),
        ("ünal", unicodedata.normalize("NFD", "ÜNAL")),
        ("ipek", "İpek"),
        ("İPEK", "ipek"),
        ("IŞIK", "Işık"),
        ("ＡＮＩ", "Ani"),
        ("A\u200dni", "ani"),
        ("STRASSE", "Straße"),
        (unicodedata.normalize("NFD", "김민수"), "김민수"),
        (" Ana\u00a0  Maria ", "ana maria"),
    ],
)
def test_one_name_written_in_two_ways(one: str, other: str) -> None:
    assert name_key(one) == name_key(other)
    assert PersonName(one).is_named_in(f"Nice to meet you, {other}!")
    assert PersonName(one).taken_from(f"Hello {other}, hello") == "Hello , hello"


@for_each(
    ("name", "text", "named"),
    [
        ("Ana", "Anabel is here", False),
        ("Ana", "this is Ana's", True),
        ("Ana", "Hello Ana Maria", False),
        ("Ana", "Ana Maria and Ana", True),
        ("Maria", "Hello Ana Maria", False),
        ("Ana Maria", "Ana, and Maria", False),
        ("小明", "我叫小明。", True),
        ("김민수", "김민수입니다", True),
        ("a.b", "aXb", False),
        ("", "anything", False),
        ("\u200d", "anything", False),
    ],
)
def test_whole_words_and_nobody_elses_name(name: str, text: str, named: bool) -> None:
    assert PersonName(name, others=["ana maria"]).is_named_in(text) == named


def test_data_without_the_name() -> None:
    person = PersonName("Ani")
    data = {"text": "I am ANI", "list": ["ani", 1, None], "inner": {"x": "Anita"}, "Ani": True}
    assert person.scrubbed(data) == {"text": "I am", "list": ["", 1, None], "inner": {"x": "Anita"}, "": True}
    untouched = {"text": "Anita", "more": [1, 2.5]}
    assert person.scrubbed(untouched) is untouched


@given(st.text(max_size=20), st.text(max_size=20), st.text(max_size=20))
def test_what_was_taken_out_is_not_in_there_any_more(before: str, name: str, after: str) -> None:
    person = PersonName(name)
    assert not person.is_named_in(person.taken_from(f"{before} {name} {after}"))
    assert not person.is_named_in(person.taken_from(f"{before}{name.upper()}{after}"))
