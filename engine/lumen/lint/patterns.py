"""Phrases as patterns: invalid patterns, patterns written for other tools, and slots that nothing can fill."""

import re
from collections.abc import Iterator
from functools import partial

from lumen.language.diagnostics import WARNING, Code, NodePath, did_you_mean
from lumen.language.machines import MachineDefinition
from lumen.lint.word_tables import WordTables, WrittenPhrase, known_by, slot_place, word_tables, written_phrases
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.expressions import place_within
from lumen.talk.folding import folded
from lumen.talk.hearing import phrases_in
from lumen.talk.patterns import TYPES, PatternError, Slot, read_pattern, slots_of
from lumen.talk.speech import TABLES, WORD_LISTS

BAD_PATTERN = Code("bad-pattern", "hearing", WARNING, "a phrase is not a valid pattern, so it is read as plain words")
DEAD_SLOT = Code("dead-slot", "hearing", WARNING, "a slot of a phrase can never catch anything")
FOREIGN_PATTERN = Code("foreign-pattern", "hearing", WARNING, "a phrase uses the syntax of another tool")

_SIGNS = re.compile(r"[()\[\]{}|<>/\\*^$@%,;\n]")
"""A phrase without any of these characters has none of the faults reported here."""

_PATTERN_SIGNS = re.compile(r"[()\[\]{}|]")
_MIN_PARTS = 3
"""The minimum number of parts between commas that count as alternatives; fewer parts can be a sentence."""
_SAME_BEGINNING = 3
"""The number of equal first letters from which two words count as forms of one word: "dance, dancing"."""

_MAX_TORN = 10
"""The maximum number of phrases before and after a phrase that are searched for the rest of a torn pattern."""

_FOREIGN: tuple[tuple[re.Pattern[str], str, str], ...] = (
    (
        re.compile(r"\[[^\[\]]*\]\([^()]*\)"),
        "`{}` marks an entity in Rasa; here it means an optional word followed by a group",
        "write a slot instead: {{name}}, {{number}}, {{text}} or the name of a list",
    ),
    (
        re.compile(r"<[^<>]*>"),
        "`{}` is a rule of another tool; here it is plain words",
        "write {{name}}, {{number}}, {{text}} or {{LIST}} for a slot, or (one|other) for alternatives",
    ),
    (
        re.compile(r"(?<!\S)(?:[$@][A-Za-z_]\w*|%\w+%)"),
        "`{}` is a variable of another tool; here it is a plain word",
        "write {{name}}, {{number}}, {{text}} or {{LIST}} for a slot",
    ),
    (
        re.compile(r"\(\?|\\[A-Za-z.?]|\.[*+]|^\^|(?<=\S)\$$"),
        "phrases are not regular expressions: `{}` has no meaning here",
        "write the words themselves; (one|other) are alternatives, and [this] is optional",
    ),
    (
        re.compile(r"\*"),
        "`{}` is not a wildcard here",
        "delete it: a phrase matches anywhere in a sentence, and {{text}} catches the rest of the sentence",
    ),
    (
        re.compile(r"(?:^|(?<=\s))/\w+/?"),
        "`{}` is not a command here: the slash is ignored",
        "write the words without slashes",
    ),
)
"""The syntax of other tools, each with a message and a hint."""

_SLASH = re.compile(r"(?P<one>[^\W\d]+)\s?/\s?(?P<other>[^\W\d]+)")


def check(draft: ProjectDraft) -> None:
    """Report broken patterns, patterns of other tools, and dead slots in the phrases of the project."""
    for tables in word_tables(draft):
        report = tables.report
        report.memoize(("patterns", report.document.file), None, partial(_read, tables))
        users = known_by(draft, report)
        for phrase in _all(tables):
            if "{" in phrase.text:
                _slots(phrase, [draft.behaviors[user] for user in users])


def _all(tables: WordTables) -> Iterator[WrittenPhrase]:
    """Yield every phrase of a file except those of word lists."""
    paths: list[NodePath] = [("phrases", name) for name in tables.phrases if name not in WORD_LISTS]
    paths += [
        ("answers", name, i, "phrases")
        for name, rows in tables.answers.items()
        if name not in TABLES
        for i in range(len(rows))
    ]
    paths += [("lists", name, i, "phrases") for name, entries in tables.lists.items() for i in range(len(entries))]
    for path in paths:
        yield from written_phrases(tables.report, path)


def _read(tables: WordTables) -> None:
    for phrase in _all(tables):
        if _SIGNS.search(phrase.text):
            try:
                read_pattern(phrase.text)
            except PatternError as error:
                _bad(phrase, error)
            else:
                _foreign(phrase)
    for name in tables.phrases.keys() & {*WORD_LISTS}:
        for phrase in written_phrases(tables.report, ("phrases", name)):
            if found := _PATTERN_SIGNS.search(phrase.text):
                message = f"`{name}` is a list of words, so `{found[0]}` has no meaning in it"
                _say(BAD_PATTERN, phrase, found.start(), 1, message, "write each word as a separate entry")


def _bad(phrase: WrittenPhrase, error: PatternError) -> None:
    """Report a phrase that is not a valid pattern; the parts of a pattern that a comma splits share one cause."""
    hint, cause = f"{error.hint}; until then, the phrase is read as plain words", ""
    if (torn := _torn(phrase)) is not None:
        cause = f"{phrase.report.document.file} torn {torn}"
        hint = "write `|` between alternatives: in a list in brackets, a comma ends the phrase"
    _say(BAD_PATTERN, phrase, error.offset, error.length, error.message, hint, cause)


def _torn(phrase: WrittenPhrase) -> NodePath | None:
    """Return the path of the phrase that opens a bracket across several phrases.

    It is this phrase or an earlier one, and this or a later one closes the bracket; None without such phrases.
    """
    *around, place = phrase.path
    if not isinstance(place, int):
        return None
    near = range(max(place - _MAX_TORN, 0), place + _MAX_TORN + 1)
    texts = [(i, text) for i in near if isinstance(text := phrase.report.document.find((*around, i)), str)]
    left_open = [(i, sum(map(text.count, "([")) - sum(map(text.count, ")]"))) for i, text in texts]
    begun = [i for i, more in left_open if more > 0 and i <= place]
    closed = [i for i, more in left_open if more < 0 and i >= place]
    return (*around, begun[-1]) if begun and closed else None


def _foreign(phrase: WrittenPhrase) -> None:
    text = phrase.text
    for pattern, message, hint in _FOREIGN:
        if found := pattern.search(text):
            said = message.format(found[0])
            _say(FOREIGN_PATTERN, phrase, found.start(), len(found[0]), said, hint.format())
            return
    if found := _SLASH.search(text):
        message = f"`{found[0]}` matches only the two words together: `/` does not separate alternatives"
        hint = f"write `({found['one']}|{found['other']})`, or a phrase for each"
        _say(FOREIGN_PATTERN, phrase, found.start(), len(found[0]), message, hint)
    elif sign := _separator(phrase):
        parts = [part.strip().removeprefix("- ") for part in text.split(sign)]
        shown = ", ".join(f'"{part}"' if "," in part else part for part in parts if part)
        named = "a line break" if sign == "\n" else f"`{sign}`"
        message = f"this is one phrase: {named} does not separate phrases"
        _say(FOREIGN_PATTERN, phrase, text.index(sign), 1, message, f"write separate phrases: [{shown}]")


def _separator(phrase: WrittenPhrase) -> str:
    """Return the character that separates alternatives in one text; empty if the text is a single phrase.

    A single comma in an entry of a list can belong to a sentence, because the author already separates phrases by the
    list.
    """
    text = phrase.text
    if "\n" in text.strip():
        return "\n"
    if ";" in text:
        return ";"
    if "," in text and not isinstance(phrase.path[-1], int) and not _PATTERN_SIGNS.search(text):
        return ","
    parts = [" ".join(folded(part)) for part in text.split(",")]
    if len(parts) == 1 or not all(parts):
        return ""
    forms_of_one = len(parts) == 2 and len({part[:_SAME_BEGINNING] for part in parts}) == 1
    return "," if len(parts) >= _MIN_PARTS or forms_of_one else ""


def _slots(phrase: WrittenPhrase, machines: list[MachineDefinition]) -> None:
    """Report slots of a phrase that can catch nothing in any one of `machines`, the behaviours that use the phrase."""
    listed = phrase.path[0] == "lists"
    for slot in slots_of(phrase.text):
        faults = (_fault(slot, machine) for machine in machines)
        if listed:
            fault: tuple[str, str] | None = (
                f"`{slot.type}` catches nothing: the phrases of a list entry can't have slots",
                "write the words themselves",
            )
        else:
            fault = next((fault for fault in faults if fault), None)
        if fault:
            cause = f"{phrase.report.document.file} slot {slot.type}"
            phrase.report.diagnostics.append(DEAD_SLOT.at(slot_place(phrase, slot), *fault, cause=cause))


def _fault(slot: Slot, machine: MachineDefinition) -> tuple[str, str] | None:
    """Return the message and the hint for a slot that can catch nothing; None for any other slot."""
    if slot.type in TYPES:
        return None
    if slot.type not in machine.lists:
        message = f"`{slot.type}` is neither a type nor a list: the slot catches nothing"
        if slot.name in (*TYPES, *machine.lists):
            return message, f"write the type first: {{{slot.name}:{slot.type}}}"
        return message, did_you_mean(slot.type, (*TYPES, *machine.lists), "available:")
    if not any(phrases_in(entry) for entry in machine.lists[slot.type]):
        message = f"no entry of the list `{slot.type}` has `phrases`: the slot catches nothing"
        return message, "give each entry `phrases` with the words that visitors use for it"
    return None


def _say(code: Code, phrase: WrittenPhrase, offset: int, length: int, message: str, hint: str, cause: str = "") -> None:
    report: DocumentReport = phrase.report
    place = place_within(report.document, phrase.path, phrase.text, offset, length)
    report.diagnostics.append(code.at(place, message, hint, cause=cause))
