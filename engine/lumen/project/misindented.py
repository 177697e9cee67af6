"""Find blocks at the wrong depth in a valid YAML file: the move after which the schema accepts more of the file.

A key one level too far out belongs to another map, and may be unknown there or mean something else: `onDone` among the
states is a state. A message about that would mislead. So blocks near a finding are moved. If a move removes complaints
and adds none, the indentation was the mistake. Of the moves that remove the most, the shortest one becomes the hint; if
two are equally short, in and out, the hint names both.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from lumen.language.diagnostics import NodePath
from lumen.language.text_lines import lines_of
from lumen.project.complaints import MISSING_KEY, ONE_VERB, UNKNOWN_KEY, WRONG_KEY, WRONG_TYPE, Complaint
from lumen.project.document import Document
from lumen.project.indentation import LineMove, holder, indent, is_content, move_hint, shifted

MAX_TRIES = 12
"""The maximum number of moves that are tried in one file."""

MAX_COMPLAINTS = 24
"""The maximum number of complaints of a file for which moves are sought: each needs a search of the lines above."""

MAX_CHARACTERS = 300_000
"""The maximum number of characters in all trials of a file: less than a second of work, as an editor needs."""

MAX_LEVELS = 3
"""The maximum number of levels by which a block may be too far in, or out."""

_CODES = frozenset((MISSING_KEY, ONE_VERB, UNKNOWN_KEY, WRONG_KEY, WRONG_TYPE))
_BEGINNING = re.compile(r"( *)(- +)?(?:([^\s\"'#\[\]{},:][^\s:]*):(?= |$))?")

CheckedAgain = Callable[[str], list[Complaint] | None]
"""A function that returns all complaints about the text of a file; None if it is not YAML."""


_What = tuple[str, str, str]


class KeyNames(NamedTuple):
    """The names in a schema."""

    declared: frozenset[str]
    """All names of properties, at any depth."""
    open: frozenset[str]
    """The keys of maps whose own keys are chosen by the author, such as `states`."""


def key_names(schema: Mapping[str, Any]) -> KeyNames:
    """Return the names of the keys that a schema declares at any depth."""
    declared, free, waiting = set[str](), set[str](), [schema]
    while waiting:
        item = waiting.pop()
        if isinstance(item, dict):
            properties = item.get("properties")
            for name, inner in properties.items() if isinstance(properties, dict) else ():
                declared.add(name)
                if _is_open(inner, schema):
                    free.add(name)
            waiting += item.values()
        elif isinstance(item, list):
            waiting += item
    return KeyNames(frozenset(declared), frozenset(free))


def _is_open(schema: Any, root: Mapping[str, Any]) -> bool:
    for _ in range(5):
        if not isinstance(schema, dict) or "$ref" not in schema:
            break
        schema = root.get("$defs", {}).get(schema["$ref"].rpartition("/")[2])
    named = ("additionalProperties", "patternProperties", "propertyNames")
    return (
        isinstance(schema, dict) and "properties" not in schema and any(isinstance(schema.get(k), dict) for k in named)
    )


def misindented(
    document: Document, found: Sequence[Complaint], names: KeyNames, judge: CheckedAgain
) -> Mapping[Complaint, str]:
    """Return the complaints that wrong indentation caused, each with a hint; an empty hint for those to leave out.

    `found` are all complaints about the document, and `judge` returns those about a changed text.
    """
    lines, before = lines_of(document.text), Counter(map(_what, found))
    if not document.spans:
        return {}
    complained = {row for complaint in found for row in _rows(complaint, document, lines)}
    solved: dict[Complaint, str] = {}
    tried: set[LineMove] = set()
    tries = min(MAX_TRIES, MAX_CHARACTERS // max(1, len(document.text)))
    sought = 0
    for complaint in found:
        if len(tried) >= tries or sought >= MAX_COMPLAINTS:
            break
        if complaint in solved or complaint.suggestion or complaint.code not in _CODES:
            continue
        sought += 1
        best, gone, rest = list[LineMove](), Counter[_What](), before
        for move in _moves(complaint, document, lines, names, complained):
            if len(tried) >= tries or (not rest and not _is_opposite(move, best[0])):
                break
            if move in tried:
                continue
            tried.add(move)
            mended = list(lines)
            for row in move.rows:
                mended[row] = shifted(lines[row], move.shift)
            after = judge("\n".join(mended))
            if after is None or (left := Counter(map(_what, after))) - before:
                continue
            less = before - left
            if less[_what(complaint)] and less.total() > gone.total():
                best, gone, rest = [move], less, left
            elif best and less == gone and _is_opposite(move, best[0]):
                best.append(move)
                break
        those = [c for c in found if c not in solved and gone[_what(c)] > 0]
        if best and those:
            solved |= dict.fromkeys(those, "")
            solved[_first(those, best[0], document, lines)] = move_hint(lines, *best)
    return solved


def _is_opposite(move: LineMove, other: LineMove) -> bool:
    """Return True if both move the same line by the same number of spaces, one in and one out."""
    return move.rows[0] == other.rows[0] and move.shift == -other.shift


def _first(those: Sequence[Complaint], move: LineMove, document: Document, lines: Sequence[str]) -> Complaint:
    """Return the complaint to report of those that a move removes.

    That is one about an empty value, else about a missing key, else about the moved line.
    """
    empty = (c for c in those if _is_empty(c, document))
    missing = (c for c in those if c.missing)
    near = (c for c in those if move.rows[0] in _rows(c, document, lines)[:1])
    return next(empty, None) or next(missing, None) or next(near, those[0])


def _what(complaint: Complaint) -> _What:
    """Return the parts of a complaint that do not depend on its place in the file, which a move changes."""
    return complaint.code, complaint.message, complaint.missing


def _is_empty(complaint: Complaint, document: Document) -> bool:
    """Return True if the complaint is about a value that is missing because its lines are too far out."""
    if complaint.code != WRONG_TYPE or complaint.path not in document.spans:
        return False
    value = document.spans[complaint.path].value
    return (value.line, value.column) == (value.end_line, value.end_column)


def _rows(complaint: Complaint, document: Document, lines: Sequence[str]) -> list[int]:
    """Return the indices of the lines in which the keys begin that a complaint may be about, the innermost first."""
    paths: list[NodePath] = [
        complaint.path[:n] for n in range(len(complaint.path), max(len(complaint.path) - 3, 0), -1)
    ]
    if complaint.missing:
        paths.insert(0, (*complaint.about[:-1], complaint.missing))
    rows = []
    for path in paths:
        place = (span := document.spans.get(path)) and (span.key or span.value)
        if place and not lines[place.line - 1][: place.column - 1].strip(" -"):
            rows.append(place.line - 1)
    return list(dict.fromkeys(rows))


def _moves(
    complaint: Complaint, document: Document, lines: Sequence[str], names: KeyNames, complained: set[int]
) -> Iterator[LineMove]:
    """Yield the moves that may remove a complaint, the likeliest first."""
    rows = _rows(complaint, document, lines)
    empty = bool(rows) and _is_empty(complaint, document)
    if empty:
        below = next((i for i in range(rows[0] + 1, len(lines)) if is_content(lines[i])), None)
        if below is not None and indent(lines[below]) <= indent(lines[rows[0]]):
            rows.insert(0, below)
    elif rows:
        above = next((i for i in range(rows[0] - 1, -1, -1) if is_content(lines[i])), None)
        if above is not None and lines[above].rstrip().endswith(":") and indent(lines[above]) >= indent(lines[rows[0]]):
            rows.append(above)
    for row in rows:
        block = _block(lines, row)
        group = _group(lines, row, complained)
        cut = next((i for i in block[1:] if i in complained and is_content(lines[i])), row + 1)
        for depth in _depths(lines, row):
            if not _is_sensible(lines, row, depth, names, empty, complaint.path[-1:]):
                continue
            for part in dict.fromkeys((group, block, tuple(range(row, cut)), (row,))):
                yield LineMove(part, depth - indent(lines[row]))


def _block(lines: Sequence[str], row: int) -> tuple[int, ...]:
    """Return the indices of line `row` and of those below it that are indented further, or are items of its list."""
    end = row + 1
    for i in range(row + 1, len(lines)):
        if is_content(lines[i]):
            if indent(lines[i]) <= indent(lines[row]) and not (
                _starts(lines[row])[1] == 0 and _is_item_of(lines, row, i)
            ):
                break
            end = i + 1
    return tuple(range(row, end))


def _is_item_of(lines: Sequence[str], row: int, i: int) -> bool:
    """Return True if the line `i` is an item of the list of a key in the same column."""
    return indent(lines[i]) == indent(lines[row]) and _starts(lines[i])[1] > 0 and lines[row].rstrip().endswith(":")


def _group(lines: Sequence[str], row: int, complained: set[int]) -> tuple[int, ...]:
    """Return the rows of the block at `row` and of the blocks after it in the same column that have complaints too."""
    rows = _block(lines, row)
    while True:
        following = next((i for i in range(rows[-1] + 1, len(lines)) if is_content(lines[i])), None)
        if following not in complained or following is None or indent(lines[following]) != indent(lines[row]):
            return rows
        rows = tuple(range(row, _block(lines, following)[-1] + 1))


def _depths(lines: Sequence[str], row: int) -> list[int]:
    """Return the depths [spaces] that may have been meant for a line, the nearest first; of two as near, the inner."""
    here, inner, outer = indent(lines[row]), set[int](), set[int]()
    lowest = here
    for i in range(row - 1, -1, -1):
        if (here > lowest <= indent(lines[i])) or not is_content(lines[i]):
            continue
        depth, item = _starts(lines[i])
        bare = lines[i].rstrip().endswith(":") and depth + item <= here
        found = {depth, depth + item} | ({depth + item + 2} if bare else set())
        if depth < lowest:
            outer |= {d for d in found if d < here}
            inner |= {d for d in found if d > here and lowest == here}
            lowest = depth
        elif lowest == here:
            inner |= {d for d in found if d > here}
        if lowest == 0 and depth == 0 and here > 0:
            break
    levels = [*sorted(inner)[:MAX_LEVELS], *sorted(outer, reverse=True)[:MAX_LEVELS]]
    return sorted(levels, key=lambda depth: abs(depth - here))


def _starts(line: str) -> tuple[int, int]:
    """Return the number of spaces before a line, and the width of its list hyphen with the spaces after it."""
    found = _BEGINNING.match(line)
    assert found
    return len(found[1]), len(found[2] or "")


def _is_sensible(lines: Sequence[str], row: int, depth: int, names: KeyNames, empty: bool, about: NodePath) -> bool:
    """Return True if a move keeps the schema's keys in maps of such keys, and the author's names in maps of names.

    `about` is the last key of the complaint; if its value is `empty`, any name may move under it.
    """
    found = _BEGINNING.match(lines[row])
    assert found
    if found[2] or not found[3]:
        return True
    key, before, after = found[3], holder(lines, row, indent(lines[row])), holder(lines, row, depth)
    if empty and about == (after,) != (key,):
        return True
    if key in names.declared:
        return after not in names.open
    return after in names.open and (empty or before not in names.open or before == after)
