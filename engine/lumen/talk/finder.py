"""Finds phrases in a sentence: every form of every name at once, with one trie."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

from lumen.talk.folding import read_words
from lumen.talk.patterns import Form, Slot, forms
from lumen.talk.speech import Speech

NEAR = 5
"""The greatest number of words, not counting fillers, between a negation and the words that it negates."""
NEAR_AFTER = 2
"""The greatest number of such words between the negated words and a negation that follows them."""
MAX_NAME_WORDS = 4
_ENDS, _SLOTS = 0, 1
"""Keys of a node of the trie besides words: for the forms that end there, and for the slots that follow."""
_MAX_FINDS = 500
_MAX_WALKS = 10_000
"""The greatest number of steps of a search in one text: patterns with several slots fit a long text in many ways."""

_Node: TypeAlias = dict[Any, Any]
Languages: TypeAlias = Mapping[str, Sequence[str]]
_PARTICLES = frozenset(
    (
        "van", "von", "der", "den", "de", "la", "le", "di", "da", "del", "della", "dos", "al", "el", "bin", "binti",
        "bint", "ibn", "abu", "ter", "ten", "zu", "af",
    )
)  # fmt: skip
"""Words in lower case that a name may contain."""


class Entry(NamedTuple):
    """A form in the trie: its name, its strength, and the rules that apply to it."""

    name: str
    row: int
    """The number of the form's row in a table of answers; 0 for phrases."""
    strength: int
    """The number of the form's words that are not fillers."""
    alone: bool
    """Whether the form must be a whole clause."""
    negative: bool
    """Whether the form itself contains a negation."""
    question: bool
    """Whether the form itself contains a question word."""
    anyhow: bool
    """Whether the form is found even if it is negated."""


class Find(NamedTuple):
    """A form that was found in a text."""

    entry: Entry
    start: int
    """The index of the form's first word."""
    end: int
    """The index after the form's last word."""
    caught: tuple[tuple[str, Any], ...]
    """The values that the slots caught, each after the slot's name."""
    strength: int
    """The strength of the form, plus those of the list entries that the slots caught."""


class ReadSentence:
    """A text as it was read, and the forms found in it by name."""

    __slots__ = ("clauses", "filler", "finds", "kept", "marks", "slotted", "spans", "speech", "text", "walks", "words")

    def __init__(self, text: str, speech: Speech) -> None:
        read = read_words(text)
        self.text, self.speech = read.text, speech
        words, spans, clauses = read.folded, read.spans, read.clauses
        if not speech._same.keys().isdisjoint(words):
            words, spans, clauses = _written_out(speech, words, spans, clauses)
        self.words, self.spans, self.clauses = words, spans, clauses
        self.filler = speech.fillers.marks(words)
        self.finds: dict[str, list[Find]] = {}
        self.slotted: dict[str, list[Find]] | None = None
        self.marks: dict[str, list[int]] = {}
        self.kept: dict[Any, Any] = {}
        self.walks = 0

    def said(self, start: int, end: int) -> str:
        """Return the words from `start` to before `end` as they were said."""
        return self.text[self.spans[start][0] : self.spans[end - 1][1]] if end > start else ""

    def is_whole(self, find: Find) -> bool:
        """Return whether the clauses of a find contain, besides it, only fillers and forms of the same name."""
        words = range(len(self.words))
        inside = set(self.clauses[find.start : find.end])
        rest = [i for i in words if self.clauses[i] in inside and not self.filler[i] and not find.start <= i < find.end]
        if not rest:
            return True
        same = [*self.finds.get(find.entry.name, ()), *(self.slotted or {}).get(find.entry.name, ())]
        return all(any(other.start <= i < other.end for other in same) for i in rest)

    def negation(self, find: Find) -> int | None:
        """Return the index of the word that negates a find; None if no word does."""
        if find.entry.negative or find.entry.anyhow:
            return None
        before = self._negating("negations", range(find.start - 1, -1, -1), self.clauses[find.start], NEAR)
        if before is not None:
            return before
        after = range(find.end, len(self.words))
        return self._negating("negations_after", after, self.clauses[find.end - 1], NEAR_AFTER)

    def _negating(self, kind: str, places: Iterable[int], clause: int, near: int) -> int | None:
        """Return the index of the first word of a kind in the clause, at most `near` non-filler words away, or None."""
        negations, contrasts, between = self._marked(kind), self._marked("contrasts"), 0
        for i in places:
            if self.clauses[i] != clause or contrasts[i]:
                break
            if negations[i] and self.filler[i] <= negations[i]:
                return i
            between += not self.filler[i]
            if between > near:
                break
        return None

    def is_asked(self, find: Find) -> bool:
        """Return whether a find is in a question.

        Its clause then begins with a question word, or has one of `questions_anywhere`. A form with a question word of
        its own is not part of a question.
        """
        if find.entry.question:
            return False
        clause = self.clauses[find.start]
        inside = [i for i, c in enumerate(self.clauses) if c == clause]
        first = next((i for i in inside if not self.filler[i]), None)
        if first is not None and self.speech.questions.length(self.words, first):
            return True
        anywhere = self._marked("questions_anywhere")
        return any(anywhere[i] for i in inside)

    def _marked(self, what: str) -> list[int]:
        found = self.marks.get(what)
        if found is None:
            words: Any = getattr(self.speech, what)
            found = self.marks[what] = words.marks(self.words)
        return found


def _written_out(
    speech: Speech, words: list[str], spans: list[tuple[int, int]], clauses: list[int]
) -> tuple[list[str], list[tuple[int, int]], list[int]]:
    parts = [speech.same((word,)) for word in words]
    return (
        [part for several in parts for part in several],
        [span for span, several in zip(spans, parts, strict=True) for _ in several],
        [clause for clause, several in zip(clauses, parts, strict=True) for _ in several],
    )


class Finder:
    """The phrases of a behaviour in one trie.

    `tables` are phrases by language for each name, `rows` are such phrases for each row of a name's answers, and
    `lists` are those of each entry of a list, with the entry. Names in `anyhow` are found even if they are negated.
    `others` are phrases that are not searched for, but whose words do not count as a person's name either.
    """

    def __init__(
        self,
        speech: Speech,
        tables: Mapping[str, Languages],
        rows: Mapping[str, Sequence[Languages]] | None = None,
        lists: Mapping[str, Sequence[tuple[Languages, Any]]] | None = None,
        anyhow: Iterable[str] = (),
        others: Iterable[Languages] = (),
    ) -> None:
        self.speech, self.anyhow = speech, frozenset(anyhow)
        self._tables = (*tables.values(), *(table for several in (rows or {}).values() for table in several), *others)
        self.root: _Node = {}
        self.leading: list[tuple[frozenset[str], _Node]] = []
        """The forms that begin with a slot, each with the words that it needs."""
        self.slots_only: list[tuple[Form, Entry]] = []
        self.lists = {name: self._list(entries) for name, entries in (lists or {}).items()}
        for name, table in tables.items():
            self._add(name, 0, table)
        for name, several in (rows or {}).items():
            for number, table in enumerate(several):
                self._add(name, number, table)

    @cached_property
    def phrases(self) -> frozenset[tuple[str, ...]]:
        """The words of all phrases without slots, which do not count as a person's name."""
        texts = {text for table in self._tables for several in table.values() for text in several}
        return frozenset(self.speech.same(form.literals) for text in texts for form in forms(text) if form.plain)

    def _list(self, entries: Sequence[tuple[Languages, Any]]) -> _Node:
        root: _Node = {}
        for table, value in entries:
            for phrases in table.values():
                for phrase in phrases:
                    for form in forms(phrase):
                        if form.plain:
                            words = self.speech.same(form.literals)
                            _insert(root, words, (value, sum(word not in self.speech.fillers for word in words)))
        return root

    def _add(self, name: str, row: int, table: Languages) -> None:
        for language, phrases in table.items():
            small = self.speech.small_words.get(language, frozenset()) if language else self.speech.small
            for phrase in phrases:
                for form in forms(phrase):
                    self._add_form(name, row, form, small, language)

    def _add_form(self, name: str, row: int, form: Form, small: frozenset[str], language: str) -> None:
        speech, plain = self.speech, form.plain
        if not plain:
            form = form._replace(parts=tuple(_spoken(part, language) for part in form.parts))
        words = speech.same(form.literals)
        strength = len(words) - sum(word in speech.fillers.single for word in words)
        entry = Entry(
            name,
            row,
            strength,
            alone=form.whole or (plain and small.issuperset(words)),
            negative=speech.negations.are_in(words) or speech.negations_after.are_in(words),
            question=speech.questions.are_in(words) or speech.questions_anywhere.are_in(words),
            anyhow=name in self.anyhow,
        )
        parts: Sequence[str | Slot] = words
        if not plain:
            parts = [p for part in form.parts for p in ((part,) if isinstance(part, Slot) else speech.same((part,)))]
        if not words:
            self.slots_only.append((form, entry))
        elif isinstance(parts[0], Slot):
            node: _Node = {}
            _insert(node, parts, entry)
            self.leading.append((frozenset(words), node))
        else:
            _insert(self.root, parts, entry)

    def read(self, text: str) -> ReadSentence:
        """Read a text and find all forms in it, except those that consist of slots only."""
        reading = ReadSentence(text, self.speech)
        words, root = reading.words, self.root
        for start, word in enumerate(words):
            if word in root:
                self._walk(reading, root[word], start + 1, start, (), 0, reading.finds)
        if self.leading:
            known = frozenset(words)
            for needed, node in self.leading:
                if needed <= known:
                    for start in range(len(words)):
                        self._walk(reading, node, start, start, (), 0, reading.finds)
        return reading

    def slotted(self, reading: ReadSentence) -> dict[str, list[Find]]:
        """Return the forms in a text that consist of slots only, by name."""
        if reading.slotted is None:
            found: dict[str, list[Find]] = {}
            reading.slotted = found
            for form, entry in self.slots_only:
                node: _Node = {}
                _insert(node, form.parts, entry)
                for start in range(len(reading.words)):
                    if start == 0 or reading.clauses[start] != reading.clauses[start - 1] or reading.filler[start - 1]:
                        self._walk(reading, node, start, start, (), 0, found)
        return reading.slotted

    def _walk(
        self,
        reading: ReadSentence,
        node: _Node,
        position: int,
        start: int,
        caught: tuple[tuple[str, Any], ...],
        more: int,
        found: dict[str, list[Find]],
    ) -> None:
        words, filler, count = reading.words, reading.filler, len(reading.words)
        reading.walks += 1
        if reading.walks > _MAX_WALKS:
            return
        while True:
            for entry in node.get(_ENDS, ()):
                several = found.setdefault(entry.name, [])
                if len(several) < _MAX_FINDS:
                    several.append(Find(entry, start, position, caught, entry.strength + more))
            for slot, then in node.get(_SLOTS, ()):
                begin = position
                while begin < count and filler[begin]:
                    begin += 1
                if begin < count:
                    for end, value, strength in self._catch(reading, slot, begin, last=not then.keys() - {_ENDS}):
                        self._walk(reading, then, end, start, (*caught, (slot.name, value)), more + strength, found)
            while position < count:
                if (after := node.get(words[position])) is not None:
                    node, position = after, position + 1
                    break
                if not filler[position]:
                    return
                position += 1
            else:
                return

    def _catch(self, reading: ReadSentence, slot: Slot, start: int, *, last: bool) -> Iterator[tuple[int, Any, int]]:
        """Yield the end, value and strength of each catch of a slot: the longest first, but of `text` the shortest."""
        match slot.type:
            case "name" | "name?":
                careful, small = slot.type == "name?", self.speech.small
                if not careful:
                    small = self.speech.small_words.get(slot.language, small)
                for end in self._names(reading, start, small, careful=careful, last=last):
                    yield end, reading.said(start, end), 0
            case "number":
                value, end = self.speech.number(reading.words, start)
                if end > start:
                    yield end, value, 0
            case "text":
                for end in [len(reading.words)] if last else range(start + 1, len(reading.words) + 1):
                    yield end, reading.text[reading.spans[start][0] : _text_end(reading, end)], 0
            case kind:
                node, position = self.lists.get(kind, {}), start
                found: list[tuple[int, Any, int]] = []
                while position < len(reading.words) and (after := node.get(reading.words[position])) is not None:
                    node, position = after, position + 1
                    found += [(position, value, strength) for value, strength in node.get(_ENDS, ())[:1]]
                yield from reversed(found[-1:] if last else found)

    def _names(
        self, reading: ReadSentence, start: int, small: frozenset[str], *, careful: bool, last: bool
    ) -> Iterator[int]:
        """Yield the ends of a name that begins at a word, the longest first: one to four words of one clause."""
        ends = self._name_ends(reading, start, small, careful=careful)
        yield from reversed(ends[-1:] if last else ends)

    def _name_ends(self, reading: ReadSentence, start: int, small: frozenset[str], *, careful: bool) -> list[int]:
        words, speech, capitals = reading.words, self.speech, _has_capitals(reading)
        found: list[int] = []
        several = False
        for position in range(start, min(start + MAX_NAME_WORDS, len(words))):
            word, said = words[position], reading.text[slice(*reading.spans[position])]
            capital = said[:1].isupper()
            if reading.clauses[position] != reading.clauses[start] or reading.filler[position] or word.isdecimal():
                break
            if position > start and reading.spans[position] == reading.spans[position - 1]:
                break  # the rest of a contraction
            particle = word in _PARTICLES and position + 1 < len(words) and position > start
            if capitals and not (capital or particle or said.upper() == said.lower()):  # a script without capitals
                break
            if position > start and not particle and not (capitals and capital and word not in speech.name_ends):
                if self._is_no_name(word, speech, small):
                    break
            elif position == start:
                follows = position + 1 < len(words) and reading.clauses[position + 1] == reading.clauses[start]
                several = capitals and capital and follows and _begins_with_capital(reading, position + 1)
                if not (capitals and capital and not careful) and self._refused(
                    word, speech, small, careful=careful, several=several
                ):
                    break
            if not particle:
                found.append(position + 1)
        return [end for end in found if not careful or self._is_sure(reading, start, end, small, several=several)]

    def _refused(self, word: str, speech: Speech, small: frozenset[str], *, careful: bool, several: bool) -> bool:
        """Return whether no name can begin with a word; several capitalised words can be one, as in "Happy Salma"."""
        if word in small or word in speech.negations or word in speech.questions:
            return True
        return careful and not several and (word in speech.not_names or word in speech.name_ends)

    def _is_no_name(self, word: str, speech: Speech, small: frozenset[str]) -> bool:
        return (
            word in small or word in speech.name_ends or word in speech.negations or word in speech.questions
            or word in speech.not_names or word in speech.contrasts
        )  # fmt: skip

    def _is_sure(self, reading: ReadSentence, start: int, end: int, small: frozenset[str], *, several: bool) -> bool:
        words = tuple(reading.words[start:end])
        if words in self.phrases or (len(words) == 1 and reading.text[reading.spans[start][1] :].lstrip()[:1] == "?"):
            return False
        speech = self.speech
        if speech.not_names.length(words, 0) == len(words) and not several:
            return False
        return several or not any(self._is_no_name(word, speech, small) for word in words if word not in _PARTICLES)


def _spoken(part: str | Slot, language: str) -> str | Slot:
    return part._replace(language=language) if isinstance(part, Slot) else part


def _insert(root: _Node, parts: Sequence[str | Slot], entry: Any) -> None:
    node = root
    for part in parts:
        if isinstance(part, Slot):
            slots = node.setdefault(_SLOTS, [])
            known = [then for slot, then in slots if slot == part]
            node = known[0] if known else _appended(slots, part)
        else:
            node = node.setdefault(part, {})
    node.setdefault(_ENDS, []).append(entry)


def _appended(slots: list[tuple[Slot, _Node]], slot: Slot) -> _Node:
    node: _Node = {}
    slots.append((slot, node))
    return node


def _has_capitals(reading: ReadSentence) -> bool:
    """Return whether a text has capitals, apart from "I" and the first words of clauses."""
    found = reading.kept.get("capitals")
    if found is None:
        text, spans, clauses = reading.text, reading.spans, reading.clauses
        found = reading.kept["capitals"] = any(
            text[start].isupper() and text[start:end] not in ("I", "I'm", "I’m", "Im")
            for i, (start, end) in enumerate(spans)
            if i and clauses[i] == clauses[i - 1] and spans[i] != spans[i - 1]
        )
    return bool(found)


def _begins_with_capital(reading: ReadSentence, position: int) -> bool:
    return reading.text[reading.spans[position][0]].isupper() and reading.words[position] not in ("i",)


def _text_end(reading: ReadSentence, end: int) -> int:
    return len(reading.text.rstrip()) if end == len(reading.words) else reading.spans[end - 1][1]
