"""Print the answers to `lumen why` and `lumen why-not` as lines of text."""

import json
from collections.abc import Iterator, Mapping
from datetime import datetime
from textwrap import wrap
from typing import Any

from lumen.language.counts import counted

BECAUSE = {
    "guard": "its guard was false",
    "unheard": "it was not heard",
    "preempted": "another transition was taken",
    "no-event": "no event triggered it",
    "inactive": "its state was not active",
}
LEADS = {"activity": "by", "event": "for", "timer": "for", "message": "from", "person": "from", "file": "from"}
"""The word before a link of the chain of causes, by the link's kind; other kinds get `because`."""
WIDTH = 100
INDENT = " " * 10
MAX_INACTIVE = 3
"""The maximum number of reasons about inactive states that are shown; the rest are only counted."""


MAX_NEEDS = 5


def why_lines(answer: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of an answer to `why`: the event, the chain of its causes, then the earlier steps it depends on.

    A time is shown only if it differs from that of the link before. After each link come the values that its guard
    read, and its place in the files.
    """
    at = ""
    for number, link in enumerate(answer["chain"]):
        new = link["at"] != at and link["kind"] != "activity"
        at = link["at"] if new else at
        lead = f"{LEADS.get(link['kind'], 'because'):<8}" if number else ""
        id = f" [{link['id']}]" if link["kind"] in ("command", "timer") and link["id"] else ""
        yield from _block(_time(link["at"]) if new else "", lead + link["text"] + id, " " * len(lead))
        if link["kind"] == "transition":
            yield from (f"{INDENT}{' ' * 10}{line}" for line in _values(link["values"]))
        if link["file"]:
            yield f"{INDENT}{' ' * 8 if number else '  '}{_place(link)}"
    if answer["needs"]:
        yield f"{INDENT}It depends on earlier steps:"
    for link in answer["needs"][:MAX_NEEDS]:
        yield from _block(_time(link["at"]), f"  {link['text']}", "    ")


def why_not_lines(answer: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of an answer to `why-not`: each reason, its guard's values, and the change that would help.

    The reasons are in the answer's order, the nearest first; at most MAX_INACTIVE of them are about inactive states.
    """
    yield f"{_time(answer['at'])}  not {answer['what']}"
    if not answer["reasons"]:
        yield f"{INDENT}no transition leads there"
    shown: dict[str, int] = {}
    for reason in answer["reasons"]:
        because = reason["because"]
        shown[because] = shown.get(because, 0) + 1
        if because == "inactive" and shown[because] > MAX_INACTIVE:
            continue
        yield from _block("", f"{BECAUSE[because]}: {reason['text']}", "  ")
        if reason["false"]:
            yield from (f"{INDENT}    {line}" for line in _values(reason["false"]["values"]))
        said = f"it would have happened if {_change(reason['change'])}" if reason["change"] else reason["note"]
        if said:
            yield from _block("", f"  {said}", "    ")
        if reason["file"]:
            yield f"{INDENT}  {_place(reason)}"
    if (left := shown.get("inactive", 0) - MAX_INACTIVE) > 0:
        yield f"{INDENT}… and {counted(left, 'more way')} from states that were not active (--format json shows them)"


def _block(time: str, text: str, deeper: str) -> Iterator[str]:
    """Yield a text wrapped to WIDTH columns, with the time in front of its first line."""
    lead = text[: len(text) - len(text.lstrip())]
    lines = wrap(text.strip(), WIDTH - len(INDENT) - len(lead), subsequent_indent=deeper[len(lead) :] or "  ")
    for number, line in enumerate(lines):
        yield f"{(time if not number else ''):<{len(INDENT)}}{lead}{line}"


def _change(change: Mapping[str, Any]) -> str:
    """Return a change as a clause: `it had been in offer and heard had come with event.data.result "dance"`."""
    values = [(name, _json(value)) for name, value in change.items() if "." in name]
    said = [f"it had been in {change['state']}"] if "state" in change else []
    said += [f"nothing else had happened for {change['wait']:g} s"] if "wait" in change else []
    if "event" in change:
        brought = ", ".join(f"{name} {value}" for name, value in values)
        said.append(f"{change['event']} had come" + (f" with {brought}" if brought else ""))
    else:
        said += [f"{name} had been {value}" for name, value in values]
    return " and ".join(said)


def _values(values: Mapping[str, Any]) -> Iterator[str]:
    yield from (f"{name} is {_json(value)}" for name, value in values.items())


def _json(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False)


def _place(row: Mapping[str, Any]) -> str:
    return f"{row['file']}:{row['line']}"


def _time(text: str) -> str:
    return f"{datetime.fromisoformat(text).astimezone():%H:%M:%S}"
