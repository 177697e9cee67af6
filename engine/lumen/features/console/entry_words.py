"""Lines of text for journal entries in each page language, and the kinds of entries."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any

from lumen.insight.replay.entries import HOWS
from lumen.language.command_data import started
from lumen.language.events import CLOCK_SET, HELD

MAX_TEXT = 300
SAYS, DOES, STATE = "says", "does", "state"
ERROR = "error."
PERSON = "person"
MARK, NOTE = "mark", "note"
OFTEN, ENDS = ("face", CLOCK_SET), ("done.command.", "cancelled.command.", "lost.command.")
"""Frequent events, and prefixes of events that follow each command: shown only if they have an effect."""


@dataclass(frozen=True)
class EntryPhrases:
    """The phrases for lines about entries in one language; `{}` is a placeholder."""

    says: str = "says “{}”"
    heard: str = "heard “{}”"
    plays: str = "plays {}"
    by: str = "{}, by {}"
    sent: str = "sent to {}"
    late: str = "time is up"
    refused: str = "refused"
    mark: str = "mark"
    start: str = "the behaviour begins"
    reload: str = "other files are active from now on"
    rollback: str = "the previous files are active again"
    resume: str = "the behaviour continues where the last run ended"
    forget: str = "a visitor is forgotten"
    dropped_timer: str = "a timer is dropped"
    dropped_event: str = "an event is dropped"
    gap: str = "some entries are lost"
    keyframe: str = ""
    code: str = "en"

    def deed(self, kind: str) -> str:
        """Return the phrase for a non-speech command by its class name, or that name in lower case if there is none."""
        return DEEDS.get(self.code, {}).get(kind, kind.lower())

    def person(self, by: str) -> str:
        """Return a person's label on a page: a name unchanged, a role in the page's language."""
        return PEOPLE.get(self.code, {}).get(by, by)

    def jump(self, kind: str) -> str:
        """Return the phrase for a jump of that kind, or the kind itself if there is none."""
        name = kind.replace(" ", "_")
        return str(getattr(self, name)) if name in KNOWN else kind


DEEDS: Mapping[str, Mapping[str, str]] = {
    "id": {
        "Play": "gerakan", "Posture": "sikap tubuh", "GoTo": "berjalan ke", "Walk": "berjalan", "Move": "bergerak",
        "Look": "menoleh", "Leds": "lampu", "Volume": "volume", "PlaySound": "memutar suara",
        "Track": "mengikuti wajah", "Stop": "berhenti", "Rest": "beristirahat",
        "Wake": "bangun", "Language": "bahasa", "Ask": "bertanya",
    },
}  # fmt: skip
PEOPLE: Mapping[str, Mapping[str, str]] = {
    "id": {"author": "penulis", "show": "peragaan", "a person at the console": "seseorang di konsol"},
}
KNOWN = frozenset(field.name for field in fields(EntryPhrases))
ENGLISH = EntryPhrases()
OTHERS = {
    "id": EntryPhrases(
        says="berkata “{}”", heard="mendengar “{}”", plays="memainkan {}", by="{}, oleh {}",
        sent="dikirim ke {}", late="waktu habis", refused="ditolak", mark="tanda", start="perilaku dimulai",
        reload="berkas lain berjalan mulai sekarang",
        rollback="berkas sebelumnya berjalan lagi", resume="melanjutkan dari tempat berhenti terakhir",
        forget="seorang pengunjung dilupakan", dropped_timer="sebuah pewaktu dibatalkan",
        dropped_event="sebuah peristiwa dibatalkan", gap="sebagian catatan hilang", code="id",
    )
}  # fmt: skip
"""The phrases in the pages' languages besides English, by language code."""


def kind_of(entry: Mapping[str, Any]) -> str:
    """Return `person` for a person's order, else `says`, `does` or `state` by its effect, else how it arrived.

    How it arrived is `heard`, `timer` or the like. A jump is `mark`, `person` for a note, or its own kind, such as
    `start`, `reload` or `resume`.
    """
    said = _said(entry)
    if MARK in said:
        return MARK
    if "jump" in entry:
        return PERSON if NOTE in said else str(entry["jump"])
    cause = entry.get("cause")
    if "goto" in entry or (isinstance(cause, list) and cause and cause[0] == PERSON):
        return PERSON
    begun = {kind for kind, _ in _begun(entry)}
    if "Say" in begun:
        return SAYS
    if begun:
        return DOES
    return STATE if entry.get("entered") else next((how for how in HOWS if how in entry), "heard")


def told_of(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return the `kind` and the `text` of an entry for a page.

    `texts` has the texts in other languages that differ from `text`; it is left out if there are none.
    """
    text = text_of(entry)
    others = {code: other for code, words in OTHERS.items() if text and (other := text_of(entry, words)) != text}
    return {"text": text, "kind": kind_of(entry), **({"texts": others} if others else {})}


def text_of(entry: Mapping[str, Any], words: EntryPhrases = ENGLISH) -> str:
    """Return an entry's event and effects as a line; empty for a frequent event, such as a face, without an effect."""
    if told := _noted(_said(entry), words):
        return told
    if "jump" in entry:
        return words.jump(str(entry["jump"]))
    came, did = _received(entry, words), [*_did(entry, words)]
    if came.startswith(ENDS):
        return ", ".join(did)[:MAX_TEXT]
    if not did and entry.get("heard") in OFTEN:
        return ""
    return f"{came}: {', '.join(did)}"[:MAX_TEXT] if did else came[:MAX_TEXT]


def _said(entry: Mapping[str, Any]) -> Mapping[str, Any]:
    said = entry.get("said")
    return said if isinstance(said, Mapping) and "jump" in entry else {}


def _noted(said: Mapping[str, Any], words: EntryPhrases) -> str:
    """Return the text of a person's mark or note, with the person's name; empty for other entries."""
    what = next((key for key in (MARK, NOTE) if key in said), "")
    if not what:
        return ""
    text = f"{words.mark}: {said[what]}".removesuffix(": ") if what == MARK else str(said[what])
    return words.by.format(text, words.person(str(said.get("by", ""))))[:MAX_TEXT]


def _received(entry: Mapping[str, Any], words: EntryPhrases) -> str:
    how = next((how for how in HOWS if how in entry), "")
    name, data = str(entry.get(how, "")), entry.get("data")
    cause = entry.get("cause")
    match data:
        case {"result": str(heard)} if how == "heard":
            text = words.heard.format(heard) if name == "heard" else f"{name} “{heard}”"
        case {"state": str(state)} if how == "goto":
            text = words.sent.format(state)
        case {"reason": str(reason)} if reason and name.startswith(ERROR):
            text = f"{words.refused if reason.endswith(HELD) else name}: {reason}"
        case _:
            text = words.late if how == "timer" else name
    return text + _by(cause, words)


def _by(cause: object, words: EntryPhrases) -> str:
    """Return the person who caused an entry, as the end of its line; empty for other causes."""
    person = isinstance(cause, list) and len(cause) > 3 and cause[0] == PERSON and cause[3]
    return words.by.format("", words.person(str(person))) if person else ""


def _did(entry: Mapping[str, Any], words: EntryPhrases) -> Iterator[str]:
    entered = entry.get("entered")
    if isinstance(entered, list) and entered:
        names = [str(name) for name in entered]
        inner = [name for name in names if not any(other.startswith(f"{name}.") for other in names)]
        yield f"→ {', '.join(inner)}"
    for kind, said in _begun(entry):
        match said:
            case {"text": str(text)} if kind == "Say":
                yield words.says.format(text)
            case {"skill": str(skill)} if kind == "Do":
                arguments = said.get("arguments", {})
                yield f"{skill} {', '.join(f'{name} {value}' for name, value in arguments.items())}".strip()
            case {"motion": str(motion)}:
                yield words.plays.format(motion)
            case {"posture": str(posture)} | {"name": str(posture)}:
                yield f"{words.deed(kind)} {posture}"
            case _:
                yield words.deed(kind)


def _begun(entry: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    for command in entry.get("commands", ()):
        if found := started(command):
            yield found[1], found[2]
