"""Converts a skill's manifest, `skills/NAME.yaml`, to the row of its verb."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any, Literal

from lumen.expressions import split_template
from lumen.feature import VerbRow
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.durations import duration_hint, seconds
from lumen.language.verbs import is_built_in
from lumen.project.added_verbs import takes_fault, usable_verbs
from lumen.project.document_report import DocumentReport
from lumen.project.messages import examine
from lumen.project.schema import faults
from lumen.project.units import BAD_DURATION

SKILL_NAME = Code("skill-name", "skills", ERROR, "the name of a skill is taken, or can't be that of a verb")
SKILL_SCHEMA = Code("skill-schema", "skills", ERROR, "`in` or `out` of a skill can't be used as the schema of a verb")
SKILL_DEFAULT = Code("skill-default", "skills", ERROR, "a default of a skill does not fit its own schema")
SKILL_TAKES = Code("skill-takes", "skills", ERROR, "`takes` of a skill can't be computed from its arguments")
SKILL_FILE = Code("skill-file", "skills", ERROR, "the Python file of a skill is outside the project, or no Python file")

PERFORMER = "lumen.features.skills.performer"
DEFAULT_MEMORY = 512
"""The memory limit of a skill's program if its manifest has no `memory` [MB]."""

_NAME = re.compile(r"[a-z][a-z0-9_]*")
_WORD = re.compile(r"(?<![\w.'\"])(?!(?:and|or|not|in|if|else|true|false|null)\b)[A-Za-z_]\w*(?!\w*\s*\()")
"""Matches a name in an expression that is neither a function nor a keyword."""
_UNUSABLE = {"$ref": "write the definition in its place", "$defs": "write each definition where it is used"}

ProgramKind = Literal["python", "command", "module"]


@dataclass(frozen=True)
class Skill:
    """The settings of a manifest that its performer needs."""

    kind: ProgramKind
    target: tuple[str, ...]
    """The path of a Python file, a command with its arguments, or the name of a module."""
    warm: bool = False
    """Whether the program starts with the exhibition."""
    memory: float = DEFAULT_MEMORY
    """The memory limit of the program [MB]."""

    @property
    def module(self) -> str:
        """The name of the module that performs the skill; empty if a local program performs it."""
        return self.target[0] if self.kind == "module" else ""


def build_skill(data: Any, report: DocumentReport, *, name: str, languages: Sequence[str] = ()) -> VerbRow | None:
    """Return the verb's row for the data of `skills/NAME.yaml`; None if the data have errors.

    Its description is in the first of the project's `languages` that the manifest has, else in the manifest's first.
    """
    if not isinstance(data, Mapping):
        return None
    _check_name(name, report)
    skill = _performed(data.get("performed-by"), data, report)
    arguments = _schema(data, "in", languages, report)
    result = _schema(data, "out", languages, report)
    parts = data.get("parts", ())
    row = VerbRow(
        performer=PERFORMER,
        description=_text(data.get("description", ""), languages),
        arguments=arguments,
        result=result,
        takes=str(data.get("takes", "0s")),
        parts=(parts,) if isinstance(parts, str) else tuple(parts),
        moves=bool(data.get("moves", False)),
        cancel=bool(data.get("cancel", True)),
        details=skill,
    )
    if not report.diagnostics:
        _check_takes(row, report)
    return row if skill and not report.diagnostics else None


def _check_name(name: str, report: DocumentReport) -> None:
    if is_built_in(name) or name == "if":
        report(SKILL_NAME, (), f"Lumen has a verb `{name}` already", "give the file another name")
    elif name in usable_verbs():
        message = f"an installed package has a verb `{name}` already"
        report(SKILL_NAME, (), message, "give the file another name, or uninstall the package")
    elif not _NAME.fullmatch(name):
        plain = re.sub(r"[^a-z0-9_]+", "_", name.lower()).strip("_0123456789")
        example = f", such as `{plain}.yaml`" if plain else ""
        message = f"`{name}` can't be the name of a verb"
        report(SKILL_NAME, (), message, f"use small letters, digits and `_` in the name of the file{example}")


def _performed(said: Any, data: Mapping[str, Any], report: DocumentReport) -> Skill | None:
    if not isinstance(said, Mapping) or not said:
        return None
    way, target = next(iter(said.items()))
    where = ("performed-by", way)
    if way == "python":
        path = PurePosixPath(target)
        if path.is_absolute() or ".." in path.parts or path.suffix != ".py":
            hint = "write the path of a `.py` file inside the project, such as `skills/spray.py`"
            report(SKILL_FILE, where, f"`{target}` is no Python file of this project", hint)
            return None
        target = path.as_posix()
    targets = (target,) if isinstance(target, str) else tuple(target)
    return Skill(way, targets, bool(data.get("warm", False)), float(data.get("memory", DEFAULT_MEMORY)))


def _schema(data: Mapping[str, Any], key: str, languages: Sequence[str], report: DocumentReport) -> Mapping[str, Any]:
    """Return the JSON Schema under `in` or `out`; empty if there is none, or, with a report, if it is invalid."""
    if not isinstance(schema := data.get(key), Mapping):
        return {}
    plain: dict[str, Any] = _with_texts(schema, languages)
    if plain.get("type", "object") != "object":
        message = f"`{key}` must describe an object with names and values, not `{plain['type']}`"
        report(SKILL_SCHEMA, (key, "type"), message, "write `type: object`, or leave it out")
        return {}
    for path in _unusable(plain):
        message = f"a skill can't use `{path[-1]}`: its schema becomes a part of another one"
        report(SKILL_SCHEMA, (key, *path), message, _UNUSABLE[str(path[-1])], key=True)
        return {}
    if not examine(plain, report, (key,)):
        return {}
    properties = plain.get("properties", {})
    for i, name in enumerate(plain.get("required", ())):
        if name not in properties:
            hint = did_you_mean(name, properties, "`properties` has") if properties else "list it under `properties`"
            report(SKILL_SCHEMA, (key, "required", i), f"`{name}` is required, and not described", hint)
    if properties:  # an `enum` of texts allows the short form, as `type: string` does
        plain["properties"] = properties = {name: _typed(inner) for name, inner in properties.items()}
    defaults = {name: inner["default"] for name, inner in properties.items() if _has_default(inner)}
    clear = all(_is_clear(properties[name]) for name in defaults) and "additionalProperties" not in plain
    fits = clear or not faults(defaults, {**plain, "required": []})
    for name in defaults:
        _check_default(properties[name], (key, "properties", name, "default"), report, fits=fits)
    return plain


def _typed(schema: Any) -> Any:
    """Return a property's schema; without a `type`, it gets the type `string` if its `enum` contains only texts."""
    values = schema.get("enum") if isinstance(schema, Mapping) and "type" not in schema else None
    return {"type": "string", **schema} if values and all(isinstance(value, str) for value in values) else schema


def _has_default(schema: Any) -> bool:
    return isinstance(schema, Mapping) and "default" in schema


def _is_clear(schema: Mapping[str, Any]) -> bool:
    """Return whether a default certainly fits its schema, without the complete check, which is slow."""
    default, kind, values = schema["default"], schema.get("type"), schema.get("enum")
    known = schema.keys() <= {"type", "enum", "default", "description", "format"}
    typed = isinstance(kind, str) and type(default) in _TYPES.get(kind, ())
    listed = values is None or any(type(value) is type(default) and value == default for value in values)
    return known and typed and listed and schema.get("format", "duration") == "duration"


_TYPES: Mapping[str, tuple[type, ...]] = {
    "string": (str,),
    "integer": (int,),
    "number": (int, float),
    "boolean": (bool,),
}


def _check_default(schema: Mapping[str, Any], where: NodePath, report: DocumentReport, *, fits: bool) -> None:
    """Report a default that does not fit its schema; with `fits`, check only whether a duration is valid."""
    default = schema["default"]
    for fault in [] if fits else faults({"default": default}, {"properties": {"default": schema}})[:1]:
        report(SKILL_DEFAULT, where, f"this default does not fit: {fault.message}", fault.hint)
        return
    if schema.get("format") == "duration" and seconds(default) is None:
        report(BAD_DURATION, where, f"`{default}` is not a duration", duration_hint(default))


def _unusable(schema: Any, path: NodePath = ()) -> Iterator[NodePath]:
    """Yield the paths of keywords that can't be used in a schema inside another schema."""
    if isinstance(schema, Mapping):
        for key, inner in schema.items():
            if key in _UNUSABLE and path[-1:] != ("properties",):
                yield (*path, key)
            elif key not in ("default", "const", "enum", "examples"):
                yield from _unusable(inner, (*path, key))
    elif isinstance(schema, list):
        for i, inner in enumerate(schema):
            yield from _unusable(inner, (*path, i))


def _check_takes(row: VerbRow, report: DocumentReport) -> None:
    """Report `takes` if it is not a duration, or uses anything but arguments that always have a value."""
    properties = row.arguments.get("properties", {})
    sources = [part.source for part in split_template(row.takes) if not isinstance(part, str)]
    if fault := takes_fault(row):
        names = (name for source in sources for name in _WORD.findall(source))
        if unknown := next((name for name in names if name not in properties), ""):
            hint = did_you_mean(unknown, properties, "its arguments are") if properties else "add it to `in`"
            report(SKILL_TAKES, ("takes",), f"`{unknown}` is no argument of this skill", hint)
        elif sources:
            report(SKILL_TAKES, ("takes",), fault, "write a duration, maybe with expressions of the arguments")
        else:
            report(BAD_DURATION, ("takes",), f"`{row.takes}` is not a duration", duration_hint(row.takes))
        return
    given = {name: inner.get("default") for name, inner in properties.items() if isinstance(inner, Mapping)}
    missing = [name for name, value in given.items() if value is None and name not in row.arguments.get("required", ())]
    for name in missing:
        if any(re.search(rf"(?<![\w.]){re.escape(name)}\b", source) for source in sources):
            message = f"`takes` needs `{name}`, which can be left out"
            report(SKILL_TAKES, ("takes",), message, f"give `{name}` a `default`, or list it under `required`")
            return


def _with_texts(schema: Any, languages: Sequence[str]) -> Any:
    """Return the schema with each multilingual description reduced to one language."""
    if isinstance(schema, list):
        return [_with_texts(inner, languages) for inner in schema]
    if not isinstance(schema, Mapping):
        return schema
    plain: dict[str, Any] = {}
    for key, inner in schema.items():
        if key == "description" and isinstance(inner, Mapping) and inner:
            plain[key] = _text(inner, languages)
        elif key == "properties" and isinstance(inner, Mapping):
            plain[key] = {name: _with_texts(one, languages) for name, one in inner.items()}
        else:
            plain[key] = inner if key in ("default", "const", "enum", "examples") else _with_texts(inner, languages)
    return plain


def _text(said: Any, languages: Sequence[str]) -> str:
    """Return a plain text, or the text in the first of these languages that `said` has, else in its first language."""
    if not isinstance(said, Mapping):
        return str(said)
    return str(next((said[language] for language in languages if language in said), next(iter(said.values()))))
