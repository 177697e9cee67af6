"""The lines of a file that determine one line's place in the tree; the others may be invalid."""

import re

ANCESTORS_WHOLE, LINES_WHOLE = 3, 120
"""The number of innermost enclosing keys whose whole blocks can be included, and a block's maximum length [lines].

Only the lines of outer keys are included, without their blocks.
"""

_SKIPPED = re.compile(r"\s*(#|$)")


def fragment(lines: list[str], at: int, column: int) -> tuple[list[str], int]:
    """Return the lines that determine the place of the line at index `at` in the tree, and that line's new index.

    An empty line counts as indented to `column`, from 1.
    """
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
    """Return the indices of the lines whose blocks contain the line at index `at`, the outermost first.

    An empty line counts as indented to `column`, from 1.
    """
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
    """Return the index after the last line of the block that begins at `begin` and contains `at`."""
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
