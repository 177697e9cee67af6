"""A nondeterministic automaton whose states are followed all at once, in time proportional to the text.

K. Thompson, "Regular Expression Search Algorithm", CACM 11(6), 1968. `re` only tests single characters.
"""

import re
from typing import NamedTuple

CharacterTest = re.Pattern[str] | str | None
"""What a state tests: a set of characters, a character, or an anchor (`^ $ \\b \\B`)."""


class AutomatonState(NamedTuple):
    """`kind` is char, split, at or end; `test` a character's pattern or an anchor's name; `next` where it leads."""

    kind: str
    test: CharacterTest
    next: tuple[int, ...]


class CompiledPattern:
    """A compiled pattern; `search` is whether it occurs anywhere in a text."""

    def __init__(self, states: list[AutomatonState], start: int) -> None:
        self.states, self.start = states, start

    def search(self, text: str) -> bool:
        active: set[int] = set()
        for position in range(len(text) + 1):
            active = self._closure(active | {self.start}, text, position)
            if -1 in active:
                return True
            if position == len(text):
                break
            character = text[position]
            active = {s.next[0] for i in active if (s := self.states[i]).kind == "char" and _fits(s.test, character)}
        return False

    def _closure(self, active: set[int], text: str, position: int) -> set[int]:
        """The states reached without a further character; -1 stands for the end of the pattern."""
        reached, pending = set[int](), list(active)
        while pending:
            index = pending.pop()
            if index in reached:
                continue
            reached.add(index)
            state = self.states[index]
            if state.kind == "end":
                return {-1}
            if state.kind == "split" or (state.kind == "at" and _stands(state.test, text, position)):
                pending.extend(state.next)
        return reached


def _fits(test: CharacterTest, character: str) -> bool:
    return test == character if isinstance(test, str) else test is None or test.match(character) is not None


def _stands(anchor: object, text: str, position: int) -> bool:
    if anchor == "^":
        return position == 0
    if anchor == "$":
        return position == len(text)
    before = position > 0 and _is_word(text[position - 1])
    after = position < len(text) and _is_word(text[position])
    return (before != after) == (anchor == r"\b")


def _is_word(character: str) -> bool:
    return character.isalnum() or character == "_"
