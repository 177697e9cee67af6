"""The rows of `hears` of a behaviour: which of them match a sentence, in which order, and what their slots catch."""

from collections import OrderedDict
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple

from lumen.language.json_paths import value_at
from lumen.language.machines import Answer, Hears, MachineDefinition
from lumen.talk.finder import Find, Finder, ReadSentence
from lumen.talk.patterns import Form, Slot, forms
from lumen.talk.speech import WORD_LISTS, Speech
from lumen.upkeep.garbage import gc_paused

HEARD = "heard"
"""The event that rows of `hears` wait for; its text is `event.data.result`."""
ALWAYS = ("text", "phrase", "answer")
"""The keys of `heard` that every row has."""
MATCHER = 1
"""The version of the rules by which a row is chosen for a sentence; journals record it."""
_MAX_READINGS = 64
ENTRY = "context."
"""The prefix of a name that is the path, in the context, of the phrases of a list's entry."""

Dropped = Literal["", "negated", "not negated", "part", "question", "no question", "refusal"]
"""Why a find does not count for a row; empty if it counts."""


class Taken(NamedTuple):
    """A row that may be taken for a sentence: its number, and the find for it, which `else` lacks."""

    number: int
    find: Find | None = None


class RowOrder(NamedTuple):
    """The rows of a state that may be taken for a sentence, the best first.

    Those in `late`, rows of slots only and then `else`, count only if no state has taken another row.
    """

    first: tuple[Taken, ...]
    late: tuple[Taken, ...]


def said_in(event: Any) -> str:
    """Return the text of an event, which is given as expressions see it; empty if the event has no text."""
    try:  # this runs for each row, and is faster than checking the types first
        text = event["data"]["result"]
    except (KeyError, TypeError):
        return ""
    return text if isinstance(text, str) else ""


class Hearing:
    """The phrases and answers of a behaviour, and the rows of its states."""

    def __init__(self, machine: MachineDefinition) -> None:
        self.machine = machine
        self.speech = Speech(machine.phrases, machine.answers)
        self.rows: dict[int, Hears] = {}
        self.blocks: dict[int, tuple[Hears, ...]] = {}
        for state in machine.states.values():
            block = tuple(t.hears for t in state.transitions if t.hears)
            self.rows |= {row.number: row for row in block}
            self.blocks |= dict.fromkeys([row.number for row in block], block)
        heard = {name for row in self.rows.values() for name in row.names}
        self.finder = Finder(
            self.speech,
            {name: table for name, table in machine.phrases.items() if name in heard},
            {name: [row.phrases for row in rows] for name, rows in machine.answers.items() if name in heard},
            {name: [(phrases_in(entry), entry) for entry in entries] for name, entries in machine.lists.items()},
            machine.anyhow,
            [table for name, table in machine.phrases.items() if name not in heard and name not in WORD_LISTS],
        )
        self._readings: OrderedDict[str, ReadSentence] = OrderedDict()
        self._finders: dict[int, tuple[Any, Finder]] = {}

    def read(self, text: str) -> ReadSentence:
        """Read a text; the results for the last texts are cached."""
        reading = self._readings.get(text)
        if reading is None:
            reading = self._readings[text] = self.finder.read(text)
            if len(self._readings) > _MAX_READINGS:
                self._readings.popitem(last=False)
        return reading

    def order(self, number: int, text: str, context: Mapping[str, Any]) -> RowOrder:
        """Return the rows that may be taken for a text, of the state to which the row of this number belongs."""
        reading = self._readings.get(text) or self.read(text)
        found: RowOrder | None = reading.kept.get(number)
        if found is None:
            block = self.blocks[number]
            found = self._order(reading, block, context)
            if not any(name.startswith(ENTRY) for row in block for name in row.names):
                reading.kept.update(dict.fromkeys([row.number for row in block], found))
        return found

    def caught(self, number: int, event: Any, context: Mapping[str, Any], language: str) -> dict[str, Any]:
        """Return the value of `heard` for a row: the text, the phrase as it was said, the answer, and the slots."""
        text = said_in(event)
        order = self.order(number, text, context)
        find = next((taken.find for taken in (*order.first, *order.late) if taken.number == number), None)
        found: dict[str, Any] = {"text": text, "phrase": "", "answer": None}
        if find:
            found["phrase"] = self.read(text).said(find.start, find.end)
            if find.entry.name in self.machine.answers:
                rows = self.machine.answers[find.entry.name]
                found["answer"] = in_language(rows[find.entry.row].value, language, languages_of(rows))
            found.update(find.caught)
        return found

    def nearest(self, number: int, text: str, context: Mapping[str, Any]) -> tuple[Find, Dropped] | None:
        """Return the best find for that row, and why it does not count (empty if it does).

        A find that counts is preferred to one that does not. The result is None if nothing was found.
        """
        reading, row, asked = self.read(text), self.rows[number], asked_in(self.blocks[number])
        find = self.best(reading, row, asked, context) or self.best(reading, row, asked, context, counting=False)
        if find is None:
            return None
        order = self.order(number, text, context)
        counts = any(one.number == number for one in (*order.first, *order.late))
        return find, dropped(reading, find, row.way, find.entry.name in asked) or ("" if counts else "refusal")

    def _order(self, reading: ReadSentence, block: Sequence[Hears], context: Mapping[str, Any]) -> RowOrder:
        asked = asked_in(block)
        found = {row.number: self.best(reading, row, asked, context) for row in block if reading.words}
        refused = {reading.negation(find) for row in block if row.way == "not" and (find := found.get(row.number))}
        first: list[tuple[int, Taken]] = []
        late: list[Taken] = []
        otherwise: list[Taken] = []
        for row in block:
            find = found.get(row.number)
            if row.way == "else":
                otherwise.append(Taken(row.number))
            elif find is None or (row.way != "not" and not refused.isdisjoint(range(find.start, find.end))):
                continue  # "I don't want" is no reason for `no` if what is not wanted is said
            elif find.strength:
                first.append((-find.strength, Taken(row.number, find)))
            else:
                late.append(Taken(row.number, find))
        first.sort(key=lambda one: one[0])
        return RowOrder(tuple(taken for _, taken in first), (*late, *otherwise))

    def best(
        self, reading: ReadSentence, row: Hears, asked: set[str], context: Mapping[str, Any], *, counting: bool = True
    ) -> Find | None:
        """Return the strongest find for a row; of equals, that of the upper answer, then the last. None without finds.

        Only finds that count are considered, unless `counting` is false.
        """
        best: Find | None = None
        rank = (-1, 0, 0, 0)
        for name in row.names:
            for find in self._finds(reading, name, context):
                its = (find.strength, -find.entry.row, find.end, -find.start)
                if its > rank and not (counting and dropped(reading, find, row.way, name in asked)):
                    best, rank = find, its
        return best

    def _finds(self, reading: ReadSentence, name: str, context: Mapping[str, Any]) -> Iterator[Find]:
        if name.startswith(ENTRY):
            found = self._entry_finder(name, context)
            if found is None:
                return
            other = found.read(reading.text)
            reading.finds[name] = other.finds.get(name, [])
            yield from reading.finds[name]
            yield from found.slotted(other).get(name, ())
            return
        finds = reading.finds.get(name, ())
        yield from finds
        if not any(find.strength for find in finds) and self.finder.slots_only:
            yield from self.finder.slotted(reading).get(name, ())

    def entry(self, path: str, context: Mapping[str, Any]) -> Any:
        """Return the phrases at a path of the context, such as `context.round.entry.right`; None if there are none."""
        table = value_at(context, path.split(".")[1:])
        return table if isinstance(table, str | list | tuple | Mapping) else None

    def _entry_finder(self, path: str, context: Mapping[str, Any]) -> Finder | None:
        """Return a finder of the phrases at a path of the context; None if there are none."""
        table = self.entry(path, context)
        if table is None:
            return None
        kept = self._finders.get(id(table))
        if kept is None or kept[0] is not table:
            if len(self._finders) >= _MAX_READINGS:
                self._finders.clear()
            kept = self._finders[id(table)] = table, Finder(self.speech, {path: by_language(table)})
        return kept[1]


def dropped(reading: ReadSentence, find: Find, way: str, asks: bool) -> Dropped:
    """Return why a find does not count for a row of that `way`; empty if it counts.

    `asks` is whether a row of the state accepts questions for the find's name.
    """
    if reading.negation(find) is not None:
        return "" if way == "not" else "negated"
    if way == "not":
        return "not negated"
    if find.entry.alone and not reading.is_whole(find):
        return "part"
    if asks and reading.is_asked(find):
        return "" if way == "asked" else "question"
    return "no question" if way == "asked" else ""


def asked_in(block: Sequence[Hears]) -> set[str]:
    """Return the names for which rows of a state accept questions."""
    return {name for row in block if row.way == "asked" for name in row.names}


def hearing_of(machine: MachineDefinition) -> Hearing:
    """Return the `Hearing` of a machine, which is made when it is first needed and kept with the machine."""
    found: Hearing | None = machine.__dict__.get("_hearing")
    if found is None:
        with gc_paused():  # nothing that is made here is garbage
            found = Hearing(machine)
        object.__setattr__(machine, "_hearing", found)  # frozen, and the same for all who hold it
    return found


def always_caught(machine: MachineDefinition, row: Hears) -> frozenset[str]:
    """Return the keys that `heard` has whenever a row is taken, without slots that some of its forms lack."""
    found = [frozenset(slot.name for slot in form.parts if isinstance(slot, Slot)) for form in _forms(machine, row)]
    return frozenset(ALWAYS).union(frozenset.intersection(*found) if found else ())


def _forms(machine: MachineDefinition, row: Hears) -> Iterator[Form]:
    for name in row.names:
        tables = [machine.phrases[name]] if name in machine.phrases else []
        tables += [one.phrases for one in machine.answers.get(name, ())]
        yield from (form for table in tables for texts in table.values() for text in texts for form in forms(text))


def by_language(value: Any) -> dict[str, tuple[str, ...]]:
    """Return phrases by language, given as a text, a list of texts, or a map of texts or lists by language."""
    table = value if isinstance(value, Mapping) else {"": value}
    rows = {key: (row,) if isinstance(row, str) else tuple(row or ()) for key, row in table.items()}
    return {key: tuple(text for text in row if isinstance(text, str)) for key, row in rows.items()}


def phrases_in(entry: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    """Return the `phrases` of a list's entry by language, by which a slot with the list's name catches the entry."""
    value = entry.get("phrases")
    return by_language(value) if isinstance(value, str | list | tuple | Mapping) else {}


def languages_of(rows: Sequence[Answer]) -> frozenset[str]:
    """Return the languages in which a table of answers has phrases."""
    return frozenset(language for row in rows for language in row.phrases)


def in_language(value: Any, language: str, languages: frozenset[str]) -> Any:
    """Return the value for a language in a map of languages, else the first; return any other value unchanged."""
    if not isinstance(value, Mapping) or not value or not value.keys() <= languages | {language}:
        return value
    return value[language] if language in value else next(iter(value.values()))
