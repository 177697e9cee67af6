"""The reference of the YAML files and of the messages, made from schemas/: a page of Markdown for each schema.

Every property is a heading with its type, its limits, its description and its examples. A part that a schema defines
once and uses often (`$defs`) has a heading of its own, and links to it.
"""

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

Schema = Mapping[str, Any]

LIMITS = {
    "minimum": "at least {}",
    "exclusiveMinimum": "more than {}",
    "maximum": "at most {}",
    "exclusiveMaximum": "less than {}",
    "minLength": "at least {} characters",
    "maxLength": "at most {} characters",
    "minItems": "at least {} entries",
    "maxItems": "at most {} entries",
    "minProperties": "at least {} keys",
    "maxProperties": "at most {} keys",
    "pattern": "fits `{}`",
    "format": "{}",
}
TYPES = {"object": "map", "array": "list", "string": "text", "integer": "whole number", "null": "`null`"}
DEEPEST = 6
"""Markdown has six depths of headings."""


def pages(folder: Path) -> dict[str, str]:
    """Return the pages by their paths below the reference: `motion.md`, `messages/sonar.md` and two lists."""
    kinds = {file: load(file) for file in sorted(folder.glob("*.schema.json"))}
    messages = {file: load(file) for file in sorted((folder / "messages").glob("*.schema.json"))}
    if not kinds or not messages:
        raise SystemExit(f"no schema is in {folder} and {folder / 'messages'}: the reference would be empty")
    written = {f"{name(file)}.md": page(schema, f"`schemas/{file.name}`") for file, schema in kinds.items()}
    for file, schema in messages.items():
        written[f"messages/{name(file)}.md"] = page(schema, f"`schemas/messages/{file.name}`", name(file))
    written["README.md"] = _list("Every key of every file", kinds)
    written["messages/README.md"] = _list("Every message", messages)
    return written


def name(file: Path) -> str:
    """Return the name of a schema by its file."""
    return file.name.removesuffix(".schema.json")


def load(file: Path) -> Schema:
    """Return the schema in a file."""
    schema: Schema = json.loads(file.read_text(encoding="utf-8"))
    return schema


def _list(title: str, schemas: Mapping[Path, Schema]) -> str:
    rows = (
        f"- [{_title(file, schema)}]({name(file)}.md): {schema.get('description', '')}"
        for file, schema in schemas.items()
    )
    return (
        f"# {title}\n\nMade from the JSON Schemas that Lumen, your editor and `lumen lint` check with.\n\n"
        + "\n".join(rows)
    )


def _title(file: Path, schema: Schema) -> str:
    return name(file) if file.parent.name == "messages" else str(schema.get("title", name(file)))


def page(schema: Schema, file: str, title: str = "") -> str:
    """Return one schema as Markdown."""
    rows = [f"# {title or schema.get('title', file)}", str(schema.get("description", "")), f"Schema: {file}."]
    rows += _examples(schema)
    rows += _within(schema, 2, ())
    for key, part in schema.get("$defs", {}).items():
        rows += [f"## {key} (shared) {{#def-{key}}}", *_said(part), *_within(part, 3, (key,))]
    return "\n\n".join(row for row in rows if row) + "\n"


def _within(schema: Schema, depth: int, path: tuple[str, ...]) -> Iterator[str]:
    """Yield the properties of a schema, and theirs, each below its heading."""
    required = set(schema.get("required", ()))
    for key, part in schema.get("properties", {}).items():
        here = (*path, key)
        yield f"{'#' * min(depth, DEEPEST)} {'.'.join(here)}"
        yield from _said(part, key in required)
        yield from _within(part, depth + 1, here)
    for part in (schema.get("items"), schema.get("additionalProperties")):
        if isinstance(part, Mapping) and part.get("properties"):
            yield from _within(part, depth, (*path, "*"))
    for part in alternatives(schema):
        yield from _within(part, depth, path)


def alternatives(schema: Schema) -> list[Schema]:
    """Return the subschemas in `oneOf`, `anyOf` and `allOf`."""
    return [part for word in ("oneOf", "anyOf", "allOf") for part in schema.get(word, ()) if isinstance(part, Mapping)]


def _said(schema: Schema | bool, required: bool = False) -> Iterator[str]:
    """Yield the description of one value: its type and limits, its meaning, and examples."""
    if isinstance(schema, bool):
        yield "*anything*" if schema else "*nothing*"
        return
    facts = [kind(schema), *limits(schema), *(["**required**"] if required else [])]
    yield f"*{facts[0]}*" + "".join(f" · {fact}" for fact in facts[1:])
    yield str(schema.get("description", ""))
    yield from _examples(schema)


def kind(schema: Schema) -> str:
    """Return the type of a value in words; a reference becomes a link."""
    if reference := schema.get("$ref"):
        return _link(str(reference))
    if "const" in schema:
        return _code(schema["const"])
    if "enum" in schema:
        return "one of " + ", ".join(map(_code, schema["enum"]))
    types = schema.get("type", ())
    words = [_type(each, schema) for each in ([types] if isinstance(types, str) else types)]
    words = words or [kind(part) for part in alternatives(schema)]
    return " or ".join(dict.fromkeys(words)) or "any value"


def _type(word: str, schema: Schema) -> str:
    inner = schema.get("items") if word == "array" else schema.get("additionalProperties") if word == "object" else None
    of = f" of {kind(inner)}" if isinstance(inner, Mapping) and kind(inner) not in ("any value", "map") else ""
    return TYPES.get(word, word) + of


def _link(reference: str) -> str:
    if reference == "#":
        return "the whole again"
    _, _, key, *inner = reference.split("/")
    return f"[{inner[-1] if inner else key}](#def-{key})"


def limits(schema: Schema) -> Iterator[str]:
    """Yield the limits of a value in words."""
    for word, text in LIMITS.items():
        if word in schema:
            yield text.format(str(schema[word]).replace("|", "\\|") if word != "pattern" else schema[word])
    if "default" in schema:
        yield f"without it {_code(schema['default'])}"
    if schema.get("deprecated"):
        yield "deprecated"


def _code(value: Any) -> str:
    return f"`{json.dumps(value, ensure_ascii=False) if not isinstance(value, str) else value or chr(34) * 2}`"


def _examples(schema: Schema) -> Iterator[str]:
    """Yield the examples as YAML: one block for all that fit on a line."""
    texts = [_yaml(value) for value in schema.get("examples", ())]
    short = [text for text in texts if "\n" not in text]
    if short:
        yield "```yaml\n" + "\n".join(short) + "\n```"
    yield from (f"```yaml\n{text}\n```" for text in texts if "\n" in text)


def _yaml(value: Any) -> str:
    flow = not isinstance(value, dict | list) or len(json.dumps(value)) < 90
    text = yaml.safe_dump(value, default_flow_style=flow, allow_unicode=True, sort_keys=False, width=110)
    return re.sub(r"\n\.\.\.$", "", text.strip())
