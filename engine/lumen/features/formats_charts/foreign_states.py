"""The states of a foreign chart during conversion, with their names and references."""

import re
from collections.abc import Container, Iterator
from dataclasses import dataclass, field
from typing import Any

from lumen.project.formats.unused_names import unused_name

MAX_RENAMED = 1000
"""The most ids in a file that can become the same text; with more, the search for a free number is slow."""

MAX_STATE_LEVELS = 40
"""The maximum depth of nested states; each of them adds two levels to a YAML file."""

_UNFIT_KEY = re.compile(r"[\s.#*]+")
_UNFIT_ID = re.compile(r"[\s#*]+")


@dataclass(slots=True, eq=False)
class ForeignState:
    """A state of a foreign chart."""

    source: Any
    """The state's element or object in the foreign file."""
    parent: "ForeignState | None"
    key: str
    """The state's key in the behaviour file."""
    id: str
    """The state's id, or empty."""
    path: str
    """The state's path in the behaviour file."""
    children: list["ForeignState"] = field(default_factory=list)
    keys: set[str] = field(default_factory=set)
    """The children's keys."""

    def add(self, child: "ForeignState") -> None:
        """Add a child and its key."""
        self.children.append(child)
        self.keys.add(child.key)

    @property
    def name(self) -> str:
        """The state's name in the built machine: its id, else its path."""
        return self.id or self.path

    def lies_below(self, other: "ForeignState") -> bool:
        """Return whether this state is inside `other`, at any depth."""
        node = self.parent
        while node is not None and node is not other:
            node = node.parent
        return node is other

    def walk(self) -> Iterator["ForeignState"]:
        """Yield this state and all states inside it, in document order."""
        yield self
        for child in self.children:
            yield from child.walk()

    def below(self, key: str) -> str:
        """Return the path of a child with this key."""
        return f"{self.path}.{key}" if self.path else key

    def calls(self, target: "ForeignState", title: str, *, inside: bool = False) -> str:
        """Return this state's reference to a target: `key` for a sibling, `.key` for a child, `#id` for others.

        With `inside`, for `initial`, a child is `key` and a sibling `#id`. `title` is the root's id.
        """
        if target.parent is self:
            return target.key if inside else f".{target.key}"
        if target.parent is self.parent and self.parent is not None and not inside:
            return target.key
        return f"#{target.name or title}"


def clean_id(text: str) -> str:
    """Return the text as an id for `#id`: each run of whitespace, `#` and `*` becomes `_`."""
    return _UNFIT_ID.sub("_", text)


def free_id(text: str, ids: Container[str], taken: Container[str]) -> str:
    """Return a valid id unchanged, else its `clean_id`, with a number if that is in `ids` or `taken`."""
    wanted = clean_id(text)
    return text if text == wanted else unused_name(wanted, lambda id: id in ids or id in taken, MAX_RENAMED)


def free_key(parent: ForeignState, wanted: str, id: str, ids: Container[str]) -> str:
    """Return a key like `wanted` that no child of `parent` has and whose path is no other state's id."""
    stem = _UNFIT_KEY.sub("_", wanted) or "state"

    def is_taken(key: str) -> bool:
        return key in parent.keys or (parent.below(key) != id and parent.below(key) in ids)

    return unused_name(stem, is_taken, len(parent.keys))


def passing_key(home: ForeignState, taken: Container[str]) -> str:
    """Return an unused key for an additional state in `home`, which is entered and left immediately."""
    return unused_name("begin", lambda key: key in home.keys or key in taken, len(home.keys))
