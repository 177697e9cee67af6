"""Callables that enter an object after its constructor has ended.

Every object of the package that is made within `watched` is looked at when its constructor ends, and again at the end:
a callable that is then in an attribute, or in a list or table of an attribute, has entered. It has not if the object
got it by itself, such as the end of a subscription: its own method assigned it, or put it into a private collection,
and no method of the object was called with it.
"""

import sys
from collections import Counter, defaultdict, deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from enum import Enum
from functools import cached_property, partial, wraps
from types import CellType, FunctionType, MethodType, ModuleType
from typing import Any

_EMPTY = CellType()
"""The cell of a closure whose name has no value yet equals this one."""
COLLECTIONS = (list, tuple, set, frozenset, deque, dict)


class Watch:
    """The objects that were made, with the callables that each held at the end of its constructor."""

    def __init__(self, package: str) -> None:
        self._package = package
        self._made: dict[int, tuple[object, dict[str, list[Any]]]] = {}
        self._making: Counter[int] = Counter()
        self._own: dict[tuple[int, str], Any] = {}
        self._given: dict[int, list[Any]] = defaultdict(list)

    def entered(self, root: object) -> list[str]:
        """Return `Class.attribute: callable`, sorted, for what has entered the objects within reach of `root`."""
        found = set()
        reached = _reachable(root, self._package)
        for key, (thing, before) in self._made.items():
            for name, values in _callables(thing).items() if key in reached else ():
                new = [value for value in values if value not in before.get(name, ())]
                found |= {
                    f"{_declaring(type(thing), name)}.{name}: {_title(value)}"
                    for value in new
                    if value in self._given[key] or not self._is_own(thing, name, value)
                }
        return sorted(found)

    def _is_own(self, thing: object, name: str, value: Any) -> bool:
        """Return whether an object gave this value to its attribute itself, as far as its methods show it."""
        if isinstance(vars(type(thing)).get(name), cached_property):
            return True
        if isinstance(_attributes(thing)[name], COLLECTIONS):
            return name.startswith("_")
        return self._own.get((id(thing), name)) is value

    def taking(self, method: Callable[..., Any]) -> Callable[..., Any]:
        """Return a method whose calls with callables are remembered."""

        @wraps(method)
        def call(thing: object, *arguments: Any, **named: Any) -> Any:
            self._given[id(thing)] += filter(_is_callable, (*arguments, *named.values()))
            return method(thing, *arguments, **named)

        return call

    def constructing(self, constructor: Callable[..., None]) -> Callable[..., None]:
        """Return a constructor after which the callables of the new object are remembered."""

        @wraps(constructor)
        def construct(thing: object, *arguments: Any, **named: Any) -> None:
            self._making[id(thing)] += 1
            try:
                constructor(thing, *arguments, **named)
            finally:
                self._making[id(thing)] -= 1
            if not self._making[id(thing)]:
                self._made[id(thing)] = thing, _callables(thing)

        return construct

    def setter(self) -> Callable[[object, str, Any], None]:
        """Return a `__setattr__` that remembers the callables that objects give to themselves."""

        def set_attribute(thing: object, name: str, value: Any) -> None:
            object.__setattr__(thing, name, value)
            own = sys._getframe(1).f_locals.get("self") is thing
            self._own[id(thing), name] = value if own and _is_callable(value) else None

        return set_attribute


@contextmanager
def watched(package: str = "lumen") -> Iterator[Watch]:
    """Watch all classes of the modules of a package that are loaded."""
    watch, undo = Watch(package), list[tuple[type, str, Any]]()
    for kind in _classes(package):
        if "__init__" in vars(kind):
            undo.append((kind, "__init__", vars(kind)["__init__"]))
            _put(kind, "__init__", watch.constructing(vars(kind)["__init__"]))
        for name, method in [*vars(kind).items()]:
            if isinstance(method, FunctionType) and name != "__init__" and _takes_callables(method):
                undo.append((kind, name, method))
                _put(kind, name, watch.taking(method))
        if kind.__setattr__ is object.__setattr__:
            undo.append((kind, "__setattr__", None))
            _put(kind, "__setattr__", watch.setter())
    try:
        yield watch
    finally:
        for kind, name, value in reversed(undo):
            if value is None:
                type.__delattr__(kind, name)
            else:
                _put(kind, name, value)


def _put(kind: type, name: str, value: Any) -> None:
    type.__setattr__(kind, name, value)


def _is_in(module: str, package: str) -> bool:
    return f"{module}.".startswith(f"{package}.")


def _classes(package: str) -> list[type]:
    """Return the classes of the loaded modules of the package, bases after those that inherit from them.

    Classes whose metaclass is written in C are left out: their attributes can't be watched.
    """
    modules = [module for name, module in list(sys.modules.items()) if _is_in(name, package)]
    defined = {
        value
        for module in modules
        for value in vars(module).values()
        if isinstance(value, type) and value.__module__ == module.__name__
    }
    kinds = [kind for kind in defined if type(kind).__setattr__ is type.__setattr__]
    kinds = [kind for kind in kinds if not issubclass(kind, Enum | BaseException | tuple)]
    return sorted(kinds, key=lambda kind: (-len(kind.__mro__), kind.__module__, kind.__qualname__))


def _takes_callables(method: FunctionType) -> bool:
    return any("Callable" in str(each) for name, each in method.__annotations__.items() if name != "return")


def _is_callable(value: object) -> bool:
    return callable(value) and not isinstance(value, type)


def _attributes(thing: object) -> dict[str, Any]:
    found = dict(vars(thing)) if hasattr(thing, "__dict__") else {}
    for kind in type(thing).__mro__:
        slots = vars(kind).get("__slots__", ())
        for name in (slots,) if isinstance(slots, str) else slots:
            if name not in ("__dict__", "__weakref__") and hasattr(thing, name):
                found[name] = getattr(thing, name)
    return found


def _elements(value: object) -> list[Any]:
    if isinstance(value, dict):
        return [*value.values()]
    return [*value] if isinstance(value, COLLECTIONS) else []


def _callables(thing: object) -> dict[str, list[Any]]:
    """Return the callables in each attribute of an object, itself or in its list or table."""
    found = {
        name: [each for each in [value, *_elements(value)] if _is_callable(each)]
        for name, value in _attributes(thing).items()
    }
    return {name: values for name, values in found.items() if values}


def _reachable(root: object, package: str) -> dict[int, object]:
    """Return the objects within reach through attributes, collections, methods and closures, by their ids."""
    found: dict[int, object] = {}
    waiting = [root]
    while waiting:
        thing = waiting.pop()
        if id(thing) in found or isinstance(thing, str | bytes | int | float | type | ModuleType):
            continue
        found[id(thing)] = thing
        match thing:
            case MethodType():
                waiting.append(thing.__self__)
            case partial():
                waiting += [thing.func, *thing.args, *thing.keywords.values()]
            case FunctionType():
                waiting += [cell.cell_contents for cell in thing.__closure__ or () if cell != _EMPTY]
            case _:
                waiting += _elements(thing)
                if _is_in(type(thing).__module__, package):
                    waiting += _attributes(thing).values()
    return found


def _declaring(kind: type, name: str) -> str:
    """Return the class that declares an attribute in its body, else the class of the object."""
    return next((each.__name__ for each in kind.__mro__ if name in vars(each)), kind.__name__)


def _title(value: Any) -> str:
    if isinstance(value, MethodType):
        return f"{type(value.__self__).__name__}.{value.__name__}"
    if isinstance(value, partial):
        return f"partial({_title(value.func)})"
    name = str(getattr(value, "__qualname__", type(value).__name__)).replace(".<locals>", "")
    return f"{name}, line {value.__code__.co_firstlineno}" if name.endswith("<lambda>") else name
