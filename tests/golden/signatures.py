"""Public names of a module as text: signatures, fields and base classes, without module paths."""

import enum
import inspect
import re
from collections.abc import Iterator
from dataclasses import MISSING, fields, is_dataclass
from types import ModuleType
from typing import Any

from tests.golden.adapters_running import NAMES

PATH = re.compile(r"\b(?:[A-Za-z_]\w*\.)+(?=[A-Za-z_])")
"""The module before a name: it may move."""
FUNCTION = re.compile(r"<function (?:[\w<>]+\.)*(\w+) at 0x[0-9a-f]+>")
"""A function as a default value: recorded is only that there is one."""
WORD = re.compile(r"\b[A-Za-z_]\w*")
UNSHOWN = {"__init__", "__call__", "__enter__", "__exit__", "__iter__", "__len__", "__getitem__", "__str__", "_build"}
"""Special methods that are part of an interface; `_build` has the arguments of a dm_control Entity."""
FOREIGN = {"object", "Protocol", "Generic", "BaseException"}
MADE_BY_LUMEN = {"Exhibition"}
"""Classes that only Lumen itself constructs: their arguments are internal."""
SPLIT = {"lumen.ports"}
"""Packages that were one module: listed are the names that their modules define, without aliases of types."""


def offered(module: ModuleType) -> dict[str, Any]:
    """Return the names of a module: those of `__all__`, else what is defined there or in modules of it."""
    names = None if module.__name__ in SPLIT else getattr(module, "__all__", None)
    if names is None:
        own = f"{module.__name__}."
        here = (name for name, value in vars(module).items() if f"{getattr(value, '__module__', '')}.".startswith(own))
        names = [name for name in here if not name.startswith("_")]
    return {name: getattr(module, name) for name in sorted(names)}


def described(name: str, value: Any, public: frozenset[type]) -> Iterator[str]:
    """Yield the lines about one name; `public` are the classes that have a name in public."""
    if inspect.isclass(value):
        yield from _class(name, value, public)
    elif callable(value):
        yield f"{name}{_signature(value)}"
    else:
        yield f"{name}: {type(value).__name__}"


def _class(name: str, value: type, public: frozenset[type]) -> Iterator[str]:
    line = [one for one in value.__mro__[1:] if one in public or one.__module__ in ("builtins", "enum")]
    kin = [one.__name__ for one in line if one.__name__ not in FOREIGN]
    kinds = []
    if is_dataclass(value):
        settings = value.__dataclass_params__  # type: ignore[attr-defined]
        kinds.append("frozen dataclass" if settings.frozen else "dataclass")
    if getattr(value, "_is_protocol", False):
        kinds.append("protocol")
    if inspect.isabstract(value) and "protocol" not in kinds:
        kinds.append("abstract")
    kin_told = f"({', '.join(kin)})" if kin else ""
    yield f"class {name}{kin_told}{''.join(f' [{kind}]' for kind in kinds)}"
    if issubclass(value, enum.Enum):
        yield from (f"    {member.name} = {member.value!r}" for member in value)
        return
    yield from (f"    {line}" for line in _fields(value))
    yield from (f"    {line}" for line in _members(value))


def _fields(value: type) -> Iterator[str]:
    if is_dataclass(value):
        for field in fields(value):
            default = "" if field.default is MISSING else f" = {_clean(repr(field.default))}"
            if field.default_factory is not MISSING:
                default = f" = {_clean(getattr(field.default_factory, '__name__', '…'))}()"
            yield f"{field.name}: {_type(field.type)}{default}{'' if field.init else ' [not given]'}"
    elif hasattr(value, "_fields") and issubclass(value, tuple):
        for name in value._fields:
            default = f" = {_clean(repr(value._field_defaults[name]))}" if name in value._field_defaults else ""  # type: ignore[attr-defined]
            yield f"{name}: {_type(value.__annotations__.get(name, 'Any'))}{default}"
    elif getattr(value, "_is_protocol", False):
        for name, annotation in value.__annotations__.items():
            yield f"{name}: {_type(annotation)}"


def _members(value: type) -> Iterator[str]:
    own = {}
    for one in reversed(value.__mro__):
        if one.__module__.partition(".")[0] == "lumen":
            own.update(vars(one))
    named = set(getattr(value, "_fields", ())) | ({f.name for f in fields(value)} if is_dataclass(value) else set())
    for name, member in sorted(own.items()):
        if name in named or (name.startswith("_") and name not in UNSHOWN):
            continue
        made = is_dataclass(value) or getattr(value, "_is_protocol", False) or value.__name__ in MADE_BY_LUMEN
        if name == "__init__" and made:
            continue
        if isinstance(member, property) or type(member).__name__ in ("cached_property", "_tuplegetter"):
            getter = getattr(member, "fget", None) or getattr(member, "func", None)
            yield f"{name} → {_type(inspect.signature(getter).return_annotation) if getter else '…'}"
        elif isinstance(member, classmethod | staticmethod):
            yield f"{type(member).__name__} {name}{_signature(member.__func__)}"
        elif inspect.isfunction(member):
            yield f"{name}{_signature(member)}"


def _signature(value: Any) -> str:
    try:
        signature = inspect.signature(value)
    except (TypeError, ValueError):
        return "(…)"
    told = [p.replace(annotation=_Told(p.annotation), default=_default(p)) for p in signature.parameters.values()]
    return str(signature.replace(parameters=told, return_annotation=_Told(signature.return_annotation)))


class _Told:
    """An object whose `repr` is the text that a reader sees."""

    def __new__(cls, annotation: Any) -> Any:
        if annotation is inspect.Parameter.empty:
            return annotation
        told = super().__new__(cls)
        told.text = _type(annotation)
        return told

    text: str

    def __repr__(self) -> str:
        return self.text


class _Default:
    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return self.text


def _default(parameter: inspect.Parameter) -> Any:
    return parameter.default if parameter.default is parameter.empty else _Default(_clean(repr(parameter.default)))


def _type(annotation: Any) -> str:
    if annotation is inspect.Signature.empty:
        return "?"
    if isinstance(annotation, str):
        return _clean(annotation.strip("'\""))
    if annotation is type(None):
        return "None"
    return _clean(
        annotation.__name__ if isinstance(annotation, type) and not _generic(annotation) else repr(annotation)
    )


def _generic(annotation: Any) -> bool:
    return hasattr(annotation, "__args__")


def _clean(text: str) -> str:
    text = text.replace("NoneType", "None").replace("~", "")
    return WORD.sub(lambda found: NAMES.get(found[0], found[0]), PATH.sub("", FUNCTION.sub("a function", text)))
