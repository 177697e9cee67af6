"""The words by which sentences are read: fillers, small words, negations, question words, numbers and ends of names.

They are phrases and answers under reserved names, so a project replaces them as it does any phrase.
"""

from collections.abc import Iterable, Mapping, Sequence

from lumen.language.machines import Answer
from lumen.talk.folding import folded

FILLERS, SMALL_WORDS = "fillers", "small_words"
NEGATIONS, NEGATIONS_AFTER, CONTRASTS = "negations", "negations_after", "contrasts"
QUESTIONS, QUESTIONS_ANYWHERE = "questions", "questions_anywhere"
NOT_NAMES, NAME_ENDS = "not_names", "name_ends"
NUMBERS, CONTRACTIONS = "numbers", "contractions"
WORD_LISTS = (
    FILLERS, SMALL_WORDS, NEGATIONS, NEGATIONS_AFTER, CONTRASTS, QUESTIONS, QUESTIONS_ANYWHERE, NOT_NAMES, NAME_ENDS,
)  # fmt: skip
"""The reserved names of phrases that are lists of words without a meaning of their own."""
TABLES = (NUMBERS, CONTRACTIONS)
"""The reserved names of answers that are tables of words: number words and contractions, each with its meaning."""

Phrases = Mapping[str, Mapping[str, tuple[str, ...]]]
_HUNDRED, _THOUSAND = 100, 1000


class WordList:
    """Words and sequences of words, as entries to be found in texts."""

    def __init__(self, entries: Iterable[tuple[str, ...]]) -> None:
        self.by_first: dict[str, list[tuple[str, ...]]] = {}
        for words in dict.fromkeys(entries):
            if words:
                self.by_first.setdefault(words[0], []).append(words)
        for several in self.by_first.values():
            several.sort(key=len, reverse=True)
        self.single = frozenset(words[0] for several in self.by_first.values() for words in several if len(words) == 1)

    def __contains__(self, word: str) -> bool:
        return word in self.single

    def are_in(self, words: Sequence[str]) -> bool:
        """Return whether `words` contain an entry."""
        return not self.by_first.keys().isdisjoint(words) and any(self.marks(words))

    def length(self, words: Sequence[str], start: int) -> int:
        """Return the number of words of the longest entry that begins at the index `start`; 0 if no entry does."""
        for entry in self.by_first.get(words[start], ()):
            length = len(entry)
            if length == 1 or tuple(words[start : start + length]) == entry:
                return length
        return 0

    def marks(self, words: Sequence[str]) -> list[int]:
        """Return for each word the length of the entry to which it belongs, 0 for words outside of entries."""
        found = [0] * len(words)
        if self.by_first.keys().isdisjoint(words):
            return found
        position = 0
        while position < len(words):
            if words[position] in self.by_first and (length := self.length(words, position)):
                found[position : position + length] = [length] * length
                position += length
            else:
                position += 1
        return found


class Speech:
    """The word lists of a behaviour, folded, with which sentences are read."""

    def __init__(self, phrases: Phrases, answers: Mapping[str, Sequence[Answer]]) -> None:
        self._same: dict[str, tuple[str, ...]] = {}
        self.numbers: dict[tuple[str, ...], int] = {}
        for row in answers.get(CONTRACTIONS, ()):
            for word in _texts(row.phrases):
                self._same[word] = folded(str(row.value))
        for row in answers.get(NUMBERS, ()):
            for text in _texts(row.phrases):
                words = tuple(text.split())
                self.numbers[words] = row.value
                if len(words) == 1:
                    self._same.setdefault(text, (str(row.value),))
        self.longest_number = max(map(len, self.numbers), default=1)
        for words, value in list(self.numbers.items()):
            self.numbers[self.same(words)] = value

        def listed(name: str) -> WordList:
            return WordList(self.same(folded(text)) for texts in phrases.get(name, {}).values() for text in texts)

        self.fillers, self.negations, self.negations_after = listed(FILLERS), listed(NEGATIONS), listed(NEGATIONS_AFTER)
        self.contrasts, self.questions = listed(CONTRASTS), listed(QUESTIONS)
        self.questions_anywhere = listed(QUESTIONS_ANYWHERE)
        self.not_names, self.name_ends = listed(NOT_NAMES), listed(NAME_ENDS)
        self.small_words = {
            language: frozenset(word for text in texts for word in self.same(folded(text)))
            for language, texts in phrases.get(SMALL_WORDS, {}).items()
        }
        self.small = frozenset(word for words in self.small_words.values() for word in words)

    def same(self, words: Iterable[str]) -> tuple[str, ...]:
        """Return the words with contractions written out and number words as digits."""
        same = self._same
        words = tuple(words)
        if same.keys().isdisjoint(words):
            return words
        found: list[str] = []
        for word in words:
            if word in same:
                found += same[word]
            else:
                found.append(word)
        return tuple(found)

    def number(self, words: Sequence[str], start: int) -> tuple[int, int]:
        """Return the number that begins at the index `start`, and the index of its end: `start` without a number."""
        total = part = 0
        position = start
        while position < len(words):
            length, value = self._number_word(words, position)
            if not length:
                break
            if value in (_HUNDRED, _THOUSAND) and position > start:
                total, part = (total, max(part, 1) * value) if value == _HUNDRED else (total + max(part, 1) * value, 0)
            elif position == start or (part % 10 == 0 and value < max(10, part and _power(part))):
                part += value
            else:
                break
            position += length
        return total + part, position

    def _number_word(self, words: Sequence[str], position: int) -> tuple[int, int]:
        for length in range(min(self.longest_number, len(words) - position), 0, -1):
            value = self.numbers.get(tuple(words[position : position + length]))
            if value is not None:
                return length, value
        word = words[position]
        return (1, int(word)) if word.isdecimal() and len(word) <= 15 else (0, 0)


def _power(number: int) -> int:
    """Return the largest power of ten that divides a number."""
    power = 1
    while number % (10 * power) == 0:
        power *= 10
    return power


def _texts(phrases: Mapping[str, tuple[str, ...]]) -> Iterable[str]:
    return dict.fromkeys(" ".join(folded(text)) for texts in phrases.values() for text in texts)
