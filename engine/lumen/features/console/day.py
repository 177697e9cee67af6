"""A day of an exhibition: its visits, and the statistics that a museum needs."""

import csv
import io
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import date, datetime
from typing import Any, NamedTuple

from lumen.features.console.entry_words import ENDS, ENGLISH, MARK, OFTEN
from lumen.features.console.heard_sentences import HeardSentence, heard_sentence
from lumen.insight.replay.entries import JournalInput, JournalJump, RecordedEntry
from lumen.insight.replay.journal_clock import JournalClock
from lumen.insight.replay.replaying import MachineSource, ReplayedStep, Replayer
from lumen.insight.replay.visits import VisitWatch
from lumen.journal.happenings import FALLEN
from lumen.language.command_data import started
from lumen.language.iso_time import iso_time
from lumen.language.modules import VISITOR_KEY

HEARD = "heard"
MAX_TEXT = 200
MAX_STRETCH = 1_000
"""The maximum length of a stretch between two visits [entries]."""
MAX_ROWS = 1_000
"""The maximum number of rows per list in the JSON."""


@dataclass
class DayVisit:
    """A visit to the robot on one day."""

    number: int
    """The visit's number on that day, from 1."""
    first: int
    """The position of the visit's first entry in the journal."""
    last: int
    """The position of the last entry so far."""
    began: float
    """The time of the first entry [s since 1970]."""
    ended: float
    """The time of the last entry so far [s since 1970]."""
    visitor: str = ""
    """The visitor's name, empty if unknown."""
    language: str = ""
    """The language of the robot's last speech, empty if unknown."""
    asked: int = 0
    """The number of sentences that were heard."""
    missed: int = 0
    """The number of heard sentences that were not understood, or had no answer."""

    def to_json(self) -> dict[str, Any]:
        seconds = round(self.ended - self.began, 1)
        return {
            "n": self.number, "from": self.first, "to": self.last,
            "began": iso_time(self.began), "ended": iso_time(self.ended), "seconds": seconds,
            "visitor": self.visitor or None, "language": self.language or None,
            "asked": self.asked, "missed": self.missed,
        }  # fmt: skip


class AwaitedAnswer(NamedTuple):
    """A question to the knowledge (`ask`) that has no answer so far."""

    text: str
    """The question."""
    language: str
    heard: str
    """The visitor's sentence that led to the question, in lower case; empty if unknown."""
    visit: DayVisit | None
    """The visit during which the question was asked; None outside visits."""


class DayMark(NamedTuple):
    """A mark that a person set."""

    position: int
    """The position of the mark's entry."""
    at: float
    """The time of the mark [s since 1970]."""
    text: str
    """The text of the mark."""
    by: str
    """The person who set the mark; empty if unknown."""

    def to_json(self) -> dict[str, Any]:
        return {"position": self.position, "at": iso_time(self.at), "text": self.text, "by": self.by}


@dataclass
class QuietStretch:
    """Consecutive entries outside visits."""

    first: int
    """The position of the first entry."""
    last: int
    """The position of the last entry."""
    began: float
    """The time of the first entry [s since 1970]."""
    ended: float
    """The time of the last entry [s since 1970]."""

    def to_json(self) -> dict[str, Any]:
        return {"from": self.first, "to": self.last, "began": iso_time(self.began), "ended": iso_time(self.ended)}


@dataclass
class Day:
    """The visits and statistics of one day, and the `dates` of all days that can be shown."""

    day: date
    dates: list[date]
    visits: list[DayVisit] = field(default_factory=list)
    between: list[QuietStretch] = field(default_factory=list)
    asked: Counter[str] = field(default_factory=Counter)
    """The sentences that were heard, in lower case."""
    missed: Counter[str] = field(default_factory=Counter)
    """The sentences that were not understood, or had no answer, in lower case."""
    answers: Counter[str] = field(default_factory=Counter)
    """The texts that the robot said."""
    languages: Counter[str] = field(default_factory=Counter)
    """The languages of the visits."""
    unanswered: Counter[tuple[str, str]] = field(default_factory=Counter)
    """Questions to the knowledge without an answer, each with its language."""
    said: Counter[HeardSentence] = field(default_factory=Counter)
    rows: dict[str, list[str]] = field(default_factory=dict)
    """The keys of the `hears` rows that each state could match, by its behaviour and name, separated by a blank."""
    asking: "dict[str, AwaitedAnswer]" = field(default_factory=dict)
    """Questions to the knowledge that may still be answered, by command id."""
    hours: Counter[int] = field(default_factory=Counter)
    """The number of visits that began in each hour of the day."""
    falls: int = 0
    marks: list[DayMark] = field(default_factory=list)

    def to_json(self) -> dict[str, Any]:
        """Return the day as JSON data; the lists in COUNTED are pairs of text and count, the most frequent first."""
        lengths = [visit.ended - visit.began for visit in self.visits]
        numbers: dict[str, Any] = {
            "visits": len(lengths),
            "mean_seconds": round(sum(lengths) / len(lengths), 1) if lengths else None,
            "longest_seconds": round(max(lengths), 1) if lengths else None,
            "falls": self.falls,
            "hours": sorted([hour, count] for hour, count in self.hours.items()),
        }
        numbers["unanswered"] = [
            {"text": text, "language": language, "count": count}
            for (text, language), count in self.unanswered.most_common(MAX_ROWS)
        ]
        said = sorted(self.said.items(), key=lambda row: (row[0].understood, -row[1]))[:MAX_ROWS]
        numbers["said"] = [{**sentence.to_json(), "count": count} for sentence, count in said]
        numbers["rows"] = self.rows
        rows = {name: getattr(self, name).most_common(MAX_ROWS) for name in COUNTED}
        return {
            "date": self.day.isoformat(),
            "dates": [one.isoformat() for one in self.dates],
            "visits": [visit.to_json() for visit in self.visits],
            "between": [stretch.to_json() for stretch in self.between],
            "marks": [mark.to_json() for mark in self.marks],
            "numbers": numbers | rows,
        }


COUNTED = ("asked", "missed", "answers", "languages")


def day_of(entries: Iterable[RecordedEntry], machines: MachineSource, wanted: date | None) -> Day:
    """Return the day `wanted` from a journal's entries, by the exhibition's clock; it is empty if it has none.

    None means the last day with visits, else the last with entries, else today.
    """
    clock, watch, replayer = JournalClock(), VisitWatch(), Replayer(machines)
    days: dict[date, Day] = {}
    visit: DayVisit | None = None
    behavior = ""
    for entry in entries:
        behavior = entry.behavior if isinstance(entry, JournalJump) else behavior
        at = clock.of(entry)
        here = clock.local(at)
        taken = replayer.take(entry)
        machine = taken.machine
        part = watch.take(entry, machine)
        today = days.setdefault(here.date(), Day(here.date(), []))
        if isinstance(entry, JournalJump) and MARK in entry.said:
            said = entry.said
            today.marks.append(
                DayMark(entry.position, at, str(said[MARK])[:MAX_TEXT], str(said.get("by", ""))[:MAX_TEXT])
            )
        if visit and (not part or (isinstance(entry, JournalJump) and entry.kind in ("start", "gap"))):
            visit = None
        if part and visit is None:
            visit = DayVisit(len(today.visits) + 1, entry.position, entry.position, at, at)
            today.visits.append(visit)
            today.hours[here.hour] += 1
        _count(today, visit, taken, behavior)
        if visit:
            visit.last, visit.ended = entry.position, at
            _name(visit, taken)
            if not watch.away:
                visit = None
        else:
            _lie_between(today, entry, at)
    for one in days.values():
        for id in list(one.asking):
            _unanswered(one, id)
        one.languages = Counter(visit.language for visit in one.visits if visit.language)
    dates = sorted(one for one, day in days.items() if day.visits) or sorted(days)
    chosen = wanted or (dates[-1] if dates else datetime.now().date())
    found = days.get(chosen) or Day(chosen, [])
    found.dates = dates
    return found


def _lie_between(day: Day, entry: RecordedEntry, at: float) -> None:
    """Add a visible entry to the current stretch; begin a new one after a visit or MAX_STRETCH entries."""
    if not _is_told(entry):
        return
    last = day.between[-1] if day.between else None
    after = day.visits[-1].last if day.visits else -1
    if last and last.first > after and entry.position - last.first < MAX_STRETCH:
        last.last, last.ended = entry.position, at
    else:
        day.between.append(QuietStretch(entry.position, entry.position, at, at))


def _is_told(entry: RecordedEntry) -> bool:
    """Return True if a page shows a line for the entry; keep this consistent with `text_of` in `entry_words`."""
    if isinstance(entry, JournalJump):
        return bool(entry.said or ENGLISH.jump(entry.kind))
    if entry.entered or entry.commands:
        return True
    return entry.event.name not in OFTEN and not entry.event.name.startswith(ENDS)


def _count(day: Day, visit: DayVisit | None, taken: ReplayedStep, behavior: str) -> None:
    """Count falls, the visitor's sentences, those not understood, and the robot's answers; skip redacted entries."""
    entry = taken.entry
    if not isinstance(entry, JournalInput) or entry.redacted:
        return
    day.falls += entry.event.name == FALLEN
    text = entry.event.data.get("result") if isinstance(entry.event.data, Mapping) else None
    asked = entry.how == HEARD and isinstance(text, str) and text.strip()
    if asked:
        words = " ".join(str(text).lower().split())[:MAX_TEXT]
        day.asked[words] += 1
        asks = any((begun := started(command)) and begun[1] == "Ask" for command in entry.commands)
        missed = not asks and not understood(entry, taken)
        if missed:
            day.missed[words] += 1
        if entry.event.name == HEARD and (found := heard_sentence(behavior, taken, str(text)[:MAX_TEXT])):
            day.said[found[0]] += 1
            day.rows |= found[1]
        if visit:
            visit.asked += 1
            visit.missed += missed
    _ask(day, visit, entry)
    for command in entry.commands:
        if (begun := started(command)) and begun[1] == "Say":
            day.answers[str(begun[2].get("text", ""))[:MAX_TEXT]] += 1
            if visit:
                visit.language = str(begun[2].get("language") or visit.language)


def _ask(day: Day, visit: DayVisit | None, entry: JournalInput) -> None:
    """Track questions to the knowledge until they are answered; a reused id leaves its earlier one unanswered."""
    kind, _, id = entry.event.name.partition(".command.")
    data = entry.event.data if isinstance(entry.event.data, Mapping) else {}
    if kind == "answer" and not data.get("filler"):
        day.asking.pop(id, None)
    heard = " ".join(str(data.get("result", "")).lower().split())[:MAX_TEXT]
    for command in entry.commands:
        if (found := started(command)) and found[1] == "Ask":
            _unanswered(day, found[0])
            said = found[2]
            text, language = (str(said.get(name, "")) for name in ("question", "language"))
            day.asking[found[0]] = AwaitedAnswer(text[:MAX_TEXT], language, heard, visit)


def _unanswered(day: Day, id: str) -> None:
    if one := day.asking.pop(id, None):
        day.unanswered[one.text, one.language] += 1
        if one.heard:
            day.missed[one.heard] += 1
        if one.visit:
            one.visit.missed += 1


def understood(entry: JournalInput, taken: ReplayedStep) -> bool:
    """Return True if the behaviour reacted to a visitor's sentence with more than a fallback.

    A fallback is the row `else` of `hears`, or a transition without a guard in a state that has another transition for
    the same event with a guard. If no transition is known, any state change or command counts as a reaction.
    """
    if taken.step is None or taken.machine is None:
        return bool(entry.entered or entry.exited or entry.commands)
    transitions = taken.step.transitions
    if not transitions:
        return bool(entry.entered or entry.exited or entry.commands)
    for one in transitions:
        state = taken.machine.states.get(one.source)
        others = state.transitions if state else ()
        fallback = one.guard is None and any(o.event == one.event and o.guard is not None for o in others)
        if one.hears:
            fallback = one.hears.way == "else"
        if one.event and not fallback:
            return True
    return False


def _name(visit: DayVisit, taken: ReplayedStep) -> None:
    snapshot = taken.after
    name = snapshot.context.get(VISITOR_KEY) if snapshot else None
    if isinstance(name, str) and name and not taken.entry.redacted:
        visit.visitor = name[:MAX_TEXT]


RISKY = ("=", "+", "-", "@", "\t", "\r")
"""Text that begins with one of these gets an apostrophe, because a spreadsheet would read it as a formula."""


def day_csv(day: Day) -> str:
    """Return CSV with the columns `date`, `what`, `name` and `value`: the visits, then the day's statistics."""
    told, text = day.to_json(), io.StringIO()
    write = csv.writer(text)
    write.writerow(["date", "what", "name", "value"])
    for visit in told["visits"]:
        for key in ("began", "ended", "seconds", "visitor", "language", "asked", "missed"):
            write.writerow([told["date"], f"visit {visit['n']}", key, _cell(visit[key])])
    numbers: dict[str, Any] = told["numbers"]
    for key in ("visits", "mean_seconds", "longest_seconds", "falls"):
        write.writerow([told["date"], "day", key, _cell(numbers[key])])
    for key in ("hours", *COUNTED):
        for name, count in numbers[key]:
            write.writerow([told["date"], key, _cell(name), count])
    for one in numbers["unanswered"]:
        write.writerow([told["date"], "unanswered", _cell(one["text"]), one["count"]])
    return text.getvalue()


def _cell(value: object) -> str:
    text = "" if value is None else str(value)
    return f"'{text}" if text.startswith(RISKY) else text
