"""Read the keys of `hears`: names of phrases, answers or fields of a `for`, maybe after `not` or `asked`; or `else`."""

import re
from itertools import pairwise
from typing import Literal

from lumen.expressions.expression_findings import UNKNOWN_PHRASE
from lumen.language.diagnostics import ERROR, Code, NodePath, Place, did_you_mean
from lumen.language.text_lines import lines_of
from lumen.project.common_words import COMMON
from lumen.project.document_report import DocumentReport
from lumen.project.expressions import Expressions
from lumen.talk.speech import TABLES, WORD_LISTS

BAD_ROW = Code("bad-row", "hearing", ERROR, "a key of `hears` can't be read")
RowWay = Literal["", "not", "asked", "else"]

_OTHER_SIGNS = re.compile(r"[,;/&+]")
_BETWEEN = re.compile(r"[\s|,;/&+]+")
"""The separators that people write between names."""
_JOINING = frozenset(("and", "or", "dan", "atau", "und", "oder"))


class HearsKeys:
    """Reads the keys of `hears` of one document."""

    def __init__(self, report: DocumentReport, expressions: Expressions) -> None:
        self.report, self.expressions = report, expressions
        tables = expressions.words.tables
        self.names = {*tables["phrases"], *tables["answers"]} - {*WORD_LISTS, *TABLES}

    def read(self, key: str, where: NodePath) -> tuple[RowWay, tuple[str, ...]]:
        """Return the first word of a key, if it is `not`, `asked` or `else`, and the names in the key.

        Both are empty for a key that can't be read, which is reported.
        """
        if key == "else":
            return "else", ()
        words = key.split()
        way: RowWay = ""
        if len(words) > 1 and words[0] in ("not", "asked"):
            way = "not" if words[0] == "not" else "asked"
        rest = "".join(words[bool(way) :])
        named = words[bool(way) :]
        if _OTHER_SIGNS.search(rest) or any(not a.endswith("|") and not b.startswith("|") for a, b in pairwise(named)):
            names = [name for name in _BETWEEN.split(" ".join(named)) if name and name not in _JOINING]
            several = "|".join(names)
            hint = f"write `{way} {several}` for any of them" if way else f"write `{several}` for any of them"
            hint += "" if way else f", or `not {names[-1]}` for its negation" if names else ""
            self.report(BAD_ROW, where, f"`{key}` is not a valid row of `hears`", hint, key=True)
            return "", ()
        found = [self.name(name, where) for name in rest.split("|")]
        return (way, tuple(filter(None, found))) if all(found) else ("", ())

    def name(self, name: str, where: NodePath) -> str:
        """Return a name of phrases or answers, with the entry of a `for` replaced by its variable.

        Return an empty text for an unknown name, which is reported.
        """
        if name in self.names or (name and not self.expressions.words.whole and "." not in name):
            return name
        entry, _, field = name.partition(".")
        variables = self.expressions.rounds.variables(where)
        if field and entry in variables:
            return f"{variables[entry]}.{field}"
        if not name:
            hint = "write a name on each side, such as `yes|no`"
            self.report(BAD_ROW, where, "a name is missing next to `|`", hint, key=True)
        elif name == "else":
            hint = "write `else` as a separate row"
            self.report(
                BAD_ROW, where, "`else` can't be combined with names: it matches every other sentence", hint, key=True
            )
        else:
            hint, cause = did_you_mean(name, self.names, "there are"), ""
            if name in self.expressions.words.offered:
                hint, cause = f"they come with Lumen: add `{COMMON}` under `words` at the top", f"words {COMMON}"
            message = f"there are no phrases or answers named `{name}`"
            if not self.report.follows(UNKNOWN_PHRASE, message):
                found = UNKNOWN_PHRASE.at(self.place(name, where), message, hint, cause=cause)
                self.report.diagnostics.append(found)
        return ""

    def place(self, name: str, where: NodePath) -> Place:
        """Return the place of a name in the key at `where`; the place of the whole key if it lacks the name."""
        place = self.report.document.place(where, key=True)
        line = lines_of(self.report.document.text)[place.line - 1] if place.line == place.end_line else ""
        found = re.search(rf"(?<!\w){re.escape(name)}(?!\w)", line[place.column - 1 : place.end_column - 1])
        if found is None:
            return place
        start = place.column + found.start()
        return place._replace(column=start, end_column=start + len(name))
