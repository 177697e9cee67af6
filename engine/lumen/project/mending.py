"""Find the mistake in a file that is not YAML: the change that lets a parser get furthest.

A parser fails late: some lines after an unclosed quote, or where the next state after a misplaced one begins. So
possible slips are sought in the lines before, and the correction of each is tried. The slip whose correction makes
the file valid YAML was the mistake. A corrected text has as many lines as before.
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
"""The maximum number of changes that are tried."""

MAX_JUDGED = 12
"""The maximum number of changes that make a file valid YAML and are compared by the faults that its schema finds."""

MAX_CHARACTERS = 200_000
"""The maximum length of a text that is searched [characters]."""

MAX_READ = 1_000_000
"""The maximum number of characters parsed for all trials together."""

MAX_LINE = 400
"""The maximum length of a line that is searched [characters]: people write shorter ones."""

LINES_BACK = 3
"""The number of lines before the parser's error that are searched for a wrong sign."""

QUOTED_LINES_BACK = 400
"""The number of lines before the parser's error that are searched for an open quote or bracket."""


def mistake(
    text: str, row: int, failed: int, misfits: Callable[[str], int | None] | None = None
) -> tuple[Slip, str] | None:
    """Return the slip at or before the line `row`, and the corrected text; None if no change helps.

    A change helps if the parser then stops after the line `failed`; both lines count from 0. `misfits` returns the
    number of faults that the file's schema finds in a text, or None to refuse the text. Of several changes that make
    the file valid YAML, the one with the fewest misfits is returned.
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
    """Return the index of the line at which the parser stops; None for valid YAML, 0 if it is nested too deeply."""
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
    """Yield possible slips, the likeliest first: a sign, a quote, a bracket, a colon, a comma, the indentation."""
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
    """Yield slips for brackets further up that no line before the error closes."""
    end = row - 1
    while end > 0 and not lines[end].strip():
        end -= 1
    for i in range(end, max(end - QUOTED_LINES_BACK, 0) - 1, -1):
        if len(lines[i]) <= MAX_LINE and (marks := marks_of(lines[i])).open and not marks.quote:
            sign, column = marks.open[-1]
            stop, close = marks_of(lines[end]).stop, closers(marks.open[-1:])
            meant = {end: lines[end][:stop] + close + lines[end][stop:]}
            yield Slip(i + 1, column + 1, 1, *not_closed(sign, close), meant)
