"""Lines that stand too far in or out, and items of lists without their hyphen: what the lines around them tell."""

import re
from collections.abc import Iterator, Sequence

from lumen.loading.slips import Slip

LINES_BACK = 60
"""Lines before the one at which a reader stopped where a block may stand at the wrong depth."""

AMONG_KEYS, DELETE_HYPHEN = "an item of a list stands among keys", "delete the `- ` before it"

_KEYED = re.compile(r" *[\w.#\"'*]+:(?: |$)")
_VALUED = re.compile(r" *[\w.#\"'*]+: +\S")
_ITEM = re.compile(r" *- ")


def indent(line: str) -> int:
    """How many blanks it begins with."""
    return len(line) - len(line.lstrip(" "))


def _says(line: str) -> bool:
    """Whether a line holds more than a comment."""
    return bool(line.strip()) and not line.lstrip().startswith("#")


def items(lines: Sequence[str], index: int) -> Iterator[Slip]:
    """An item among keys, or a key among items, in the line of that index: the line before it tells which."""
    here = lines[index]
    above = next((line for line in reversed(lines[:index]) if _says(line) and indent(line) <= indent(here)), "")
    below = next((line for line in lines[index + 1 :] if _says(line) and indent(line) <= indent(here)), "")
    column = indent(here)
    if not _says(here):
        return
    among = [line for line in (above, below) if _ITEM.match(line) and indent(line) in (column, column - 2)]
    if among and indent(among[0]) < column and here[column] not in "{[":
        among = []  # it goes on with the item above
    if among and not _ITEM.match(here):
        if _usual(lines, index):
            yield from _moved(lines, index, [column + 2])
        hint = "write `- ` before it too, or delete the one above"
        meant = {index: f"{here[: indent(among[0])]}- {here[column:]}"}
        what = "a key" if _KEYED.match(here) else "something"
        message = f"{what} stands among the items of a list"
        yield Slip(index + 1, column + 1, len(here) - column, message, hint, meant)
        at = next(i for i in range(index - 1, -1, -1) if lines[i] == above) if above in among else index
        if at < index and _KEYED.match(here):  # rather all are keys, and the first has a hyphen
            meant = {at: above[:column] + above[column + 2 :]}
            yield Slip(at + 1, column + 1, 1, AMONG_KEYS, DELETE_HYPHEN, meant)
    if _ITEM.match(here) and indent(above) == column and _KEYED.match(above):
        yield Slip(index + 1, column + 1, 1, AMONG_KEYS, DELETE_HYPHEN, {index: here[:column] + here[column + 2 :]})


def _usual(lines: Sequence[str], index: int) -> bool:
    """Whether the key in that line stands two blanks further in elsewhere, as it does in the other items of a list."""
    key = f"  {lines[index].split(':')[0]}:"
    return bool(_KEYED.match(lines[index])) and any(line.startswith(key) for line in lines)


def too_deep(lines: Sequence[str], row: int) -> Iterator[Slip]:
    """A key that stands further in than the one above it, which has its value already."""
    above = next((line for line in reversed(lines[:row]) if _says(line)), "")
    if _KEYED.match(lines[row]) and _VALUED.match(above) and indent(lines[row]) > indent(above):
        yield from _moved(lines, row, [indent(above)])


def depths(lines: Sequence[str], row: int) -> Iterator[Slip]:
    """Lines that would fit at another depth, alone or with all that stands below them; the nearest first.

    Where a line stands as deep as some before it, one between them that stands further out has cut it off.
    """
    told = [i for i in range(row, max(row - LINES_BACK, 0) - 1, -1) if _says(lines[i])]
    known = [indent(lines[i]) for i in told]
    here = indent(lines[row])
    above = [i for i in told if i < row and indent(lines[i]) < here]
    for i in [*above, row] if here in known[1:] else [row, *above]:
        yield from _moved(lines, i, known)


def _moved(lines: Sequence[str], index: int, known: Sequence[int]) -> Iterator[Slip]:
    here, block = indent(lines[index]), [index]
    for j in range(index + 1, len(lines)):
        if _says(lines[j]) and indent(lines[j]) <= here:
            break
        block.append(j)
    bare = lines[index].rstrip().endswith(":")
    inner = next((indent(lines[j]) for j in block[1:] if bare and _says(lines[j])), here + 80)
    above = next((indent(line) for line in reversed(lines[:index]) if _says(line)), 0)
    below = next((indent(line) for line in lines[index + 1 :] if _says(line)), 0)
    for depth in sorted(
        {*known} - {here}, key=lambda at: (at >= inner, at not in (above, below), abs(at - here), at if bare else -at)
    ):
        much = abs(depth - here)
        way = "out" if depth > here else "in"
        message = f"this line stands too far {way}: it begins in column {here + 1}, what is beside it in {depth + 1}"
        blanks = "a blank" if much == 1 else f"{much} blanks"
        hint = f"indent it by {blanks} more" if depth > here else f"take {blanks} away before it"
        for part in ([index], block) if depth < inner else (block,):
            meant = {j: _shifted(lines[j], depth - here) for j in part}
            yield Slip(index + 1, 1, max(here, 1), message, hint, meant, only_whole=True)


def _shifted(line: str, much: int) -> str:
    if not line.strip():
        return line
    return " " * much + line if much > 0 else line[min(-much, indent(line)) :]
