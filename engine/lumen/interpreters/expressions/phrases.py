"""Hearing phrases in what somebody said: whole words, whatever their case and punctuation, in every script."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, cast
from unicodedata import category, normalize

from lumen.interpreters.expressions.kinds import FaultError
from lumen.interpreters.expressions.scope import MAX_TEXT_EXAMINED, Scope
from lumen.language.machines import Answer

_APOSTROPHES = frozenset("'’ʼ‘`´")
BLANKS = "".join(chr(code) for code in range(0x3001) if chr(code).isspace() and not 0x1C <= code <= 0x1F)
"""What Unicode calls White_Space; Python counts four separators of records among it."""

_AROUND = BLANKS + ".,;:!?…\"'“”‘’„«»()[]-–—。！？、，"
_MAX_PREPARED_TABLES = 256


class _WordsOnly(dict[int, str | int]):
    """For `str.translate`: letters, digits, marks and apostrophes stay, everything else becomes a blank."""

    def __missing__(self, code: int) -> str | int:
        character = chr(code)
        kept = code if category(character)[0] in "LNM" or character in _APOSTROPHES else " "
        if len(self) < 4096:
            self[code] = kept
        return kept


_WORDS_ONLY = _WordsOnly()
_NO_APOSTROPHES = dict.fromkeys(map(ord, _APOSTROPHES))


@lru_cache(maxsize=512)
def folded(text: str) -> tuple[str, ...]:
    """The words of a text as they are compared: without case and apostrophes, so that "Don't" is "dont"."""
    joined = normalize("NFKC", text.translate(_NO_APOSTROPHES))
    return tuple(normalize("NFKC", joined.casefold()).translate(_WORDS_ONLY).split())


@lru_cache(maxsize=512)
def padded(text: str) -> str:
    """The compared words between blanks, so that `" no " in " i know "` is false; empty where there is no word."""
    found = folded(text)
    return f" {' '.join(found)} " if found else ""


def words(text: str) -> list[str]:
    """The words of a text as they are written, without punctuation."""
    cleaned = (word.strip("'’ʼ‘`´") for word in text[:MAX_TEXT_EXAMINED].translate(_WORDS_ONLY).split())
    return [word for word in cleaned if word]


class _ByIdentity:
    """What was prepared from a table, for as long as it is among the last few hundred used.

    Tables are frozen values, so an identity stands for its content; keeping the table keeps its identity its own.
    """

    def __init__(self) -> None:
        self.kept: dict[int, tuple[Any, Any]] = {}

    def get(self, table: Any) -> Any:
        found = self.kept.get(id(table))
        return found[1] if found and found[0] is table else None

    def put(self, table: Any, prepared: Any) -> Any:
        if len(self.kept) >= _MAX_PREPARED_TABLES:
            self.kept.clear()
        self.kept[id(table)] = (table, prepared)
        return prepared


_phrases = _ByIdentity()
_kept = _phrases.kept
_last = [("", "")]
"""The text compared last, and its words: the guards of a state compare one text, one after the other."""

_answers = _ByIdentity()
_entries = _ByIdentity()


def _prepared(phrases: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    return tuple({p: None for texts in phrases.values() for text in texts if (p := padded(text))})


def is_heard(text: str, phrases: Mapping[str, tuple[str, ...]]) -> bool:
    """Whether any of the phrases, of whatever language, stands in the text as whole words."""
    try:
        table, prepared = _kept[id(phrases)]
    except KeyError:
        table = None
    if table is not phrases:
        prepared = _phrases.put(phrases, _prepared(phrases))
    last, said = _last[0]
    if last is not text:
        said = padded(text[:MAX_TEXT_EXAMINED])
        _last[0] = text, said
    for phrase in prepared:  # noqa: SIM110 - `any` takes longer than the phrases
        if phrase in said:
            return True
    return False


def phrases_of(value: Any) -> Mapping[str, tuple[str, ...]]:
    """Phrases as they stand in an entry of a list: a list of texts, or one for each language."""
    found = _entries.get(value)
    if found is None:
        table = value if isinstance(value, Mapping) else {"": value}
        found = {key: (rows,) if isinstance(rows, str) else tuple(rows or ()) for key, rows in table.items()}
        if not all(isinstance(text, str) for rows in found.values() for text in rows):
            raise FaultError("these are no phrases", "write a list of texts, or one for each language")
        _entries.put(value, found)
    return cast(Mapping[str, tuple[str, ...]], found)


def answer(scope: Scope, text: str, table: Any) -> Any:
    """The value of the first entry of an `answers:` table one of whose phrases is heard, else null.

    Of a value that is a map of languages, the current one's, or the first where that is missing. A map counts as one
    of languages where every key of it is a language that the table has phrases in, or the current one.
    """
    prepared = _answers.get(table) or _answers.put(table, _AnswerTable(table))
    found = prepared.entry(padded(text[:MAX_TEXT_EXAMINED]))
    return None if found is None else _in_language(found.value, scope.language, prepared.languages)


class _AnswerTable:
    """An `answers:` table: `phrases` of each row by their first word, and the text looked up last."""

    def __init__(self, table: Sequence[Answer]) -> None:
        self.table = tuple(table)
        self.phrases: dict[str, list[tuple[int, str]]] = {}
        for number, entry in enumerate(table):
            for phrase in _prepared(entry.phrases):
                self.phrases.setdefault(phrase.split()[0], []).append((number, phrase))
        self.languages = frozenset(language for entry in table for language in entry.phrases)
        self.last: tuple[str, Answer | None] = ("", None)

    def entry(self, said: str) -> Answer | None:
        """The first row one of whose phrases stands in the words."""
        before, found = self.last
        if before is not said:
            begun = (row for word in said.split() if word in self.phrases for row in self.phrases[word])
            first = min((number for number, phrase in begun if phrase in said), default=None)
            found = None if first is None else self.table[first]
            self.last = said, found
        return found


def _in_language(value: Any, language: str, languages: frozenset[str]) -> Any:
    if not isinstance(value, Mapping) or not value or not value.keys() <= languages | {language}:
        return value
    return value[language] if language in value else next(iter(value.values()))


def after(text: str, phrase: str) -> str:
    """What follows the phrase in the text, without the blanks and punctuation around it; "" where it is not there."""
    text, sought = text[:MAX_TEXT_EXAMINED], list(folded(phrase[:MAX_TEXT_EXAMINED]))
    found: list[str] = []
    ends: list[int] = []
    position = 0
    blanked = text.translate(_WORDS_ONLY)
    for word in blanked.split():
        position = blanked.index(word, position) + len(word)
        parts = folded(word)
        found.extend(parts)
        ends.extend([position] * len(parts))
    for start in range(len(found) - len(sought) + 1) if sought else ():
        if found[start : start + len(sought)] == sought:
            return text[ends[start + len(sought) - 1] :].strip(_AROUND)
    return ""
