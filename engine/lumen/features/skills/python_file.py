"""Checks a skill's Python file without running it: its function, and the function's parameters."""

import ast
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.language.diagnostics import did_you_mean

_KINDS = {"int": "integer", "float": "number", "str": "string", "bool": "boolean", "dict": "object", "list": "array"}
"""The Python types that an annotation can name, and their JSON Schema types."""


class CodeFault(NamedTuple):
    """A fault in a Python file; lines and columns count from 1, and the end is exclusive."""

    line: int
    column: int
    end_column: int
    message: str
    hint: str


def syntax_fault(content: bytes, file: str) -> CodeFault | None:
    """Return the fault that keeps Python from parsing a file; None if it can be parsed."""
    read = _read(content, file)
    return read if isinstance(read, CodeFault) else None


def _read(content: bytes, file: str) -> ast.Module | CodeFault:
    try:
        return ast.parse(content, file)
    except SyntaxError as error:
        line, column = error.lineno or 1, error.offset or 1
        end = error.end_offset or 0
        last = end if error.end_lineno in (None, line) and end > column else column + 1
        return CodeFault(line, column, last, f"Python can't read this: {error.msg}", "correct this line")
    except ValueError as error:  # a NUL
        return CodeFault(1, 1, 2, f"Python can't read this file: {error}", "save it as text in UTF-8")
    except (RecursionError, MemoryError):
        return CodeFault(1, 1, 2, "this file is nested too deeply to be read", "simplify it")


def code_faults(content: bytes, file: str, skill: str, arguments: Mapping[str, Any]) -> Iterator[CodeFault]:
    """Yield the faults of a file that contains the code of `skill`, whose schema `in` is `arguments`."""
    read = _read(content, file)
    if isinstance(read, CodeFault):
        yield read
        return
    functions = [node for node in _functions(read.body) if _marked(node)]
    function = next((each for each in functions if each.name == skill), None)
    if function is None:
        message, example = (
            f"no function `{skill}` is marked with `@skill` here",
            f"`@skill` above `def {skill}(call, …):`",
        )
        if len(functions) == 1:
            (other,) = functions
            yield _at(other, len("def"), message, f"rename `{other.name}` to `{skill}`, or write {example}")
        else:
            yield CodeFault(1, 1, 2, message, f"write {example}")
    elif isinstance(function, ast.AsyncFunctionDef):
        message = f"`{skill}` is an `async` function, which no skill can be"
        yield _at(function, len("async"), message, f"write `def {skill}(…):`; `call.wait` waits")
    else:
        yield from _parameters(function, arguments)


_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


def _functions(statements: Iterable[ast.AST]) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    """Yield all functions in statements, including those nested in classes, branches and functions."""
    for statement in statements:
        if isinstance(statement, _FUNCTIONS):
            yield statement
        for block in _BLOCKS:
            if inner := getattr(statement, block, None):
                yield from _functions(inner)


_BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")
"""The fields of AST nodes that contain statements."""


def _marked(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Return whether a function has the decorator `@skill` or `@….skill`, however it was imported."""
    names = {each.id for each in function.decorator_list if isinstance(each, ast.Name)}
    return "skill" in names | {each.attr for each in function.decorator_list if isinstance(each, ast.Attribute)}


def _parameters(function: ast.FunctionDef, schema: Mapping[str, Any]) -> Iterator[CodeFault]:
    """Yield the differences between a function's parameters and its skill's arguments."""
    properties, required = schema.get("properties", {}), schema.get("required", ())
    given = function.args
    positional = [*given.posonlyargs, *given.args]
    if not positional:
        message = f"`{function.name}` needs a first parameter, which gets the call"
        yield _at(function, len("def"), message, f"write `def {function.name}(call, …):`")
        return
    with_default = {each.arg for each in positional[len(positional) - len(given.defaults) :]}
    with_default |= {each.arg for each, value in zip(given.kwonlyargs, given.kw_defaults, strict=True) if value}
    named = [*positional[1:], *given.kwonlyargs]
    unknown = False
    for each in named:
        inner = properties.get(each.arg)
        if inner is None and each.arg not in with_default:
            unknown = True
            hint = did_you_mean(each.arg, properties, "`in` has") if properties else "describe it under `in`"
            yield _at(each, len(each.arg), f"`{each.arg}` is no argument in the manifest of `{function.name}`", hint)
        elif inner is not None and each.arg not in (*required, *with_default) and "default" not in inner:
            message = f"`{each.arg}` can be left out, but this parameter has no default"
            yield _at(each, len(each.arg), message, f"write `{each.arg}=None`, or give it a `default` in the manifest")
        elif isinstance(inner, Mapping):
            yield from _annotation(each, inner)
    if given.kwarg is None and not unknown:  # an unknown parameter is probably a misspelt argument
        known = {each.arg for each in named}
        for name in properties:
            if name not in known:
                message = f"`{function.name}` has no parameter for the argument `{name}`"
                hint = f"write `def {function.name}({', '.join([positional[0].arg, *known, name])}):`"
                yield _at(function, len("def"), message, hint)


def _annotation(parameter: ast.arg, schema: Mapping[str, Any]) -> Iterator[CodeFault]:
    """Yield a fault if the annotation's type differs from the type in the argument's schema."""
    said, kind = parameter.annotation, schema.get("type")
    if not (isinstance(said, ast.Name) and said.id in _KINDS and isinstance(kind, str)):
        return
    if _KINDS[said.id] != kind and (said.id, kind) != ("float", "integer"):
        wanted = next((name for name, other in _KINDS.items() if other == kind), "None")
        message = f"`{parameter.arg}` is `{said.id}` here, and `{kind}` in the manifest"
        yield _at(said, len(said.id), message, f"write `{parameter.arg}: {wanted}`, or change the manifest")


def _at(node: ast.expr | ast.arg | ast.stmt, length: int, message: str, hint: str) -> CodeFault:
    return CodeFault(node.lineno, node.col_offset + 1, node.col_offset + 1 + length, message, hint)
