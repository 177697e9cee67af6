"""Marks of tests that need a broker, physics or npm: derived from the names in their code, for every test.

The code of a test, of its fixtures and parameters, and of the helpers that they name is searched. Names in a string are
not found (`getfixturevalue`, the words of a command line): such a test is marked by hand, as are `slow` ones.
"""

from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from itertools import chain, zip_longest
from operator import attrgetter
from types import CodeType, FunctionType, ModuleType
from typing import Any

import pytest

from tests.fetched import fetched
from tests.guarded import Guarded, run_guarded
from tests.rabbitmq import LentBroker, RabbitMQ
from tests.suites import REAL

PHYSICS = ("lumen.features.simulation", "mujoco", "dm_control")
"""Modules that use MuJoCo."""
NETWORK = ("http.", "socket", "lumen.features.console.serving", "lumen.features.rabbitmq.broker", "lumen.bus.local")
"""Modules that open ports or connections."""
BROWSER = "tests.features.console.browser"
OWN_SERVERS = "own servers"
"""The group of tests with a broker of their own, which run one after another: one such broker at a time."""

REAL_TIMEOUT = 3600.0
"""The limit of a test with something real [s]: many waits that each end in time may take longer than other tests."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    for item in items:
        if isinstance(item, pytest.Function):
            fixtures = item._fixtureinfo.name2fixturedefs.values()
            used = [item.function, *(definition.func for found in fixtures for definition in found)]
            used += [value for value in parameters(item) if isinstance(value, FunctionType | type)]
            for mark in {mark for thing in used for mark in marks(thing)}:
                if mark != OWN_SERVERS:
                    item.add_marker(mark)
                elif not item.get_closest_marker("xdist_group"):
                    item.add_marker(pytest.mark.xdist_group(OWN_SERVERS))
            if has([item], *REAL) and not has([item], "soak"):
                item.add_marker(pytest.mark.timeout(REAL_TIMEOUT))
    if config.getoption("loadgroup", False):
        items[:] = grouped(items)


def grouped(items: Iterable[pytest.Item]) -> list[pytest.Item]:
    """Return the tests for several workers: those that share something belong to one, and long ones begin first.

    Tests with a broker wait most of the time, the others calculate: they take turns.
    """
    groups: dict[str, list[pytest.Item]] = {}
    for item in items:
        own = item.get_closest_marker("xdist_group")
        if own is None:
            item.add_marker(pytest.mark.xdist_group(shared(item)))
        groups.setdefault(own.args[0] if own else shared(item), []).append(item)
    waiting = [group for group in groups.values() if has(group, "broker")]
    busy = sorted((group for group in groups.values() if not has(group, "broker")), key=lambda g: not has(g, "slow"))
    turns = chain.from_iterable(zip_longest(waiting, busy, fillvalue=[]))
    return list(chain.from_iterable(turns))


def has(group: Iterable[pytest.Item], *wanted: str) -> bool:
    return any(item.get_closest_marker(mark) for item in group for mark in wanted)


def shared(item: pytest.Item) -> str:
    """Return the group of a test that has none yet: its file, whose tests have the same worker."""
    return item.nodeid.partition("::")[0]


def parameters(item: pytest.Function) -> Iterator[Any]:
    """Yield the values of a parametrized case and of all rows of a table (`tests.tables.for_each`)."""
    yield from item.callspec.params.values() if hasattr(item, "callspec") else ()
    for row in getattr(item.function, "rows", ()):
        yield from row.given.values()


@cache
def marks(thing: Any) -> frozenset[str]:
    """Return the needs of a function or a class of the tests."""
    found, seen, left = set(), set(), [thing]
    while left:
        one = left.pop()
        if id(one) in seen:
            continue
        seen.add(id(one))
        if one is RabbitMQ:
            found |= {"broker", OWN_SERVERS}
        elif one is LentBroker:
            found.add("broker")
        elif one is Guarded or one is run_guarded:
            found.add("process")
        elif one is fetched:
            found.add("npm")
        elif home(one).startswith(PHYSICS):
            found.add("physics")
        elif home(one).startswith(NETWORK):
            found.add("network")
        elif home(one).startswith("tests."):
            found.update(["browser"] * (home(one) == BROWSER))
            left += named(one)
    return frozenset(found)


def home(thing: Any) -> str:
    """Return the module that a function, class or module comes from; empty for anything else."""
    return thing.__name__ if isinstance(thing, ModuleType) else str(getattr(thing, "__module__", None) or "")


def named(thing: Any) -> Iterator[Any]:
    """Yield the objects that the code of a function, or of a class's functions, names in its module."""
    for wrapper in ("hypothesis.inner_test", "__wrapped__"):
        with suppress(AttributeError):
            thing = attrgetter(wrapper)(thing)
    if isinstance(thing, type):
        yield from thing.__bases__
        for member in vars(thing).values():
            yield from named(getattr(member, "fget", member))
    elif isinstance(thing, FunctionType):
        yield from (thing.__globals__[name] for name in names(thing.__code__) if name in thing.__globals__)


def names(code: CodeType) -> Iterator[str]:
    """Yield the names in a function's code, and in that of functions within it."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from names(constant)
