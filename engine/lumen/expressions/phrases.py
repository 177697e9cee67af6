"""Phrases in the language of expressions: `heard` and `lookup`."""

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias, cast

from lumen.expressions.kinds import FaultError
from lumen.expressions.scope import MAX_TEXT_EXAMINED, Scope
from lumen.language.machines import Answer
from lumen.talk.finder import Finder
from lumen.talk.folding import padded
from lumen.talk.hearing import in_language, languages_of, phrases_in
from lumen.talk.patterns import forms
from lumen.talk.speech import Speech

_MAX_PREPARED_TABLES = 256
Lists: TypeAlias = Mapping[str, Sequence[Mapping[str, Any]]]
_NO_LISTS: Lists = {}


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
_finders = _ByIdentity()
_entries = _ByIdentity()


def _prepared(phrases: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """The forms without slots, padded."""
    found = (form for texts in phrases.values() for text in texts for form in forms(text) if form.plain)
    return tuple({f" {' '.join(form.literals)} ": None for form in found})


def _with_slots(phrases: Mapping[str, tuple[str, ...]]) -> bool:
    return any("{" in text for texts in phrases.values() for text in texts)


def is_heard(text: str, phrases: Mapping[str, tuple[str, ...]], lists: Lists = _NO_LISTS) -> bool:
    """Whether any of the phrases, in any language, is in the text as whole words; a negation changes nothing.

    `lists` are those that a slot may name.
    """
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
    for phrase in prepared:
        if phrase in said:
            return True
    return _with_slots(phrases) and _is_caught(text, phrases, lists)


def _is_caught(text: str, phrases: Mapping[str, tuple[str, ...]], lists: Lists) -> bool:
    """Whether a form with slots is in the text."""
    finder = _finders.get(phrases)
    if finder is None:
        entries = {name: [(phrases_in(entry), entry) for entry in rows] for name, rows in lists.items()}
        finder = _finders.put(phrases, Finder(Speech({}, {}), {"": phrases}, lists=entries))
    reading = finder.read(text)
    return bool(reading.finds or finder.slotted(reading))


def phrases_of(value: Any) -> Mapping[str, tuple[str, ...]]:
    """Phrases as they stand in an entry of a list: a list of texts, or one for each language.

    Raises FaultError if the value is anything else.
    """
    found = _entries.get(value)
    if found is None:
        table = value if isinstance(value, Mapping) else {"": value}
        found = {key: (rows,) if isinstance(rows, str) else rows or () for key, rows in table.items()}
        if not all(
            isinstance(rows, Sequence) and all(isinstance(text, str) for text in rows) for rows in found.values()
        ):
            raise FaultError("these are not phrases", "write a list of texts, or one for each language")
        found = _entries.put(value, {key: tuple(rows) for key, rows in found.items()})
    return cast(Mapping[str, tuple[str, ...]], found)


def answer(scope: Scope, text: str, table: Any) -> Any:
    """The value of the first entry of an `answers:` table one of whose phrases is heard, else null.

    Of a value that is a map of languages, the current one's, or the first where that is missing. A map counts as one
    of languages where every key of it is a language that the table has phrases in, or the current one.
    """
    prepared = _answers.get(table) or _answers.put(table, _AnswerTable(table))
    found = prepared.entry(padded(text[:MAX_TEXT_EXAMINED]))
    return None if found is None else in_language(found.value, scope.language, prepared.languages)


class _AnswerTable:
    """An `answers:` table: `phrases` of each row by their first word, and the text looked up last."""

    def __init__(self, table: Sequence[Answer]) -> None:
        self.table = tuple(table)
        self.phrases: dict[str, list[tuple[int, str]]] = {}
        for number, entry in enumerate(table):
            for phrase in _prepared(entry.phrases):
                self.phrases.setdefault(phrase.split()[0], []).append((number, phrase))
        self.languages = languages_of(table)
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
