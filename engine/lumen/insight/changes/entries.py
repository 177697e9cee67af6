"""The changes between two mappings from names to values."""

from collections.abc import Callable, Iterator, Mapping
from typing import TypeVar

from lumen.insight.changes.change import Change, Risk

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
