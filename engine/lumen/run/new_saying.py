"""A saying that the console adds: an entry in behaviors/sayings/day.yaml, loaded like any saved file."""

import copy
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lumen.errors import UsageError
from lumen.language.diagnostics import NodePath, Place, Severity
from lumen.language.folders import SAYINGS_FOLDER
from lumen.language.sayings import Saying
from lumen.lint import sayings, speech
from lumen.lint.fixes.edits import Edit, FileText, edited
from lumen.lint.new_language import beside
from lumen.project.building import draft
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.files import Unreadable, read_files
from lumen.project.yaml_reader import parse
from lumen.run.new_passage import check_language, one_line
from lumen.upkeep.replacing import replace_file

DAY_FILE = f"{SAYINGS_FOLDER}/day.yaml"
HEADER = "# yaml-language-server: $schema=../../schemas/sayings.schema.json"
_PLAIN = re.compile(r"[A-Za-z_](?:[\w.| -]*\w)?")
"""Keys that need no quotes."""
_WORDS = frozenset(("null", "true", "false"))


def write_saying(root: Path, saying: Saying, robot: str = "") -> Path:
    """Add a saying to the console's file; return its path relative to the project's folder.

    All other bytes of the file stay the same. Raises UsageError, and writes nothing, if the language or the text is
    invalid, or the file has errors before or afterwards, or can't be written.
    """
    check_language(saying.language)
    text = one_line(saying.text, "text")
    files = read_files(root, robot)
    before = files.get(DAY_FILE, b"")
    if isinstance(before, Unreadable):
        raise UsageError(f"{DAY_FILE} can't be read: {before.decode('utf-8', 'replace')}")
    if not _is_blank(before):
        _refuse_errors({**files, DAY_FILE: before}, "correct that first")
    after = with_saying(before, Saying(saying.behavior, saying.state, saying.row, saying.language, text))
    _refuse_errors({**files, DAY_FILE: after}, "nothing was written")
    if after != before:
        _save(root, before, after)
    return Path(DAY_FILE)


def with_saying(content: bytes, saying: Saying) -> bytes:
    """Return the content of a file of sayings with `saying` added; unchanged if the file already has it.

    Raises UsageError if the saying can't be added because of the way the file is written.
    """
    keys = (saying.behavior, saying.state, saying.row, saying.language)
    if _is_blank(content):
        start = content or HEADER.encode()
        ended = start if start.endswith(b"\n") else start + b"\n"
        return ended + f"\n{_block(keys, saying.text, 0)}\n".encode()
    document, _ = parse(DAY_FILE, content)
    if document is None or not isinstance(document.data, Mapping) or not document.data:
        raise UsageError(f"{DAY_FILE} has no sayings: add one by hand, or delete the file")
    depth = next((n for n in range(len(keys)) if keys[n] not in document.value(keys[:n])), len(keys))
    if depth == len(keys) and saying.text in document.value(keys):
        return content
    after = edited(content, [_edit(document, FileText(DAY_FILE, content), keys, depth, saying.text)])
    read, found = parse(DAY_FILE, after)
    if found or read is None or read.data != _expected(document.data, keys, saying.text):
        entry = _flow(keys, saying.text)
        raise UsageError(
            f"the saying can't be added to {DAY_FILE} because of how the file is written: add `{entry}` by hand"
        )
    return after


def _edit(document: Document, text: FileText, keys: tuple[str, ...], depth: int, said: str) -> Edit:
    """Return the edit that adds the saying after the last entry below the longest existing part of its keys.

    `depth` is the number of existing keys.
    """
    around = keys[:depth]
    report, whole = DocumentReport(document), document.spans[around].value
    last: NodePath = (*around, _last(document.value(around)))
    if _is_flow(text, whole):
        return beside(report, text, around, last, _flow(keys[depth:], said))
    while isinstance(node := document.find(last), Mapping | list) and not _is_flow(text, document.spans[last].value):
        last = (*last, _last(node))
    dash = "" if keys[depth:] else "- "
    return beside(report, text, around, last, _block(keys[depth:], said, whole.column - 1), dash)


def _is_blank(content: bytes) -> bool:
    """Return whether a file has only comments and blank lines."""
    return all(line.lstrip().startswith(b"#") for line in content.splitlines() if line.strip())


def _refuse_errors(files: Mapping[str, bytes], what: str) -> None:
    """Raise UsageError, ending with `what`, if lint finds an error in the file of sayings."""
    found = draft(files)
    sayings.check(found)
    speech.check(found)
    for one in found.diagnostics:
        if one.place.file == DAY_FILE and one.severity is Severity.ERROR:
            hint = f" ({one.hint})" if one.hint else ""
            raise UsageError(f"{DAY_FILE}, line {one.place.line}: {one.message}{hint}: {what}")


def _save(root: Path, before: bytes, after: bytes) -> None:
    """Replace the file in one step. Raises UsageError if it has changed since it was read, or can't be written."""
    file = root / DAY_FILE
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        if file.parent.is_symlink() or file.is_symlink():
            raise UsageError(f"{DAY_FILE} or its folder is a symbolic link: replace it with a file or folder")
        if (file.read_bytes() if file.exists() else b"") != before:
            raise UsageError(f"{DAY_FILE} has changed in the meantime: try again")
        replace_file(file, after)
    except OSError as error:
        raise UsageError(f"{DAY_FILE} can't be written: {(error.strerror or str(error)).lower()}") from None


def _last(node: Any) -> str | int:
    return len(node) - 1 if isinstance(node, list) else [*node][-1]


def _is_flow(text: FileText, place: Place) -> bool:
    """Return whether a node is written in brackets (YAML flow style)."""
    return text.line(place.line)[place.column - 1 : place.column] in ("{", "[")


def _key(key: str) -> str:
    return key if _PLAIN.fullmatch(key) and key not in _WORDS else json.dumps(key, ensure_ascii=False)


def _flow(keys: tuple[str, ...], text: str) -> str:
    """Return the entry in brackets (YAML flow style), below its keys."""
    said = json.dumps(text, ensure_ascii=False)
    if not keys:
        return said
    inner = f"[{said}]"
    for key in reversed(keys[1:]):
        inner = f"{{{_key(key)}: {inner}}}"
    return f"{_key(keys[0])}: {inner}"


def _block(keys: tuple[str, ...], text: str, indent: int) -> str:
    """Return the entry on lines of its own, below its keys; the first line is not indented."""
    lines = [f"{_key(key)}:" for key in keys]
    lines.append(f"- {json.dumps(text, ensure_ascii=False)}" if keys else json.dumps(text, ensure_ascii=False))
    return "\n".join(f"{' ' * (indent + 2 * i) if i else ''}{line}" for i, line in enumerate(lines))


def _expected(data: Any, keys: tuple[str, ...], text: str) -> Any:
    """Return a copy of the data with the saying."""
    whole = copy.deepcopy(data)
    node = whole
    for key in keys[:-1]:
        node = node.setdefault(key, {})
    node.setdefault(keys[-1], []).append(text)
    return whole
