"""The states of a foreign chart during conversion: their names, and how other states refer to them."""

import re
from collections.abc import Container, Iterator
from dataclasses import dataclass, field
from typing import Any

from lumen.project.formats.unused_names import unused_name

MAX_RENAMED = 1000
"""The most ids of one file that may become the same text; with more, the search for a free number takes long."""

MAX_STATE_LEVELS = 40
"""The most nested states; a YAML file has two levels for each."""

_UNFIT_KEY = re.compile(r"[\s.#*]+")
_UNFIT_ID = re.compile(r"[\s#*]+")


@dataclass(slots=True, eq=False)
class ForeignState:
    """A state of a foreign chart."""

    source: Any
    """Its part of the foreign file."""
    parent: "ForeignState | None"
    key: str
    """Its key in Lumen's file."""
    id: str
    """Its id, empty if it has none."""
    path: str
    """Its path in Lumen's file."""
    children: list["ForeignState"] = field(default_factory=list)
    keys: set[str] = field(default_factory=set)
    """The keys of its children."""

    def add(self, child: "ForeignState") -> None:
        """Add a child."""
        self.children.append(child)
        self.keys.add(child.key)

    @property
    def name(self) -> str:
        """The state's name in the built machine."""
        return self.id or self.path

    def lies_below(self, other: "ForeignState") -> bool:
        """Return whether this state is inside the other one, at any depth."""
        node = self.parent
        while node is not None and node is not other:
            node = node.parent
        return node is other

    def walk(self) -> Iterator["ForeignState"]:
        """Yield this state and all below it, in document order."""
        yield self
        for child in self.children:
            yield from child.walk()

    def below(self, key: str) -> str:
        """Return the path of the child with that key."""
        return f"{self.path}.{key}" if self.path else key

    def calls(self, target: "ForeignState", title: str, *, inside: bool = False) -> str:
        """Return how this state refers to a target: a sibling by its key, a child by `.key`, others by `#id`.

        `inside` is for `initial`, in which a child is only its key; `title` is the behaviour's own name.
        """
        if target.parent is self:
            return target.key if inside else f".{target.key}"
        if target.parent is self.parent and self.parent is not None and not inside:
            return target.key
        return f"#{target.name or title}"


def clean_id(text: str) -> str:
    """Return the text as an id that `#id` can refer to: blanks, `#` and `*` become `_`."""
    return _UNFIT_ID.sub("_", text)


def free_id(text: str, ids: Container[str], taken: Container[str]) -> str:
    """Return `clean_id` of the text, with a number if another state has that id or it was given before."""
    wanted = clean_id(text)
    return text if text == wanted else unused_name(wanted, lambda id: id in ids or id in taken, MAX_RENAMED)


def free_key(parent: ForeignState, wanted: str, id: str, ids: Container[str]) -> str:
    """Return a key like the one wanted that no other child has, and whose path is not another state's id."""
    stem = _UNFIT_KEY.sub("_", wanted) or "state"

    def is_taken(key: str) -> bool:
        return key in parent.keys or (parent.below(key) != id and parent.below(key) in ids)

    return unused_name(stem, is_taken, len(parent.keys))


def passing_key(home: ForeignState, taken: Container[str]) -> str:
    """Return a key for a state that is passed through on the way into `home`."""
    return unused_name("begin", lambda key: key in home.keys or key in taken, len(home.keys))
