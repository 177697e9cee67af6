"""Read a YAML file on its own, without the project around it."""

from pathlib import Path

from lumen.errors import ProjectError, UsageError
from lumen.language.diagnostics import Diagnostic, has_errors
from lumen.project.document import Document
from lumen.project.files import MAX_FILE_BYTES
from lumen.project.yaml_reader import parse
from lumen.upkeep.regular_files import read_regular


def parse_file(path: Path) -> tuple[Document | None, list[Diagnostic]]:
    """Parse a file. Raises UsageError if it can't be read."""
    try:
        return parse(str(path), read_regular(path, MAX_FILE_BYTES))
    except OSError as error:
        raise UsageError(f"can't read {path}: {(error.strerror or str(error)).lower()}") from None


def read_document(path: Path) -> Document:
    """Return the document in a file. Raises UsageError if it can't be read, ProjectError if it is not YAML."""
    document, diagnostics = parse_file(path)
    if document is None or has_errors(diagnostics):
        raise ProjectError(diagnostics)
    return document
