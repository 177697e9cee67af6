"""The functions of the language by name, made from the rows of manifests."""

import json
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, NamedTuple

from lumen.errors import LumenError
from lumen.expressions.functions import CAUGHT, caught
from lumen.expressions.kinds import KINDS, MAP, NUMBER, FaultError, WrongKindError, kind_of
from lumen.expressions.operators import bounded
from lumen.feature import FunctionRow, described, distribution_of, owner, resolve, table

KindSet = frozenset[str]


class Function(NamedTuple):
    """A function of the language."""

    parameters: tuple[KindSet, ...]
    """The kinds that each argument may have."""
    returns: KindSet
    """The kinds that its value may have."""
    call: Callable[..., Any]
    """The implementation; it receives the Scope first if `scoped`, then the arguments."""
    scoped: bool = False
    """Whether the function receives the Scope before its arguments."""


@cache
def functions() -> Mapping[str, Function]:
    """Return the functions that files may call."""
    return {name: _function(name, row) for name, row in table("functions").items()}


@cache
def all_functions() -> Mapping[str, Function]:
    """Return the functions that compiled expressions call: `caught` too, which no file may call."""
    heard = Function((frozenset((NUMBER,)),), frozenset((MAP,)), caught, scoped=True)
    return {**functions(), CAUGHT: heard}


@cache
def clock_functions() -> frozenset[str]:
    """Return the names of the functions that read the time of day."""
    return frozenset(name for name, row in table("functions").items() if row.clock)


@cache
def drawing_functions() -> frozenset[str]:
    """Return the names of the functions that draw random values: they are allowed only in `assign`.

    Only actions advance the state of the random generator.
    """
    return frozenset(name for name, row in table("functions").items() if row.draws)


def example_of(name: str) -> str:
    """Return the arguments of a function as an example writes them; empty if its row has no example."""
    rows = table("functions")
    return str(rows[name].example) if name in rows else ""


@cache
def fault_of(name: str) -> str:
    """Return why the code of a function can't be imported, with its package; empty if it can be imported."""
    rows = table("functions")
    try:
        fault = "" if name not in rows or callable(resolve(rows[name].call)) else "it is not a function"
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # the code is not Lumen's, so even SystemExit is caught
        fault = described(error)
    return fault and f"{fault}{_package(name)}"


def _package(name: str) -> str:
    """Return the distribution that provides a function, for the end of a message; empty if it comes with Lumen."""
    distribution = distribution_of(owner("functions", name))
    return f" (package {distribution})" if distribution else ""


def _function(name: str, row: FunctionRow) -> Function:
    parameters = tuple(map(_kinds, row.parameters))
    if not row.exact:
        call = _checked(name, row, parameters)
    else:  # one of a package is imported when it is called, because its import may fail
        call = (lambda *given: _called(name, row, given)) if _package(name) else resolve(row.call)
    return Function(parameters, _kinds(row.returns), call, row.scoped)


def _kinds(kinds: str) -> KindSet:
    return KINDS if kinds == "any" else frozenset(kinds.split("|"))


def _checked(name: str, row: FunctionRow, parameters: tuple[KindSet, ...]) -> Callable[..., Any]:
    """Return a function that imports the row's function at its first call, and checks the arguments and the value."""
    first, returns = int(row.scoped), _kinds(row.returns)

    def call(*arguments: Any) -> Any:
        for position, (value, kinds) in enumerate(zip(arguments[first:], parameters, strict=True)):
            if kind_of(value) not in kinds:
                raise WrongKindError(position, value, *sorted(kinds))
        value = bounded(_plain(name, _called(name, row, arguments)))
        if kind_of(value) not in returns:
            raise FaultError(f"`{name}` returned {kind_of(value)}, but its row says {row.returns}{_package(name)}")
        return value

    return call


def _called(name: str, row: FunctionRow, arguments: tuple[Any, ...]) -> Any:
    """Return the value of a function. Raises FaultError for any exception of an installed package's code."""
    try:
        return resolve(row.call)(*arguments)
    except (KeyboardInterrupt, LumenError, FaultError, WrongKindError):
        raise
    except BaseException as error:  # the package's code may even raise SystemExit
        if not (package := _package(name)):
            raise
        raise FaultError(f"this can't be evaluated: `{name}` raised {described(error)}{package}") from error


def _plain(name: str, value: Any) -> Any:
    """Return a value as JSON data. Raises FaultError if it is not JSON data."""
    try:
        return json.loads(json.dumps(value, allow_nan=False))
    except (TypeError, ValueError) as error:
        raise FaultError(f"`{name}` returned a value that is not JSON data: {error}{_package(name)}") from None
