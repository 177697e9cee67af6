"""Find texts in braces that a comma splits, as in `{en: Oh, step back}`: YAML reads the rest as a key."""

import json
from typing import Any

from lumen.language.diagnostics import NodePath
from lumen.language.language_tags import is_language_tag
from lumen.language.text_lines import lines_of
from lumen.project.document import Document


def whole_text(document: Document, path: NodePath, *, by_language: bool = False) -> str:
    """Return the entry whose text continues in the key at `path`, quoted: `en: "Oh, step back"`; "" if no entry does.

    The rest of a text is a key without a colon, after an entry that is a text. If the rest contains a colon, it is a
    key with a text; such a key counts only in a map `by_language`, if it is not a language.
    """
    around = document.find(path[:-1])
    if not path or not isinstance(around, dict) or path[-1] not in around:
        return ""
    if not _is_rest(document, path, around[path[-1]], by_language):
        return ""
    keys = list(around)
    rests = [_is_rest(document, (*path[:-1], key), around[key], by_language) for key in keys]
    at = keys.index(path[-1])
    first = next((i for i in range(at, -1, -1) if not rests[i]), at)
    if first == at or not isinstance(around[keys[first]], str):
        return ""
    last = next((i for i in range(at, len(keys)) if not rests[i]), len(keys))
    parts = (key if around[key] is None else f"{key}: {around[key]}" for key in keys[first + 1 : last])
    return f"{keys[first]}: {json.dumps(', '.join([around[keys[first]], *parts]), ensure_ascii=False)}"


def whole_translation(document: Document, path: NodePath) -> str:
    """Return `whole_text` if the text is in a map by language, and not a target under `on` or `hears`; else "".

    In `say`, a rest with a colon counts too, unless the word before the colon may be a name, as in `german:`.
    """
    whole = whole_text(document, path, by_language=path[-2:-1] == ("say",) and not str(path[-1]).isidentifier())
    key = whole.partition(":")[0]
    return whole if (key == "any" or is_language_tag(key)) and path[-2:-1] not in (("on",), ("hears",)) else ""


def quoting(whole: str) -> str:
    """Return the hint for a text that a comma splits; `whole` is what `whole_text` returns."""
    return f"a comma ends a text inside braces: put quotes around the whole text: {whole}"


def _is_rest(document: Document, path: NodePath, value: Any, by_language: bool) -> bool:
    if value is None:
        return _follows(document, path) != ":"
    return by_language and isinstance(value, str) and not is_language_tag(path[-1]) and _in_braces(document, path[:-1])


def _follows(document: Document, path: NodePath) -> str:
    """Return the first visible character after a key in the file; a colon if the key's place is unknown."""
    if path not in document.spans:
        return ":"
    place = document.place(path, key=True)
    return lines_of(document.text)[place.end_line - 1][place.end_column - 1 :].lstrip()[:1]


def _in_braces(document: Document, path: NodePath) -> bool:
    place = document.place(path)
    return lines_of(document.text)[place.line - 1][place.column - 1 :].startswith("{")
