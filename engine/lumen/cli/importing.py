"""`lumen import`: a statechart of another tool as a behaviour file."""

import argparse
import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from lumen.cli.render import FORMATS
from lumen.cli.terminal import coloured
from lumen.cli.writing import write_result
from lumen.errors import UsageError
from lumen.formats.document import behavior_yaml
from lumen.formats.findings import ForeignFileError
from lumen.formats.scxml import read_scxml
from lumen.formats.scxml.elements import MAX_BYTES
from lumen.formats.xstate import read_xstate
from lumen.language.diagnostics import Diagnostic, has_errors
from lumen.language.machines import Machine
from lumen.loading.behaviors import build_machine
from lumen.loading.schema import check_schema
from lumen.loading.source import Report, parse

Reader = Callable[[str, bytes, str], tuple[dict[str, Any], list[Diagnostic]]]

READERS: Mapping[str, Reader] = {".scxml": read_scxml, ".xml": read_scxml, ".json": read_xstate}


def configure(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Turn a statechart in SCXML or XState's JSON into a behaviour file. What can't be carried over is listed, with"
        " its line; then the exit code is 1, and the rest is written all the same."
    )
    parser.add_argument("file", metavar="FILE", type=Path, help="a .scxml file, or the .json of an XState machine")
    parser.add_argument("-o", "--output", metavar="OUT.yaml", type=Path, help="write it there instead of printing it")
    parser.add_argument("--format", choices=tuple(FORMATS), default="text", help="of the list (default: text)")


def run(options: argparse.Namespace) -> int:
    """0 where everything was carried over, 1 where something is left out, 2 where the file can't be read."""
    content = _content(options.file)
    title = _title(options.output or options.file)
    try:
        data, diagnostics = _reader(options.file, content)(str(options.file), content, title)
    except ForeignFileError as error:
        raise UsageError(_one_line(error.diagnostic)) from None
    text = behavior_yaml(data)
    diagnostics += _faults(str(options.output or "the result"), text)
    write_result(text, options.output)
    if diagnostics or options.format != "text":
        files = {str(options.file): content}
        print(FORMATS[options.format](diagnostics, files, coloured=coloured(sys.stderr)), file=sys.stderr)
    return int(has_errors(diagnostics))


def _content(path: Path) -> bytes:
    try:
        if path.is_file() and path.stat().st_size > MAX_BYTES:
            raise UsageError(f"{path} is larger than {MAX_BYTES // 1_000_000} MB: too large to be a statechart")
        return path.read_bytes()
    except OSError as error:
        raise UsageError(f"can't read {path}: {(error.strerror or str(error)).lower()}") from None


def _title(path: Path) -> str:
    return re.sub(r"[\s#*]+", "_", path.stem)


def _reader(path: Path, content: bytes) -> Reader:
    """By the file's ending, else by how it begins."""
    if path.suffix.lower() in READERS:
        return READERS[path.suffix.lower()]
    start = content.removeprefix(b"\xef\xbb\xbf").lstrip()[:1]
    if start not in (b"<", b"{"):
        raise UsageError(f"{path} is neither SCXML nor the JSON of XState")
    return read_scxml if start == b"<" else read_xstate


def _one_line(diagnostic: Diagnostic) -> str:
    hint = f" ({diagnostic.hint})" if diagnostic.hint else ""
    return f"{diagnostic.place}: {diagnostic.message}{hint}"


def _faults(file: str, text: str) -> list[Diagnostic]:
    """What the file would be refused for: nothing, unless we are mistaken."""
    document, found = parse(file, text.encode())
    if document is None:
        return found
    report = Report(document)
    build_machine(check_schema(document, "behavior", report), report, name="imported", into=Machine)
    return [*found, *report.diagnostics]
