"""A difference between two bundles, in words for the people who edit the files."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, TypeVar

from lumen.language.diagnostics import NodePath


class Risk(IntEnum):
    """The reach of a change in a running exhibition, from the smallest to the greatest."""

    COSMETIC = 0
    """Texts, stories, names: the course of events stays the same."""
    BEHAVIOR = 1
    """States, transitions, guards, context, controllers: the course of events changes."""
    MOTION = 2
    """Keyframes and head control: the robot moves differently."""
    WIRING = 3
    """Routes and message schemas: other modules must match."""
    RESTART = 4
    """The robot's model, the hall, the stage, the broker: takes effect only at the next start."""

    def __str__(self) -> str:
        return self.name.lower()


@dataclass(frozen=True, slots=True)
class Change:
    """One difference; two changes are equal if their kinds, subjects, sentences, risks and files are equal."""

    kind: str
    """The kind of part that changed: `text`, `state`, `route`, …"""
    about: str
    """The name of the changed part."""
    sentence: str
    """The change in words."""
    risk: Risk
    """The reach of the change in a running exhibition."""
    file: str = ""
    """The file of the change, relative to the project."""
    where: NodePath = field(default=(), compare=False)
    """The path of the node in that file; empty if unknown."""
    was: str = field(default="", compare=False)
    """The whole text before the change; empty if the change is not about a text."""
    now: str = field(default="", compare=False)
    """The whole text after the change; empty if the change is not about a text."""

    def __str__(self) -> str:
        return self.sentence


T = TypeVar("T")


def entry_changes(
    kind: str,
    title: str,
    risk: Risk,
    file: str,
    old: Mapping[str, T],
    new: Mapping[str, T],
    inside: Callable[[T, T], Iterator[Change]] | None = None,
) -> Iterator[Change]:
    """Yield each value that was added or removed, and the changes that `inside` finds in each value that differs.

    `title` names the kind of value, as in `place`; `{}` in `file` is replaced by the value's name. Without `inside`, a
    value that differs is one change.
    """
    for name in dict.fromkeys((*old, *new)):
        if name in old and name in new:
            if old[name] != new[name]:
                whole = Change(kind, name, f"{title} `{name}` changed", risk, file.format(name))
                yield from inside(old[name], new[name]) if inside else (whole,)
        else:
            how = "added" if name in new else "removed"
            yield Change(kind, name, f"{title} `{name}` {how}", risk, file.format(name))


MAX_SHOWN_CHARACTERS = 60
"""The maximum number of characters of a text that are shown; a longer text is cut."""


def seconds(time: float | None) -> str:
    """Return a time [s] as text: `3 s`, `500 ms` or `2 min`; `none` for None."""
    if time is None:
        return "none"
    if time and time < 1.0:
        return f"{time * 1000:g} ms"
    return f"{time / 60:g} min" if time >= 60 and time % 60 == 0 else f"{time:g} s"


def quoted(text: str) -> str:
    """Return a text as one line in quotation marks, cut to `MAX_SHOWN_CHARACTERS`."""
    line = " ".join(text.split())
    return f"“{line if len(line) <= MAX_SHOWN_CHARACTERS else line[: MAX_SHOWN_CHARACTERS - 1] + '…'}”"


_IN_YAML = {None: "null", True: "true", False: "false"}


def code(value: Any) -> str:
    """Return a name, an expression or a value as one line in backticks, cut to `MAX_SHOWN_CHARACTERS`.

    Values are written as in YAML: `null`, `true`, `30` for 30.0, and `""` for the empty text.
    """
    if value is None or isinstance(value, bool):
        text = _IN_YAML[value]
    elif isinstance(value, float):
        text = f"{value:.15g}"
    else:
        text = str(value).replace("\n", " ") or '""'
    return f"`{text if len(text) <= MAX_SHOWN_CHARACTERS else text[: MAX_SHOWN_CHARACTERS - 1] + '…'}`"


def names(found: Any) -> str:
    """Return names as a list in words: `a`, `b` and `c`."""
    shown = [f"`{name}`" for name in found]
    return f"{', '.join(shown[:-1])} and {shown[-1]}" if len(shown) > 1 else "".join(shown)


def how_many(number: int, what: str) -> str:
    """Return a number with its noun: `1 text`, `2 texts`, `2 stories`."""
    if number == 1:
        return f"1 {what}"
    return f"{number} {what[:-1]}ies" if what.endswith("y") else f"{number} {what}s"
