"""`lumen export`: write a behaviour or a fuzzy controller in the format of another tool."""

import argparse
import sys
from functools import partial
from pathlib import Path
from typing import Any

import lumen
from lumen.cli.projects import shown_project
from lumen.cli.render import finding_formats, render
from lumen.cli.terminal import coloured
from lumen.cli.writing import write_result
from lumen.errors import UsageError
from lumen.feature import Exporter, Feature, owner, table
from lumen.language.diagnostics import Diagnostic, did_you_mean, has_errors
from lumen.language.projects import Project
from lumen.project.broken_features import called, called_for_text, faulty, shown
from lumen.project.document import Document
from lumen.project.files import on_disk
from lumen.project.yaml_reader import parse
from lumen.run.linting.findings import Findings


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen export` to its parser."""
    parser.description = (
        "Write a behaviour as SCXML, as an XState configuration, or as a diagram for Mermaid or Graphviz; a fuzzy"
        " controller in FuzzyLite Language; or all routes and bodies as an AsyncAPI document. Parts"
        " that the format can't express are left out and listed with their lines; the exit code is then 1."
    )
    targets = tuple(table("exporters"))
    parser.add_argument("target", metavar="FORMAT", choices=targets, help=" | ".join(targets))
    which = "a behaviour (default: the one that lumen.yaml names) or a controller (default: the only one)"
    parser.add_argument("behavior", nargs="?", metavar="NAME", help=which)
    parser.add_argument(
        "--project",
        metavar="DIR",
        help="the project's folder (default: this folder or one above, else the shipped project)",
    )
    parser.add_argument("-o", "--output", metavar="FILE", type=Path, help="write to this file instead of printing")
    parser.add_argument(
        "--format",
        choices=finding_formats(),
        default="text",
        help="format of the list of omissions (default: text)",
    )


def run(options: argparse.Namespace) -> int:
    """Write the export; return 0 if it is complete, 1 if parts that the format can't express were left out.

    Raises UsageError if the project has no behaviour or controller of the given name.
    """
    root = shown_project(options.project)
    project = lumen.load(root)
    row: Exporter = table("exporters")[options.target]
    feature = owner("exporters", options.target)
    write_text, write = partial(called_for_text, feature, row.write), partial(_reported, feature, row.write)
    if row.kind == "project":
        write_result(write_text(project), options.output)
        return 0
    if row.kind == "controller":
        name = _controller(project, options.behavior)
        document = _document(root, f"fuzzy/{name}.yaml")
        text, diagnostics = write(project.controllers[name], document.place)
        return _written(text, diagnostics, document, options)
    name = options.behavior or project.behavior
    if name not in project.behaviors:
        raise UsageError(f"no behaviour `{name}`: {did_you_mean(name, project.behaviors, 'behaviors/ has')}")
    document, machine = _document(root, f"behaviors/{name}.yaml"), project.behaviors[name]
    text, diagnostics = (write_text(machine), []) if row.kind == "diagram" else write(machine, document.place)
    return _written(text, diagnostics, document, options)


def _reported(feature: Feature, where: str, *arguments: Any) -> tuple[str, list[Diagnostic]]:
    """Return the text of an exporter, and a diagnostic for each part that it left out."""
    match called(feature, where, *arguments):
        case (str() as text, [*left_out]) if all(isinstance(each, Diagnostic) for each in left_out):
            return text, left_out
        case other:
            raise faulty(feature, f"`{where}` returned {shown(other)} instead of a text and diagnostics")


def _controller(project: Project, wanted: str | None) -> str:
    """Return the name of the wanted controller, else of the only one. Raises UsageError if there is none."""
    name = wanted or (next(iter(project.controllers)) if len(project.controllers) == 1 else "")
    if name not in project.controllers:
        hint = did_you_mean(name, project.controllers, "fuzzy/ has")
        raise UsageError(f"no controller `{name}`: {hint}" if name else f"name a controller: {hint}")
    return name


def _written(text: str, diagnostics: list[Diagnostic], document: Document, options: argparse.Namespace) -> int:
    write_result(text, options.output)
    if diagnostics or options.format != "text":
        files = {document.file: document.text.encode()}
        print(render(options.format, [Findings(diagnostics, files)], coloured=coloured(sys.stderr)), file=sys.stderr)
    return int(has_errors(diagnostics))


def _document(root: Path, file: str) -> Document:
    """Return a file of the project, parsed: the list of omissions refers to its lines."""
    document = parse(file, on_disk(root, file).read_bytes())[0]
    assert document is not None  # it was loaded a moment ago
    return document
