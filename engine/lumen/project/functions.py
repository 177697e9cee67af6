"""The functions of a project, `functions/NAME.yaml`: each file is read by itself, then all are put together."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import isfinite
from typing import Any

from lumen.errors import ExpressionError
from lumen.expressions.checker import check_tree, kinds_of
from lumen.expressions.expression_findings import EXPRESSION_SYNTAX, Declarations
from lumen.expressions.function_table import all_functions
from lumen.expressions.kinds import KINDS, kind_of
from lumen.expressions.own_functions import OwnFunction, called, expanded
from lumen.expressions.parser import parse_expression
from lumen.expressions.pratt import CONSTANTS
from lumen.expressions.scope import ROOTS
from lumen.expressions.tree import ExpressionNode, FunctionCall, Identifier, walk
from lumen.expressions.value_types import JSON_TYPES
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, Place, Related, did_you_mean, has_errors
from lumen.language.functions import FunctionDefinition, FunctionExample
from lumen.project.built_file import BuiltFile
from lumen.project.document_report import DocumentReport
from lumen.project.expressions import expanded_here, place_within

FUNCTION_CIRCLE = Code("function-circle", "references", ERROR, "functions of the project call each other in a circle")
FUNCTION_EXAMPLE = Code(
    "function-example", "expressions", ERROR, "an example does not fit the arguments of its function"
)
FUNCTION_NAME = Code("function-name", "expressions", ERROR, "a function or an argument has a name that it can't have")
UNUSED_ARGUMENT = Code("unused-argument", "references", WARNING, "a function does not use one of its arguments")

_RESERVED = frozenset((*CONSTANTS, "and", "or", "not", "is", "in", "if", "None", "True", "False"))
_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_EXPRESSION: NodePath = ("expression",)


@dataclass(frozen=True)
class FunctionFile:
    """The content of one file, before the other functions are known."""

    name: str
    parameters: Mapping[str, tuple[str, ...]]
    """The kinds of value that each argument accepts, by the argument's name."""
    description: Mapping[str, str]
    """The description by language; under an empty key if it has no language."""
    expression: str
    tree: ExpressionNode | None
    """The parsed expression; None if the expression has a syntax error."""
    examples: tuple[FunctionExample, ...]


def build_function(data: Any, report: DocumentReport, *, name: str) -> FunctionFile | None:
    """Return the function in the data of `functions/NAME.yaml`, or None if it has no expression."""
    if not isinstance(data, Mapping) or not isinstance(data.get("expression"), str):
        return None
    _check_name(name, report)
    description = data.get("description") or {}
    parameters = {str(key): tuple(str(kinds).split("|")) for key, kinds in (data.get("args") or {}).items()}
    for argument in parameters:
        _check_argument(argument, report)
    source, tree = data["expression"], None
    try:
        tree = parse_expression(source)
    except ExpressionError as error:
        place = place_within(report.document, _EXPRESSION, source, error.offset, 1)
        report.diagnostics.append(EXPRESSION_SYNTAX.at(place, error.message, error.hint))
    return FunctionFile(
        name,
        parameters,
        description if isinstance(description, Mapping) else {"": str(description)},
        source,
        tree,
        tuple(_examples(data, parameters, report)),
    )


def joined(
    files: Mapping[str, BuiltFile[FunctionFile]], names: frozenset[str]
) -> tuple[dict[str, FunctionDefinition], dict[str, OwnFunction | None]]:
    """Return the functions without faults, and all functions as expressions see them: None for a faulty one.

    Faults are reported in the function's file. `names` are those of all files, including unreadable ones.
    """
    return _Joining(files, names).join()


class _Joining:
    def __init__(self, files: Mapping[str, BuiltFile[FunctionFile]], names: frozenset[str]) -> None:
        self.files = {name: file.built for name, file in files.items() if file.built}
        self.reports = {name: file.report for name, file in files.items()}
        self.known: dict[str, OwnFunction | None] = {name: None for name in names if name not in all_functions()}
        self.calls = {name: tuple(self.called(file)) for name, file in self.files.items()}
        self.done: dict[str, FunctionDefinition] = {}

    def join(self) -> tuple[dict[str, FunctionDefinition], dict[str, OwnFunction | None]]:
        circular = self.circular()
        waiting = [name for name in sorted(self.files) if name not in circular]
        while waiting:
            ready = [n for n in waiting if not any(c.function in waiting for c in self.calls[n])]
            for name in ready or waiting:
                self.define(self.files[name], self.reports[name])
            waiting = [name for name in waiting if ready and name not in ready]
        return self.done, self.known

    def called(self, file: FunctionFile) -> list[FunctionCall]:
        """Return the calls of other functions of the project in a file's expression."""
        return called(file.tree, self.known) if file.tree else []

    def circular(self) -> set[str]:
        """Return the functions that call themselves, directly or through others; each circle is reported once."""
        found = set[str]()
        for name in sorted(self.files):
            way = self.way_back(name)
            if way and found.isdisjoint(call.function for call in way):
                self.say_circle(name, way)
            found |= {call.function for call in way}
        return found

    def way_back(self, name: str) -> list[FunctionCall]:
        """Return the shortest chain of calls from a function back to itself; empty if it does not call itself."""
        ways: list[list[FunctionCall]] = [[call] for call in self.calls[name]]
        seen = set[str]()
        while ways:
            way = ways.pop(0)
            at = way[-1].function
            if at == name:
                return way
            if at not in seen:
                seen.add(at)
                ways += [[*way, call] for call in self.calls.get(at, ())]
        return []

    def say_circle(self, name: str, way: list[FunctionCall]) -> None:
        steps = [name, *(call.function for call in way)]
        message = f"`{name}` calls itself"
        if len(way) > 1:
            message += " through others: " + ", ".join(f"`{a}` calls `{b}`" for a, b in pairwise(steps))
        related = [
            Related(self.place(at, call), f"`{at}` calls `{call.function}` here")
            for at, call in zip(steps[1:], way[1:], strict=False)
        ]
        hint = "a function can't repeat anything: use a state and a key of the context for that"
        found = FUNCTION_CIRCLE.at(self.place(name, way[0]), message, hint, tuple(related))
        self.reports[name].diagnostics.append(found)

    def place(self, name: str, call: FunctionCall) -> Place:
        source = self.files[name].expression
        return place_within(self.reports[name].document, _EXPRESSION, source, call.named, len(call.function))

    def define(self, file: FunctionFile, report: DocumentReport) -> None:
        """Check the expression of a function whose callees are already defined, then define the function."""
        if file.tree is None:
            return
        around = Declarations(
            context={},
            variables={name: _schema(kinds) for name, kinds in file.parameters.items()},
            functions=self.known,
            pure=True,
        )
        findings = check_tree(file.tree, around)
        for finding in findings:
            place = place_within(report.document, _EXPRESSION, file.expression, finding.offset, finding.length)
            report.diagnostics.append(finding.code.at(place, finding.message, finding.hint))
        meant = None if findings else expanded_here(expanded, file.expression, self.known, report, _EXPRESSION)
        if meant is None or file.name not in self.known:
            return
        used = {*_names_in(file.tree)}
        for argument in file.parameters:
            if argument not in used and not has_errors(report.diagnostics):
                message = f"`{file.name}` does not use its argument `{argument}`"
                report(UNUSED_ARGUMENT, ("args", argument), message, "use it in `expression`, or delete it", key=True)
        kinds = {name: KINDS if "any" in each else frozenset(each) for name, each in file.parameters.items()}
        returns = kinds_of(file.tree, around)
        self.known[file.name] = OwnFunction(kinds, returns, parse_expression(meant))
        self.done[file.name] = FunctionDefinition(
            file.name,
            file.parameters,
            tuple(sorted(returns)),
            file.description,
            file.expression,
            meant,
            file.examples,
        )


def _check_name(name: str, report: DocumentReport) -> None:
    """Report the name of a file if no expression can call a function of that name."""
    message, hint = "", "rename the file"
    if not _NAME.fullmatch(name):
        message = f"an expression can't call a function named `{name}`"
        hint = "rename the file: a name has letters, digits and `_`, and begins with a letter or `_`"
    elif name in all_functions():
        message = f"the function `{name}` comes with Lumen, and this file can't replace it"
    elif name in _RESERVED or name in ROOTS:
        message = f"`{name}` has a fixed meaning in expressions"
    if message:
        report.diagnostics.append(FUNCTION_NAME.at(Place(report.document.file), message, hint))


def _check_argument(name: str, report: DocumentReport) -> None:
    if name in _RESERVED or name in ROOTS or not _NAME.fullmatch(name):
        why = "has a fixed meaning in expressions" if name.isidentifier() else "can't be written in an expression"
        report(FUNCTION_NAME, ("args", name), f"`{name}` {why}", "choose another name for the argument", key=True)


def _examples(
    data: Mapping[str, Any], parameters: Mapping[str, tuple[str, ...]], report: DocumentReport
) -> Iterator[FunctionExample]:
    """Yield the examples whose arguments fit; report the others."""
    for i, row in enumerate(data.get("examples") or ()):
        where: NodePath = ("examples", i)
        given = row.get("args") or {}
        faults = [*_misfits(given, parameters, where)]
        for path, message, hint, key in faults:
            report(FUNCTION_EXAMPLE, path, message, hint, key=key)
        if not faults:
            yield FunctionExample(given, row["value"], where)


def _misfits(
    given: Mapping[str, Any], parameters: Mapping[str, tuple[str, ...]], where: NodePath
) -> Iterator[tuple[NodePath, str, str, bool]]:
    """Yield the faults of an example's arguments: path, message, hint, and whether to mark the key, not the value.

    Of the missing arguments, only the first is a fault, and only if no argument is unknown.
    """
    unknown = [name for name in given if name not in parameters]
    for name in unknown:
        hint = did_you_mean(name, parameters, "the arguments are") if parameters else "the function has no arguments"
        yield (*where, "args", name), f"the function has no argument `{name}`", hint, True
    missing = [name for name in parameters if name not in given]
    if missing and not unknown:
        message = f"the `args` of this example lack `{missing[0]}`" if given else f"this example lacks `{missing[0]}`"
        at = (*where, "args") if given else where
        yield at, message, f"write a value for `{missing[0]}` under `args`", bool(given)
    for name, value in given.items():
        kinds = parameters.get(name, ("any",))
        if not _finite(value):
            yield (*where, "args", name), f"`{name}` is not a finite number", "write a number", False
        elif "any" not in kinds and kind_of(value) not in kinds:
            needed = " or ".join(kinds)
            yield (*where, "args", name), f"`{name}` is a {kind_of(value)}, but must be a {needed}", "", False


def _finite(value: Any) -> bool:
    return not isinstance(value, float) or isfinite(value)


def _schema(kinds: tuple[str, ...]) -> Mapping[str, Any]:
    """Return the JSON Schema of an argument."""
    if "any" in kinds:
        return {}
    return {"type": [name for name, kind in JSON_TYPES.items() if kind in kinds and name != "integer"]}


def _names_in(tree: ExpressionNode) -> Iterator[str]:
    yield from (node.name for node, _ in walk(tree) if isinstance(node, Identifier))
