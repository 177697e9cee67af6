"""An entry of the journal as a line for people, and what kind of entry it is."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.interpreters.replay.command_data import started
from lumen.interpreters.replay.entries import HOWS
from lumen.language.events import CLOCK_SET

MAX_TEXT = 300
SAYS, DOES, STATE = "says", "does", "state"
ERROR = "error."
PERSON = "person"
MARK, NOTE = "mark", "note"
OFTEN, ENDS = ("face", CLOCK_SET), ("done.command.", "cancelled.command.", "lost.command.")
"""What comes again and again, and after each command: told where something comes of it."""
JUMPS = {
    "start": "the behaviour begins",
    "reload": "other files run from here on",
    "rollback": "the files before run again",
    "resume": "goes on where the run before ended",
    "forget": "somebody is forgotten",
    "dropped timer": "a timer is given up",
    "dropped event": "an event is given up",
    "gap": "some of what happened was lost",
    "keyframe": "",
}


def kind_of(entry: Mapping[str, Any]) -> str:
    """`person` for what somebody wanted, else `says`, `does` or `state` for what came of it, else how it came.

    That is `heard`, `timer`, `goto`, or the kind of a jump: `start`, `reload`, `resume` and the like.
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


def text_of(entry: Mapping[str, Any]) -> str:
    """What happened and what came of it; empty where nothing did that anybody would miss, as for another face."""
    if words := _words(_said(entry)):
        return words
    if "jump" in entry:
        return JUMPS.get(str(entry["jump"]), str(entry["jump"]))
    came, did = _came(entry), [*_did(entry)]
    if came.startswith(ENDS):
        return ", ".join(did)[:MAX_TEXT]
    if not did and entry.get("heard") in OFTEN:
        return ""
    return f"{came}: {', '.join(did)}"[:MAX_TEXT] if did else came[:MAX_TEXT]


def _said(entry: Mapping[str, Any]) -> Mapping[str, Any]:
    said = entry.get("said")
    return said if isinstance(said, Mapping) and "jump" in entry else {}


def _words(said: Mapping[str, Any]) -> str:
    """What somebody marked, or did to the robot themselves; empty where nobody did."""
    what = next((key for key in (MARK, NOTE) if key in said), "")
    if not what:
        return ""
    text = f"{what}: {said[what]}".removesuffix(": ") if what == MARK else str(said[what])
    return f"{text}, by {said.get('by', '')}"[:MAX_TEXT]


def _came(entry: Mapping[str, Any]) -> str:
    how = next((how for how in HOWS if how in entry), "")
    name, data = str(entry.get(how, "")), entry.get("data")
    cause = entry.get("cause")
    by = f", by {cause[3]}" if isinstance(cause, list) and len(cause) > 3 and cause[0] == PERSON and cause[3] else ""
    match data:
        case {"result": str(words)} if how == "heard":
            return f"{name} “{words}”{by}"
        case {"state": str(state)} if how == "goto":
            return f"sent to {state}{by}"
        case {"reason": str(reason)} if reason and name.startswith(ERROR):
            return f"{name}: {reason}{by}"
        case _:
            return ("time is up" if how == "timer" else name) + by


def _did(entry: Mapping[str, Any]) -> Iterator[str]:
    entered = entry.get("entered")
    if isinstance(entered, list) and entered:
        yield f"→ {entered[-1]}"
    for kind, said in _begun(entry):
        match said:
            case {"text": str(text)} if kind == "Say":
                yield f"says “{text}”"
            case {"motion": str(motion)}:
                yield f"plays {motion}"
            case {"posture": str(posture)} | {"name": str(posture)}:
                yield f"{kind.lower()} {posture}"
            case _:
                yield kind.lower()


def _begun(entry: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    for command in entry.get("commands", ()):
        if found := started(command):
            yield found[1], found[2]
