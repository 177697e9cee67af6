"""Phrases in expressions: `heard` and `lookup`."""

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
    """A cache of values prepared from tables, which is emptied when it is full.

    Tables are frozen, so their identity represents their content; the cache keeps each table alive, so that its
    identity is not reused.
    """

    def __init__(self) -> None:
        self.kept: dict[int, tuple[Any, Any]] = {}

    def get(self, table: Any) -> Any:
        """Return the value prepared from the table; None if it is not in the cache."""
        found = self.kept.get(id(table))
        return found[1] if found and found[0] is table else None

    def put(self, table: Any, prepared: Any) -> Any:
        """Store and return the value prepared from the table."""
        if len(self.kept) >= _MAX_PREPARED_TABLES:
            self.kept.clear()
        self.kept[id(table)] = (table, prepared)
        return prepared


_phrases = _ByIdentity()
_kept = _phrases.kept
_last = [("", "")]
"""The last text compared, and its words: the guards of a state compare the same text one after another."""

_answers = _ByIdentity()
_finders = _ByIdentity()
"""For each table of phrases, the finders by the lists that its slots may name."""
_entries = _ByIdentity()


def _prepared(phrases: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """Return the phrases' forms (`lumen.talk.patterns`) without slots, each with a space before and after it."""
    found = (form for texts in phrases.values() for text in texts for form in forms(text) if form.plain)
    return tuple({f" {' '.join(form.literals)} ": None for form in found})


def is_heard(text: str, phrases: Mapping[str, tuple[str, ...]], lists: Lists = _NO_LISTS) -> bool:
    """Return True if any phrase, in any language, is in the text as whole words, even in a negation.

    `lists` are the lists that slots may name.
    """
    try:
        table, (prepared, slotted) = _kept[id(phrases)]
    except KeyError:
        table = None
    if table is not phrases:
        prepared, slotted = _phrases.put(
            phrases, (_prepared(phrases), any("{" in text for texts in phrases.values() for text in texts))
        )
    last, said = _last[0]
    if last is not text:
        said = padded(text[:MAX_TEXT_EXAMINED])
        _last[0] = text, said
    for phrase in prepared:
        if phrase in said:
            return True
    return slotted and _is_caught(text, phrases, lists)


def _is_caught(text: str, phrases: Mapping[str, tuple[str, ...]], lists: Lists) -> bool:
    """Return True if any phrase, with or without slots such as `{name}`, is in the text, even in a negation.

    `lists` are the lists that slots may name.
    """
    finders = _finders.get(phrases) or _finders.put(phrases, _ByIdentity())
    finder = finders.get(lists)
    if finder is None:
        entries = {name: [(phrases_in(entry), entry) for entry in rows] for name, rows in lists.items()}
        finder = finders.put(lists, Finder(Speech({}, {}), {"": phrases}, lists=entries))
    reading = finder.read(text)
    return bool(reading.finds or finder.slotted(reading))


def phrases_of(value: Any) -> Mapping[str, tuple[str, ...]]:
    """Return the phrases in a list entry: a list of texts, or one list for each language.

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
    """Return the value of the first `answers:` row with a phrase that is in the text; None if there is no such row.

    If the value is a map of languages, return the text in the current language, or the first text if there is none in
    that language. A map is one of languages if every key is the current language, or a language in which the table has
    phrases.
    """
    prepared = _answers.get(table) or _answers.put(table, _AnswerTable(table))
    found = prepared.entry(padded(text[:MAX_TEXT_EXAMINED]))
    return None if found is None else in_language(found.value, scope.language, prepared.languages)


class _AnswerTable:
    """An `answers:` table: the phrases of each row by their first word, and a cache of the last lookup."""

    def __init__(self, table: Sequence[Answer]) -> None:
        self.table = tuple(table)
        self.phrases: dict[str, list[tuple[int, str]]] = {}
        for number, entry in enumerate(table):
            for phrase in _prepared(entry.phrases):
                self.phrases.setdefault(phrase.split()[0], []).append((number, phrase))
        self.languages = languages_of(table)
        self.last: tuple[str, Answer | None] = ("", None)

    def entry(self, said: str) -> Answer | None:
        """Return the first row with a phrase that is in the padded words `said`; None if there is no such row."""
        before, found = self.last
        if before is not said:
            begun = (row for word in said.split() if word in self.phrases for row in self.phrases[word])
            first = min((number for number, phrase in begun if phrase in said), default=None)
            found = None if first is None else self.table[first]
            self.last = said, found
        return found
