"""Find faults in the manifest of an installed package: rows of a wrong type, and values that no row can have."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, get_args, get_origin, get_type_hints

from lumen.feature.manifest import (
    EXPORTED_KINDS,
    IMPORTED_KINDS,
    PART_CONDITIONS,
    VALUE_KINDS,
    Exporter,
    Feature,
    FunctionRow,
    Importer,
    PartRow,
    RiskName,
    RobotRow,
    Section,
)

TAKEN = frozenset(
    (
        "bus",
        "for",
        "format",
        "fresh",
        "help",
        "language",
        "last_good",
        "model",
        "only",
        "period",
        "project",
        "record",
        "reload",
        "robot",
        "robot_name",
        "run",
        "size",
        "sound",
        "speed",
        "story",
        "verb",
        "video",
        "voice",
    )
)
"""The names of Lumen's own options of `lumen run`, and of their values: no robot can have such an option."""


def wrong_rows(feature: Feature) -> Iterator[str]:
    """Yield the faults of a manifest, at most one for each kind of row: a wrong type, or a row that can't be used."""
    declared = get_type_hints(Feature)
    if not (isinstance(feature.name, str) and feature.name):
        yield f"the name of its feature is `{feature.name!r}`, which is no text"
    for kind in kinds():
        form, value = get_origin(declared[kind]), getattr(feature, kind)
        row = next(each for each in reversed(get_args(declared[kind])) if each is not Ellipsis)
        if not isinstance(value, form):
            yield f"`{kind}` of its manifest is no {form.__name__.lower()}"
            continue
        if isinstance(value, Mapping) and (unnamed := [key for key in value if not (isinstance(key, str) and key)]):
            yield f"`{kind}` of its manifest has the name `{unnamed[0]!r}`, which is no text"
            continue
        rows_of = tuple(value.values() if isinstance(value, Mapping) else value)
        if wrong := [each for each in rows_of if not isinstance(each, get_origin(row) or row)]:
            yield f"`{kind}` of its manifest has the row `{wrong[0]!r}`, which is no `{row.__name__}`"
        elif fields := [fault for each in rows_of if isinstance(each, tuple) for fault in wrong_fields(each)]:
            yield f"a row of `{kind}` of its manifest has {fields[0]}"
        else:
            yield from (f"`{kind}` of its manifest is faulty: {fault}" for each in rows_of if (fault := _fault(each)))


def wrong_fields(row: Any) -> Iterator[str]:
    """Yield a description of each field whose type differs from the declared one, and of each required empty text."""
    for name, declared in get_type_hints(type(row)).items():
        kind, value = get_origin(declared) or declared, getattr(row, name)
        if isinstance(kind, type) and not isinstance(value, kind):
            yield f"`{name}={value!r}`, which is no {kind.__name__.lower()}"
        elif kind is str and not value.strip() and name not in row._field_defaults:
            yield f"`{name}={value!r}`, which is empty"
        elif kind is tuple and (wrong := [each for each in value if not isinstance(each, get_args(declared)[0])]):
            yield f"`{wrong[0]!r}` in `{name}`, which is no {get_args(declared)[0].__name__}"
        elif kind is tuple:
            yield from (fault for each in value if isinstance(each, tuple) for fault in wrong_fields(each))


def _fault(row: Any) -> str:
    """Return the fault of a row whose type is right; empty if it has none."""
    match row:
        case RobotRow(options=options):
            wrong = [each.flag for each in options if each.destination in TAKEN or not each.name.isidentifier()]
            return f"no robot can have an option `{wrong[0]}`: choose another word" if wrong else ""
        case FunctionRow(parameters=parameters, returns=returns):
            wrong = [kind for kind in "|".join((*parameters, returns)).split("|") if kind not in VALUE_KINDS]
            return f"there is no kind of value `{wrong[0]}`: there are {', '.join(VALUE_KINDS)}" if wrong else ""
        case Section(risk=risk) if risk not in (risks := get_args(RiskName)):
            return f"a section has no risk `{risk}`: choose one of {', '.join(risks)}"
        case Importer(kind=kind) if kind not in IMPORTED_KINDS:
            return f"no file is imported as `{kind}`: choose one of {', '.join(IMPORTED_KINDS)}"
        case Exporter(kind=kind) if kind not in EXPORTED_KINDS:
            return f"nothing is exported of the kind `{kind}`: choose one of {', '.join(EXPORTED_KINDS)}"
        case PartRow(name=name, after=after) if name == after:
            return f"the part `{name}` comes after itself: name another part in `after`"
        case PartRow(name=name, when=when):
            forms = ", ".join(f"{kind}:NAME" if named else kind for kind, named in PART_CONDITIONS.items())
            wrong = [condition for condition in when.split() if not _is_condition(condition)]
            return f"the part `{name}` has the unknown condition `{wrong[0]}`: use {forms}" if wrong else ""
    return ""


def _is_condition(text: str) -> bool:
    kind, colon, name = text.partition(":")
    return PART_CONDITIONS.get(kind) == bool(colon and name)


def kinds() -> Iterator[str]:
    """Yield the names of the kinds of rows: the fields of `Feature` except its name and API."""
    yield from (kind for kind in Feature._fields if kind not in ("name", "api"))


def ordered(found: Iterable[PartRow]) -> list[PartRow]:
    """Return rows sorted by phase, each after the row that its `after` names, and otherwise by name.

    Raises ValueError if rows wait for each other.
    """
    waiting = sorted(found, key=lambda row: (row.phase, row.name))
    names, sorted_rows = {row.name: row.phase for row in waiting}, list[PartRow]()
    while waiting:
        done = {row.name for row in sorted_rows}
        phase = waiting[0].phase
        free = (row for row in waiting if row.phase == phase and (row.after in done or names.get(row.after) != phase))
        if (row := next(free, None)) is None:
            raise ValueError(
                f"parts wait for each other: {', '.join(row.name for row in waiting if row.phase == phase)}"
            )
        waiting.remove(row)
        sorted_rows.append(row)
    return sorted_rows
