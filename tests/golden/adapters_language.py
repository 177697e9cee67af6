"""The names of the engine's insides that goldens of its language use, all in one place for the day they move."""

import argparse
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import lumen.cli.main as command_line
from lumen.language.diagnostics import Diagnostic
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.yaml_reader import parse

__all__ = ["Diagnostic", "findings", "lumen_main", "options", "project_files", "table", "verbs"]

lumen_main = command_line.main


def findings(root: Path, files: Mapping[str, bytes]) -> tuple[Diagnostic, ...]:
    """Return lint's findings in these files, in its order."""
    return check_files(root, files)[1]


def project_files(root: Path) -> dict[str, bytes]:
    """Return the files of a project that lint reads."""
    return dict(read_files(root))


def table(file: Path) -> dict[str, Any]:
    """Return the rows of a YAML file by name, read as the engine reads its own: `on` is a word."""
    document, found = parse(file.name, file.read_bytes())
    assert document
    assert not found, found[0]
    return dict(document.data)


def verbs() -> dict[str, argparse.ArgumentParser]:
    """Return the parser of each subcommand by its name, that of `lumen` itself first."""
    parser = command_line.command_line(command_line.subcommands())
    return {"lumen": parser, **parser.verbs}


def options(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Yield the options and arguments of a parser, in the order of its help."""
    yield from parser._actions
