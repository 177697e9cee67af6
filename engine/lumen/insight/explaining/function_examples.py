"""The examples of a project's functions as tests: each call must return the value in its file."""

import json
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from lumen.errors import ExpressionError
from lumen.expressions.compiler import compile_expression
from lumen.expressions.operators import equal
from lumen.expressions.own_functions import literal, with_arguments
from lumen.expressions.parser import parse_expression
from lumen.expressions.printer import unparse
from lumen.expressions.scope import Scope
from lumen.language.folders import FUNCTIONS_FOLDER
from lumen.language.functions import FunctionDefinition, FunctionExample


class TriedExample(NamedTuple):
    """The result of one example."""

    file: str
    """The file of the function, relative to the project."""
    example: FunctionExample
    """The example with its arguments and expected value."""
    call: str
    """The call as it would be written in an expression."""
    wrong: str
    """The difference from the expected value, in words; empty if the values are equal."""


def tried_examples(functions: Iterable[FunctionDefinition]) -> Iterator[TriedExample]:
    """Yield the result of each example of these functions."""
    for function in functions:
        for example in function.examples:
            given = ", ".join(_shown(example.arguments[name]) for name in function.parameters)
            file = f"{FUNCTIONS_FOLDER}/{function.name}.yaml"
            yield TriedExample(file, example, f"{function.name}({given})", _wrong(function, example))


def value_of(function: FunctionDefinition, example: FunctionExample) -> Any:
    """Return the value of a function for the arguments of an example. Raises ExpressionError if there is no value."""
    arguments = {name: literal(value) for name, value in example.arguments.items()}
    return compile_expression(unparse(with_arguments(parse_expression(function.expanded), arguments)))(Scope())


def _wrong(function: FunctionDefinition, example: FunctionExample) -> str:
    try:
        found = value_of(function, example)
    except ExpressionError as error:
        return f"it has no value, but should be {_shown(example.value)}: {error.message}"
    return "" if equal(found, example.value) else f"it is {_shown(found)}, but should be {_shown(example.value)}"


def _shown(value: Any) -> str:
    """Return a JSON value as written in an expression."""
    try:
        return unparse(literal(value))
    except TypeError:
        return json.dumps(value, default=str)
