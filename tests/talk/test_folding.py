"""One folding of words, for phrases, names and passages."""

from lumen.expressions.phrases import is_heard
from lumen.retrieval.scorers import words
from lumen.talk.folding import folded, read_words
from tests.tables import for_each


@for_each(
    "text, expected",
    [
        ("Don't STOP!", ("dont", "stop")),
        ("STRASSE Straße", ("strasse", "strasse")),
        ("İSTANBUL istanbul ISPARTA ısparta", ("istanbul", "istanbul", "isparta", "isparta")),
        ("José Jose\u0301", ("josé", "josé")),
        ("हिन्दी में बोलो", ("हिन्दी", "में", "बोलो")),
        ("தமிழ் பேசு", ("தமிழ்", "பேசு")),
        ("می‌خواهم", ("میخواهم",)),
        ("كتاب کتاب", ("کتاب", "کتاب")),
        ("مُحَمَّد", ("محمد",)),
        ("踊って", ("踊", "っ", "て")),
        ("ที่ไหน", ("ที่", "ไ", "ห", "น")),
        ("soft\u00adhyphen", ("softhyphen",)),
        ("well-known", ("well", "known")),
        ("\u200b", ()),
        ("", ()),
    ],
)
def test_words_are_compared_alike(text: str, expected: tuple[str, ...]) -> None:
    assert folded(text) == expected


@for_each(
    "text, phrase",
    [
        ("ぜひ踊ってください", "踊って"),
        ("请给我跳舞吧", "跳舞"),
        ("ธนาคารอยู่ที่ไหนครับ", "ที่ไหน"),
        ("ISTANBUL'A HOŞ GELDİNİZ", "hoş geldiniz"),
        ("hindi: हिन्दी में बोलिए", "हिन्दी में"),
    ],
)
def test_a_phrase_is_found_in_every_script(text: str, phrase: str) -> None:
    assert is_heard(text, {"": (phrase,)})


@for_each("text, phrase", [("हिन्दू", "हिन्द"), ("மரம்", "மர"), ("I know", "no"), ("跳", "跳舞")])
def test_a_part_of_a_word_is_no_word(text: str, phrase: str) -> None:
    assert not is_heard(text, {"": (phrase,)})


def test_passages_are_compared_by_the_same_words() -> None:
    assert words("Can't हिन्दी, Straße?") == ["cant", "हिन्दी", "strasse"]


@for_each(
    "text, clauses",
    [
        ("No, thanks. Bye!", [0, 1, 2]),
        ("It is 3.5 metres", [0, 0, 0, 0, 0]),
        ("I am Dr. Hasan", [0, 0, 0, 0]),
        ("yes - no", [0, 1]),
        ("はい。いいえ", [0, 0, 1, 1, 1]),
        ("well-known", [0, 0]),
    ],
)
def test_clauses_end_at_punctuation(text: str, clauses: list[int]) -> None:
    assert read_words(text).clauses == clauses


def test_a_slot_is_filled_from_the_lists_of_this_call() -> None:
    phrases = {"en": ("show me the {exhibit}",)}
    old, new = ({"exhibit": [{"name": name, "phrases": [name]}]} for name in ("organ", "globe"))
    for _ in range(2):
        for lists, there, absent in ((old, "organ", "globe"), (new, "globe", "organ")):
            assert is_heard(f"please show me the {there}", phrases, lists)
            assert not is_heard(f"please show me the {absent}", phrases, lists)
