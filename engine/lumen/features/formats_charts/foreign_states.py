"""The states of a foreign chart on their way into ours: what each is called, and how others name it."""

import re
from collections.abc import Container, Iterator
from dataclasses import dataclass, field
from typing import Any

from lumen.project.formats.unused_names import unused_name

MAX_RENAMED = 1000
"""Ids of one file that may become the same text; the search for a free number takes longer with more."""

MAX_STATE_LEVELS = 40
"""Of nested states; a YAML file has two levels for each."""

_UNFIT_KEY = re.compile(r"[\s.#*]+")
_UNFIT_ID = re.compile(r"[\s#*]+")


@dataclass(slots=True, eq=False)
class ForeignState:
    """A state: what the foreign file has there, its key and path in ours, and its id, if it has one."""

    source: Any
    parent: "ForeignState | None"
    key: str
    id: str
    path: str
    children: list["ForeignState"] = field(default_factory=list)
    keys: set[str] = field(default_factory=set)

    def add(self, child: "ForeignState") -> None:
        """One more child."""
        self.children.append(child)
        self.keys.add(child.key)

    @property
    def name(self) -> str:
        """What the built machine calls it."""
        return self.id or self.path

    def lies_below(self, other: "ForeignState") -> bool:
        """Whether it is anywhere within the other one."""
        node = self.parent
        while node is not None and node is not other:
            node = node.parent
        return node is other

    def walk(self) -> Iterator["ForeignState"]:
        """Itself and everything below, in document order."""
        yield self
        for child in self.children:
            yield from child.walk()

    def below(self, key: str) -> str:
        """The path of a child."""
        return f"{self.path}.{key}" if self.path else key

    def calls(self, target: "ForeignState", title: str, *, inside: bool = False) -> str:
        """How this state names another as a target: its key beside it, `.key` within, else `#id`.

        `inside` is for `initial`, where a child is only its key; `title` is the behaviour's own name.
        """
        if target.parent is self:
            return target.key if inside else f".{target.key}"
        if target.parent is self.parent and self.parent is not None and not inside:
            return target.key
        return f"#{target.name or title}"


def clean_id(text: str) -> str:
    """An id that `#id` can hold."""
    return _UNFIT_ID.sub("_", text)


def free_id(text: str, ids: Container[str], taken: Container[str]) -> str:
    """`clean_id` of the text, with a number if that is the id of another state, or one that was given already."""
    wanted = clean_id(text)
    return text if text == wanted else unused_name(wanted, lambda id: id in ids or id in taken, MAX_RENAMED)


def free_key(parent: ForeignState, wanted: str, id: str, ids: Container[str]) -> str:
    """A key like the one wanted that no other child has, and whose path is not the id of another state."""
    stem = _UNFIT_KEY.sub("_", wanted) or "state"

    def is_taken(key: str) -> bool:
        return key in parent.keys or (parent.below(key) != id and parent.below(key) in ids)

    return unused_name(stem, is_taken, len(parent.keys))


def passing_key(home: ForeignState, taken: Container[str]) -> str:
    """A key for a state that is passed through on the way into `home`."""
    return unused_name("begin", lambda key: key in home.keys or key in taken, len(home.keys))
