"""The part of a file around a line that says where in the tree it stands: what is elsewhere may be broken."""

import re

ANCESTORS_WHOLE, LINES_WHOLE = 3, 120
"""How many of the keys around a line are taken with all that stands below them, where that are not more lines than so;
of those further out only the key is."""

_SKIPPED = re.compile(r"\s*(#|$)")


def fragment(lines: list[str], at: int, column: int) -> tuple[list[str], int]:
    """The lines around that of index `at`, and which of them it is; an empty one begins at `column`, from 1."""
    around = ancestors(lines, at, column)
    if len(around) < ANCESTORS_WHOLE:
        return lines, at
    for outer in range(len(around) - ANCESTORS_WHOLE, len(around)):
        begin = around[outer]
        end = block_end(lines, begin, at)
        if end - begin <= LINES_WHOLE:
            break
    kept = [lines[i] for i in around[:outer]]
    return [*kept, *lines[begin:end]], len(kept) + at - begin


def ancestors(lines: list[str], at: int, column: int) -> list[int]:
    """The lines that stand further out and further out above one, the outermost first."""
    found, inner = list[int](), lines[at] if lines[at].strip() else " " * (column - 1) + "x"
    for i in range(at - 1, -1, -1):
        if _SKIPPED.match(lines[i]):
            continue
        deeper = _indent(inner) - _indent(lines[i])
        if deeper > 0 or (deeper == 0 and _item(inner) and not _item(lines[i])):
            found.append(i)
            inner = lines[i]
    return found[::-1]


def block_end(lines: list[str], begin: int, at: int) -> int:
    """Behind the last line below that one."""
    if lines[begin].startswith("\t"):
        return begin + 1
    outer = _indent(lines[begin])
    for i in range(at + 1, len(lines)):
        if not _SKIPPED.match(lines[i]) and _indent(lines[i]) <= outer and not lines[i].lstrip().startswith(("}", "]")):
            return i
    return len(lines)


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


def _item(line: str) -> bool:
    return line.lstrip(" ").startswith("- ") or line.strip() == "-"
