"""Find lines with a wrong indentation and list items without a hyphen, by comparison with the lines around them."""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from lumen.project.slips import Slip

LINES_BACK = 60
"""The number of lines before a syntax error that are searched for a block at the wrong depth."""

AMONG_KEYS, DELETE_HYPHEN = "a list item is among the keys of a map", "delete the `- `"

_KEYED = re.compile(r" *[\w.#\"'*]+:(?: |$)")
_VALUED = re.compile(r" *[\w.#\"'*]+: +\S")
_ITEM = re.compile(r" *- ")
_NAMED = re.compile(r" *(?:- +)?(?P<key>[^\s\"'#\[\]{},:-][^\s:]*):(?: |$)")


def indent(line: str) -> int:
    """Return the number of spaces at the beginning of a line."""
    return len(line) - len(line.lstrip(" "))


def is_content(line: str) -> bool:
    """Return True if a line holds more than a comment."""
    return bool(line.strip()) and not line.lstrip().startswith("#")


def holder(lines: Sequence[str], row: int, depth: int) -> str:
    """Return the key under which the line with index `row` would be if `depth` spaces preceded it; "" at the top level.

    If it would be inside a list item, the result is `- N`, where N is the item's line, counted from 1.
    """
    is_item = bool(_ITEM.match(lines[row]))
    for i in range(row - 1, -1, -1):
        line = lines[i]
        if not is_content(line):
            continue
        hyphen = _ITEM.match(line)
        start = len(hyphen[0]) if hyphen else indent(line)
        if hyphen and start == depth and not is_item:
            return f"- {i + 1}"
        if (start < depth or (is_item and not hyphen and start == depth)) and (named := _NAMED.match(line)):
            return named["key"]
    return ""


class LineMove(NamedTuple):
    """A change of the indentation of some lines."""

    rows: Sequence[int]
    """The indices of the lines, from 0."""
    shift: int
    """The number of spaces to add before each line; negative to remove them."""


def move_hint(lines: Sequence[str], move: LineMove, *others: LineMove) -> str:
    """Return the advice to move lines: which ones, by how much and to what place; `others` are alternative moves."""
    hint = _move_hint(lines, *move)
    what = hint.partition(" by ")[0]
    return ", or ".join((hint, *(_move_hint(lines, *other).removeprefix(f"{what} ") for other in others)))


def _move_hint(lines: Sequence[str], rows: Sequence[int], shift: int) -> str:
    first, much = lines[rows[0]], abs(shift)
    count = "1 space" if much == 1 else f"{much} spaces"
    amount = f"{count.replace(' ', ' more ')}" if shift > 0 else count.replace(" ", " fewer " if much > 1 else " less ")
    inner = holder(lines, rows[0], indent(first) + shift)
    goal = f"into the list item of line {inner[2:]}" if inner.startswith("- ") else f"under `{inner}`"
    siblings = sum(is_content(lines[i]) and indent(lines[i]) == indent(first) for i in rows)
    named = _NAMED.match(first)
    what = f"`{named['key']}`" if named and not _ITEM.match(first) else "this line"
    if siblings > 1 and not _ITEM.match(lines[rows[-1]]):
        what, them = f"lines {rows[0] + 1} to {rows[-1] + 1}", "them"
    elif len(rows) > 1:
        what, them = f"{what} and the lines under it", "them"
    else:
        them = "it"
    return f"indent {what} by {amount} to put {them} {goal if inner else 'at the top level'}"


def items(lines: Sequence[str], index: int) -> Iterator[Slip]:
    """Yield slips if the line at `index` is a list item among keys, or a key among list items."""
    here = lines[index]
    above = next((line for line in reversed(lines[:index]) if is_content(line) and indent(line) <= indent(here)), "")
    below = next((line for line in lines[index + 1 :] if is_content(line) and indent(line) <= indent(here)), "")
    column = indent(here)
    if not is_content(here):
        return
    among = [line for line in (above, below) if _ITEM.match(line) and indent(line) in (column, column - 2)]
    if among and indent(among[0]) < column and here[column] not in "{[":
        among = []  # it continues the item above
    if among and not _ITEM.match(here):
        before = next((line for line in reversed(lines[:index]) if is_content(line)), "")
        if _usual(lines, index) or (_KEYED.match(before) and indent(before) == column + 2):
            yield from _moved(lines, index, [column + 2])
        hint = "add `- ` before it, or delete the `- ` above"
        meant = {index: f"{here[: indent(among[0])]}- {here[column:]}"}
        what = "this key" if _KEYED.match(here) else "this line"
        message = f"{what} is among the items of a list, but has no hyphen"
        yield Slip(index + 1, column + 1, len(here) - column, message, hint, meant)
        at = next(i for i in range(index - 1, -1, -1) if lines[i] == above) if above in among else index
        if at < index and _KEYED.match(here):  # more likely all are keys, and the hyphen of the first is wrong
            meant = {at: above[:column] + above[column + 2 :]}
            yield Slip(at + 1, column + 1, 1, AMONG_KEYS, DELETE_HYPHEN, meant)
    if _ITEM.match(here) and indent(above) == column and _KEYED.match(above):
        yield Slip(index + 1, column + 1, 1, AMONG_KEYS, DELETE_HYPHEN, {index: here[:column] + here[column + 2 :]})


def _usual(lines: Sequence[str], index: int) -> bool:
    """Return True if the key in the line `index` also occurs two spaces further in, as in other items of a list."""
    key = f"  {lines[index].split(':')[0]}:"
    return bool(_KEYED.match(lines[index])) and any(line.startswith(key) for line in lines)


def too_deep(lines: Sequence[str], row: int) -> Iterator[Slip]:
    """Yield a slip if the key at `row` is further in than the key above it, although that one already has a value."""
    above = next((line for line in reversed(lines[:row]) if is_content(line)), "")
    if _KEYED.match(lines[row]) and _VALUED.match(above) and indent(lines[row]) > indent(above):
        yield from _moved(lines, row, [indent(above)])


def depths(lines: Sequence[str], row: int) -> Iterator[Slip]:
    """Yield slips that move the line at `row`, or one before it, to another depth, alone or with the lines within it.

    The nearest lines come first. If earlier lines have the same indentation as `row`, the lines between them that are
    further out come before `row` itself: one of them may have been moved by mistake.
    """
    told = [i for i in range(row, max(row - LINES_BACK, 0) - 1, -1) if is_content(lines[i])]
    known = [indent(lines[i]) for i in told]
    here = indent(lines[row])
    above = [i for i in told if i < row and indent(lines[i]) < here]
    texts = [len(found[0]) for i in told if (found := _ITEM.match(lines[i]))]
    for i in [*above, row] if here in known[1:] else [row, *above]:
        yield from _moved(lines, i, [*known, *texts])
    inner = next((a for a, b in pairwise(told[1:]) if indent(lines[a]) > here > indent(lines[b])), None)
    if inner is not None:  # the first line of a block whose other lines are further out
        yield from _moved(lines, inner, [here])


def _moved(lines: Sequence[str], index: int, known: Sequence[int]) -> Iterator[Slip]:
    here, block = indent(lines[index]), [index]
    for j in range(index + 1, len(lines)):
        if is_content(lines[j]) and indent(lines[j]) <= here:
            break
        block.append(j)
    bare = lines[index].rstrip().endswith(":")
    inner = next((indent(lines[j]) for j in block[1:] if bare and is_content(lines[j])), here + 80)
    above = next((indent(line) for line in reversed(lines[:index]) if is_content(line)), 0)
    below = next((indent(line) for line in lines[index + 1 :] if is_content(line)), 0)
    for depth in sorted(
        {*known} - {here}, key=lambda at: (at >= inner, at not in (above, below), abs(at - here), at if bare else -at)
    ):
        way = "not indented far enough" if depth > here else "indented too far"
        message = f"this line is {way}: it begins in column {here + 1}, but the lines next to it in column {depth + 1}"
        for part in ([index], block) if depth < inner else (block,):
            hint = move_hint(lines, LineMove(part, depth - here))
            meant = {j: shifted(lines[j], depth - here) for j in part}
            yield Slip(index + 1, 1, max(here, 1), message, hint, meant, only_whole=True)


def shifted(line: str, much: int) -> str:
    """Return the line with that many more spaces before it, or fewer if the number is negative."""
    if not line.strip():
        return line
    return " " * much + line if much > 0 else line[min(-much, indent(line)) :]
