"""One folding of words, for phrases, answers, names and passages, in every script."""

import re
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import NamedTuple
from unicodedata import category, normalize

APOSTROPHES = frozenset("'’ʼ‘`´")
BLANKS = "\t\n\v\f\r \x85\xa0\u1680" + "".join(map(chr, range(0x2000, 0x200B))) + "\u2028\u2029\u202f\u205f\u3000"
"""Unicode's White_Space; Python also counts four separators of records."""

MAX_TEXT_EXAMINED = 1_000
"""The number of characters of a text that are examined."""

_AROUND = BLANKS + ".,;:!?…\"'“”‘’„«»()[]-–—。！？、，"
_ENDS = re.compile(r"[.!?;:,…。！？、，；：؟،।]|\s[-–—]+\s")
"""The ends of clauses."""

_JOINERS = "\u200b\u200c\u200d\u2060\ufeff\u00ad\u0640"
"""Joiners, soft hyphens and the Arabic tatweel: they are part of a word and do not change it."""

_ALIKE = {"İ": "i", "ı": "i", "I": "i", "ي": "ی", "ى": "ی", "ك": "ک", "ۀ": "ه"}
"""Letters that keyboards and languages with other rules of case write for one another: Turkish, Persian and Arabic."""

_UNWRITTEN = [*range(0x064B, 0x0653), 0x0670, *range(0x0591, 0x05BE), 0x05BF, 0x05C1, 0x05C2, 0x05C4, 0x05C5, 0x05C7]
"""Vowel signs of Arabic and Hebrew, which most texts leave out."""

_WITHOUT_BLANKS = "\u0e00-\u0eff\u1000-\u109f\u1780-\u17ff\u3005-\u3007\u3040-\u30ff\u3400-\u9fff\uf900-\ufaff"
"""Thai, Lao, Burmese, Khmer, Japanese and Chinese letters: there are no blanks between words."""

_TITLES = frozenset(
    ("dr", "mr", "mrs", "ms", "mx", "prof", "st", "ir", "drs", "dra", "hj", "sr", "sra", "mme", "fr", "hr")
)


class _WordsOnly(dict[int, str | int]):
    """For `str.translate`: letters, digits, marks, joiners and apostrophes stay, all else becomes a blank."""

    def __missing__(self, code: int) -> str | int:
        character = chr(code)
        part = category(character)[0] in "LNM" or character in APOSTROPHES or character in _JOINERS
        kept = code if part else " "
        if len(self) < 4096:
            self[code] = kept
        return kept


WORDS_ONLY = _WordsOnly()
_FOLDED: dict[int, str | None] = {
    **dict.fromkeys(map(ord, APOSTROPHES)),
    **dict.fromkeys(map(ord, _JOINERS)),
    **dict.fromkeys(_UNWRITTEN),
    **{ord(one): other for one, other in _ALIKE.items()},
}


@lru_cache(maxsize=4096)
def folded(text: str) -> tuple[str, ...]:
    """Return the words of a text as they are compared: without case and apostrophes, so that "Don't" is "dont".

    Letters of languages without blanks are words of their own, with the marks that belong to them.
    """
    found = unbroken(text)
    return tuple(found) if text.isascii() else tuple(piece for word in found for piece in _pieces(word))


def unbroken(text: str) -> list[str]:
    """Return the folded words as blanks and punctuation separate them, in every language."""
    if text.isascii():
        return text.translate(_FOLDED).lower().translate(WORDS_ONLY).split()
    joined = normalize("NFKC", text.translate(_FOLDED))
    plain = normalize("NFKC", joined.casefold()).replace("i\u0307", "i").translate(WORDS_ONLY)
    return plain.translate(_FOLDED).split()


@cache
def _pieces_pattern() -> re.Pattern[str]:
    """Return the pattern of a letter without blanks, or of all letters up to one. Compiling it takes milliseconds."""
    return re.compile(rf"[{_WITHOUT_BLANKS}]|[^{_WITHOUT_BLANKS}]+")


def _pieces(word: str) -> Iterator[str]:
    if max(word) < _WITHOUT_BLANKS[0]:
        yield word
        return
    piece = ""
    for part in _pieces_pattern().findall(word):
        if piece and not category(part[0]).startswith("M"):
            yield piece
            piece = ""
        piece += part
    yield piece


@lru_cache(maxsize=512)
def padded(text: str) -> str:
    """Return the folded words with a blank around each, so that `" no " in " i know "` is false; empty for no words."""
    found = folded(text)
    return f" {' '.join(found)} " if found else ""


def words(text: str) -> list[str]:
    """Return the words of a text, as far as it is examined, as they are written, without punctuation."""
    cleaned = (word.strip("'’ʼ‘`´") for word in text[:MAX_TEXT_EXAMINED].translate(WORDS_ONLY).split())
    return [word for word in cleaned if word]


def after(text: str, phrase: str) -> str:
    """Return the text that follows the phrase, without blanks and punctuation around it.

    The result is empty if the text does not contain the phrase.
    """
    text, sought = text[:MAX_TEXT_EXAMINED], list(folded(phrase[:MAX_TEXT_EXAMINED]))
    found: list[str] = []
    ends: list[int] = []
    for word, _, end in placed_words(text):
        parts = folded(word)
        found.extend(parts)
        ends.extend([end] * len(parts))
    for start in range(len(found) - len(sought) + 1) if sought else ():
        if found[start : start + len(sought)] == sought:
            return text[ends[start + len(sought) - 1] :].strip(_AROUND)
    return ""


def placed_words(text: str) -> Iterator[tuple[str, int, int]]:
    """Yield the words of a text without punctuation, each with its start and end."""
    blanked = text.translate(WORDS_ONLY)
    position = 0
    for word in blanked.split():
        start = blanked.index(word, position)
        position = start + len(word)
        yield word, start, position


def _ends(text: str, last: int, start: int) -> bool:
    """Return whether a clause ends between two words; the full stop within "3.5" ends no clause."""
    if start - last == 1:
        return text[last] > "\u0500" and _ENDS.match(text, last) is not None
    return _ENDS.search(text, last, start) is not None


def _is_title(word: str, text: str, end: int) -> bool:
    """Return whether the full stop after a word is that of an abbreviated title, as in "Dr. Hasan"."""
    return word in _TITLES and text[end : end + 2] == ". "


class SplitText(NamedTuple):
    """A text as words."""

    text: str
    """The text, as far as it is examined."""
    folded: list[str]
    """The words as they are compared."""
    spans: list[tuple[int, int]]
    """The start and the end of each word in the text [characters]."""
    clauses: list[int]
    """The number of the clause of each word, from 0."""


def read_words(text: str) -> SplitText:
    """Read the words and clauses of a text, as far as it is examined."""
    text = text[:MAX_TEXT_EXAMINED]
    found: list[str] = []
    spans: list[tuple[int, int]] = []
    clauses: list[int] = []
    clause, last = 0, 0
    for word, start, end in placed_words(text):
        if found and _ends(text, last, start) and not _is_title(found[-1], text, last):
            clause += 1
        for part in folded(word):
            found.append(part)
            spans.append((start, end))
            clauses.append(clause)
        last = end
    return SplitText(text, found, spans, clauses)
