"""The keys of `hears`: names of phrases and answers, `ENTRY.FIELD` of a `for`, after `not` or `asked`; or `else`."""

from itertools import pairwise
from typing import Literal

from lumen.interpreters.expressions.expression_findings import UNKNOWN_PHRASE
from lumen.interpreters.talk.speech import TABLES, WORD_LISTS
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.loading.document_report import DocumentReport
from lumen.loading.expressions import Expressions

BAD_ROW = Code("bad-row", "conversation", ERROR, "a key of `hears` can't be read")
RowWay = Literal["", "not", "asked", "else"]


class HearsKeys:
    """Reads the keys of `hears` of one document."""

    def __init__(self, report: DocumentReport, expressions: Expressions) -> None:
        self.report, self.expressions = report, expressions
        tables = expressions.words.tables
        self.names = {*tables["phrases"], *tables["answers"]} - {*WORD_LISTS, *TABLES}

    def read(self, key: str, where: NodePath) -> tuple[RowWay, tuple[str, ...]]:
        """The way and the names of a key; no way and no names (and reported) if it can't be read."""
        if key == "else":
            return "else", ()
        words = key.split()
        way: RowWay = ""
        if len(words) > 1 and words[0] in ("not", "asked"):
            way = "not" if words[0] == "not" else "asked"
        rest = "".join(words[bool(way) :])
        named = words[bool(way) :]
        if any(not a.endswith("|") and not b.startswith("|") for a, b in pairwise(named)):
            hint = f"write `{'|'.join(words)}` for any of them, or `not {words[-1]}` if it was refused"
            self.report(BAD_ROW, where, f"`{key}` is no row of `hears`", hint, key=True)
            return "", ()
        found = [self.name(name, where) for name in rest.split("|")]
        return (way, tuple(filter(None, found))) if all(found) else ("", ())

    def name(self, name: str, where: NodePath) -> str:
        """A name as the row holds it; empty (and reported) if nothing has it."""
        if name in self.names or (name and not self.expressions.words.whole and "." not in name):
            return name
        entry, _, field = name.partition(".")
        variables = self.expressions.rounds.variables(where)
        if field and entry in variables:
            return f"{variables[entry]}.{field}"
        if not name:
            hint = "name phrases, such as `yes|no`"
            self.report(BAD_ROW, where, "a name is missing beside `|`", hint, key=True)
        elif name == "else":
            hint = "give `else` a row of its own"
            self.report(
                BAD_ROW, where, "`else` can't be joined with names: it is for every other sentence", hint, key=True
            )
        else:
            hint = did_you_mean(name, self.names, "there are")
            self.report(UNKNOWN_PHRASE, where, f"there are no phrases or answers named `{name}`", hint, key=True)
        return ""
