"""Read YAML 1.2 with a place for every node.

PyYAML reads YAML 1.1 (`on:` is true there, `12:30` is 750); here only its parser is used, and scalars are resolved by
the YAML 1.2 core schema.
"""

from functools import partial
from typing import Any

import yaml

from lumen.language.diagnostics import ERROR, Code, Diagnostic, NodePath, Place
from lumen.project.document import Document, NodeSpan
from lumen.project.memoization import last, memoize
from lumen.project.rereading import reread
from lumen.project.yaml_composer import TooLargeError, compose
from lumen.project.yaml_errors import merge_conflict, not_utf8, syntax_error
from lumen.project.yaml_nodes import NodeReader, too_large

EMPTY_FILE = Code("empty-file", "text", ERROR, "a file is empty")


def parse(file: str, content: bytes) -> tuple[Document | None, list[Diagnostic]]:
    """Return the document in `content` and its faults; None instead of a document if it can't be parsed.

    No content raises an error. The result is cached until the file changes, so callers must not change the document.
    """
    document, found = memoize(("parse", file), content, lambda: _read(file, content))
    return document, [*found]


def _read(file: str, content: bytes) -> tuple[Document | None, list[Diagnostic]]:
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return None, [not_utf8(file, content, error.start)]
    before = last(("sound", file))
    if before and (document := reread(before, text, partial(_block, file))):
        return memoize(("sound", file), content, lambda: document), []
    try:
        node = compose(text)
    except (yaml.MarkedYAMLError, yaml.reader.ReaderError) as error:
        return None, [syntax_error(file, text, error)]
    except TooLargeError as error:
        return None, [too_large(file, error)]
    if node is None:
        return None, [EMPTY_FILE.at(Place(file), "the file is empty", "add its content, or delete the file")]
    reader = NodeReader(file, text)
    data = reader.read(node, (), None, 0)
    if "<<<<<<< " in text and (conflict := merge_conflict(file, text)):
        reader.diagnostics.append(conflict)
    document = Document(file, data, reader.spans, text, frozenset(reader.dropped))
    if not reader.diagnostics:
        memoize(("sound", file), content, lambda: document)
    return document, reader.diagnostics


def _block(
    file: str, text: str, node: yaml.Node, path: NodePath, key: yaml.Node
) -> tuple[Any, dict[NodePath, NodeSpan]] | None:
    reader = NodeReader(file, text)
    data = reader.read(node, path, key, len(path))
    return None if reader.diagnostics or reader.dropped else (data, reader.spans)
