"""The verbs that features and the files of a project add: which rows are usable, and how long each verb takes."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache

from lumen.errors import BadCommandError, ExpressionError
from lumen.expressions import Scope, compile_template, split_template, substituted
from lumen.expressions.json_schema import JsonSchema
from lumen.feature import Feature, VerbRow, rows
from lumen.language.added_verbs import added_row, added_verbs, argument_schema
from lumen.language.body_parts import PARTS
from lumen.language.commands import Do
from lumen.language.diagnostics import did_you_mean
from lumen.language.durations import seconds
from lumen.language.verbs import is_built_in


@cache
def usable_verbs() -> Mapping[str, VerbRow]:
    """Return the verbs that features add, by name, without faulty rows, which would make a schema invalid."""
    return {name: row for name, row in added_verbs().items() if not _fault(name, row)}


@dataclass(frozen=True)
class OwnVerbs:
    """The verbs that the files of one project declare, by name."""

    rows: Mapping[str, VerbRow] = field(default_factory=dict, compare=False)
    hash: str = ""
    """The hash of the files with verbs.

    Values with the same hash are equal, so results derived from them can be cached.
    """

    @property
    def all(self) -> Mapping[str, VerbRow]:
        """The project's own verbs and those of features; a feature's verb replaces one of the same name."""
        return {**self.rows, **usable_verbs()}


NO_VERBS = OwnVerbs()
"""The verbs of a project that declares none, and of files without a project."""


def faulty_verbs() -> Iterator[tuple[Feature, str]]:
    """Yield the feature and the fault of each verb row that can't be used."""
    for feature, (name, row) in rows("verbs"):
        if fault := _fault(name, row):
            yield feature, f"its verb `{name}` is ignored: {fault}"


def _fault(name: str, row: VerbRow) -> str:
    if is_built_in(name):
        return "a verb of Lumen has that name"
    for kind, schema in (("arguments", argument_schema(row)), ("result", row.result)):
        if not JsonSchema(schema).is_sound:
            return f"`{kind}` is not a JSON Schema"
    if unknown := [part for part in row.parts if part not in PARTS]:
        return f"`parts` has `{unknown[0]}`, which is no part of a body: {did_you_mean(unknown[0], PARTS, 'there are')}"
    return takes_fault(row)


def takes_fault(row: VerbRow) -> str:
    """Return what is wrong with a row's `takes`, the time that its verb needs; empty if nothing is."""
    try:
        computed = _duration(row, row.arguments.get("properties", ()))
    except ExpressionError as error:
        return f"`takes` is faulty: {error}"
    return "" if computed or seconds(row.takes) is not None else f"`takes` is `{row.takes}`, which is no duration"


def time_taken(command: Do) -> float:
    """Return how long an added verb takes with these arguments [s].

    Raises BadCommandError if no feature here has the verb, or if `takes` of its row gives no duration.
    """
    if (row := added_row(command)) is None:
        raise BadCommandError(f"no feature here has a verb `{command.skill}`")
    try:
        compute = _duration(row, (*row.arguments.get("properties", ()), *command.arguments))
        text = compute(Scope(context=command.arguments)) if compute else row.takes
    except ExpressionError as error:
        raise BadCommandError(f"how long `{command.skill}` takes is not known: {error}") from None
    if (found := seconds(text)) is None:
        raise BadCommandError(f"how long `{command.skill}` takes is not known: `{text}` is no duration such as `2s`")
    return found


def _duration(row: VerbRow, names: Iterable[str]) -> Callable[[Scope], str] | None:
    """Return the function that computes the text of `takes` from arguments of these names; None if it has no holes."""
    parts = split_template(row.takes)
    variables = {name: f"context.{name}" for name in names}
    if all(isinstance(part, str) for part in parts):
        return None
    return compile_template("".join(part if isinstance(part, str) else _hole(part.source, variables) for part in parts))


def _hole(source: str, names: Mapping[str, str]) -> str:
    return "{{ " + substituted(source, names, localized=False) + " }}"
