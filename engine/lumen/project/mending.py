"""Where a file that is not YAML went wrong: the change to it that lets a reader get furthest.

A reader notices late: an unclosed quote some lines on, a state at the wrong depth where the next one begins. So what
may have slipped is looked for in the lines before, and each is tried: what makes the file YAML was the mistake. A
mended text has as many lines as it had.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import chain, islice

import yaml

from lumen.language.text_lines import lines_of
from lumen.project.bracketed_texts import bracketed
from lumen.project.document import MAX_NODE_DEPTH
from lumen.project.indentation import depths, items, too_deep
from lumen.project.line_marks import closers, marks_of
from lumen.project.slips import Slip, brackets, colons, flows, not_closed, quotes, signs
from lumen.project.yaml_composer import shielded

MAX_MENDS = 120
"""Changes that are tried."""

MAX_JUDGED = 12
"""Changes that make a file YAML and are compared by what its schema refuses after them."""

MAX_CHARACTERS = 200_000
"""Of a text in which it is looked for."""

MAX_READ = 1_000_000
"""Characters that are read in all to try changes."""

MAX_LINE = 400
"""Characters of a line in which it is looked for: people write shorter ones."""

LINES_BACK = 3
"""Lines before the one at which a reader stopped where a sign may have slipped."""

QUOTED_LINES_BACK = 400
"""Lines before it where a quote or a bracket may have been opened."""


def mistake(
    text: str, row: int, failed: int, misfits: Callable[[str], int | None] | None = None
) -> tuple[Slip, str] | None:
    """What slipped at or before the line `row`, and the text as it was meant; None where nothing lets a reader get
    further than to the line `failed` (both count from 0).

    `misfits` counts what the file's schema refuses in a text. Of several changes that make the file YAML, the one with
    the fewest misfits was the mistake.
    """
    if len(text) > MAX_CHARACTERS:
        return None
    lines, best, reached = lines_of(text), None, failed
    whole: tuple[Slip, str] | None = None
    fewest, judged = 0, 0
    at, left = min(row, len(lines) - 1), MAX_READ
    tried: set[tuple[tuple[int, str], ...]] = set()
    for slip in islice(chain(_candidates(lines, at), depths(lines, at)), MAX_MENDS):
        key = (*slip.meant.items(),)
        left -= len(text)
        if left < 0:
            break
        if key in tried or all(lines[i] == line for i, line in key):
            continue
        tried.add(key)
        mended = "\n".join(slip.meant.get(i, line) for i, line in enumerate(lines))
        stop = failure(mended)
        if stop is None:
            wrong = misfits(mended) if misfits else 0
            if wrong == 0:
                return slip, mended
            judged += 1
            if wrong is not None and (whole is None or wrong < fewest):
                whole, fewest = (slip, mended), wrong
            if judged >= MAX_JUDGED:
                break
            continue
        if stop > reached and not slip.only_whole:
            best, reached = (slip, mended), stop
    return whole or best


def failure(text: str) -> int | None:
    """The index of the line at which a reader of that text stops; None where it is YAML."""
    loader, depth = yaml.CSafeLoader(shielded(text)[0]), 0
    try:
        while loader.check_event():
            event = loader.get_event()
            depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
            if depth > MAX_NODE_DEPTH:
                return 0
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        return mark.line if mark else 0
    except yaml.YAMLError:
        return 0
    finally:
        loader.dispose()
    return None


def _candidates(lines: Sequence[str], row: int) -> Iterator[Slip]:
    """What may have slipped, the likeliest first: a sign, a quote, a bracket, a colon, a comma, the indentation."""
    near = [i for i in range(row, max(row - LINES_BACK, 0) - 1, -1) if len(lines[i]) <= MAX_LINE]
    far = [i for i in range(row, max(row - QUOTED_LINES_BACK, 0) - 1, -1) if len(lines[i]) <= MAX_LINE]
    for i in near:
        yield from signs(lines[i], i)
    for i in far:
        yield from quotes(lines[i], i)
    for i in near:
        yield from brackets(lines[i], i)
    yield from _open(lines, row)
    yield from too_deep(lines, row)
    for i in near:
        yield from items(lines, i)
        yield from bracketed(lines[i], i)
        yield from colons(lines[i], i)
        yield from flows(lines[i], i)


def _open(lines: Sequence[str], row: int) -> Iterator[Slip]:
    """A bracket of a line further up that is not closed in any line before the one at which a reader stopped."""
    end = row - 1
    while end > 0 and not lines[end].strip():
        end -= 1
    for i in range(end, max(end - QUOTED_LINES_BACK, 0) - 1, -1):
        if len(lines[i]) <= MAX_LINE and (marks := marks_of(lines[i])).open and not marks.quote:
            sign, column = marks.open[-1]
            stop, close = marks_of(lines[end]).stop, closers(marks.open[-1:])
            meant = {end: lines[end][:stop] + close + lines[end][stop:]}
            yield Slip(i + 1, column + 1, 1, *not_closed(sign, close), meant)
