"""Small behaviours that hear, and their reactions to a sentence."""

from collections.abc import Mapping
from typing import Any

from lumen.language.events import Event
from lumen.statechart import Machine, Snapshot, Step, initial, step

WORDS = {
    "fillers": {
        "en": ["please", "well", "um", "oh", "can't you", "why not", "well then", "Lumen"],
        "id": ["dong", "ya"],
    },
    "small_words": {
        "en": ["no", "not", "nothing", "that", "is", "all", "i", "am", "the", "a", "it", "do"],
        "id": ["tidak", "sudah"],
    },
    "negations": {"en": ["not", "never"], "id": ["tidak", "jangan"], "de": ["kein"]},
    "negations_after": {"de": ["nicht"]},
    "contrasts": {"en": ["but"]},
    "questions": {"en": ["why", "who", "what", "how"]},
    "questions_anywhere": {"id": ["siapa", "kenapa"]},
    "not_names": {"en": ["tired", "from", "hungry", "ready"]},
    "name_ends": {"en": ["and", "from"], "id": ["dan", "dari"]},
}
ANSWERS = {
    "contractions": [
        {"phrases": {"en": ["I'm"]}, "value": "i am"},
        {"phrases": {"en": ["don't"]}, "value": "do not"},
    ],
    "numbers": [
        {"phrases": {"en": "three", "id": "tiga", "de": "drei"}, "value": 3},
        {"phrases": {"en": "twenty", "id": "dua puluh"}, "value": 20},
        {"phrases": {"en": "two", "id": "dua"}, "value": 2},
        {"phrases": {"en": "hundred", "id": "ratus"}, "value": 100},
    ],
}


def hearing(
    hears: Mapping[str, Any],
    phrases: Mapping[str, Any],
    *,
    answers: Mapping[str, Any] | None = None,
    lists: Mapping[str, Any] | None = None,
    more: Mapping[str, Any] | None = None,
) -> Machine:
    """Return a behaviour whose state `asked` has these rows; text targets become states, `caught` gets `heard`."""
    rows = {key: _row(row) for key, row in hears.items()}
    targets = {one["target"] for row in rows.values() for one in (row if isinstance(row, list) else [row])} - {"."}
    return Machine.from_dict(
        {
            "context": {"caught": None, "most": 0},
            "phrases": {**WORDS, **phrases},
            "answers": {**ANSWERS, **(answers or {})},
            "lists": lists or {},
            "states": {**{name: {} for name in targets}, "asked": {"hears": rows}},
            "initial": "asked",
            **(more or {}),
        }
    )


def _row(row: Any) -> dict[str, Any]:
    return {"target": row, "actions": {"assign": {"caught": "heard"}}} if isinstance(row, str) else row


def said(machine: Machine, text: Any, snapshot: Snapshot | None = None) -> Step:
    """Return the step of a sentence, from the beginning if nothing else is given."""
    return step(machine, snapshot or initial(machine).snapshot, Event("heard", {"result": text}))


def taken(machine: Machine, text: str) -> str:
    """Return the state that a sentence leads to; `asked` if it is not left."""
    (state,) = said(machine, text).snapshot.configuration
    return state


def caught(machine: Machine, text: str) -> Any:
    """Return `heard` of the row that was taken."""
    return said(machine, text).snapshot.context["caught"]
