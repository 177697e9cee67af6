"""`lumen graph`: draw a behaviour as a picture, or write it as text for Mermaid or Graphviz."""

import argparse
import shutil
import subprocess
from pathlib import Path

import lumen
from lumen.cli.formats import configure_format, print_object
from lumen.cli.projects import shown_project
from lumen.cli.writing import write_file
from lumen.errors import UsageError
from lumen.features.formats_charts.mermaid import mermaid
from lumen.language.diagnostics import did_you_mean
from lumen.language.machines import MachineDefinition
from lumen.run.diagrams import dot_text, neighbourhood, overview, region, svg
from lumen.run.diagrams.diagram import Diagram

PICTURES = (".svg", ".png")
LAYOUTS = ("auto", "own", "dot")
DRAWING = 60.0
"""The time limit for Graphviz [s]."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `lumen graph` to the parser."""
    add = parser.add_argument
    add("behavior", nargs="?", help="a behaviour's name (default: the one in lumen.yaml)")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--region", metavar="NAME", help="only the states inside this state, and their targets")
    which.add_argument("--state", metavar="NAME", help="only this state, with the transitions into and out of it")
    add(
        "--project",
        metavar="DIR",
        help="the project's folder (default: this folder or one above, else the shipped project)",
    )
    add("-o", "--output", metavar="FILE", type=Path, help=".svg or .png: a picture; .dot: for Graphviz; else Mermaid")
    add(
        "--layout",
        choices=LAYOUTS,
        default="auto",
        help="lay out with Graphviz (dot) or Lumen (own); auto: Graphviz if installed",
    )
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Write or print the graph, and return 0.

    Raises UsageError if the behaviour or state does not exist, or if the graph can't be drawn or written as requested.
    """
    project = lumen.load(shown_project(options.project))
    name = options.behavior or project.behavior
    if name not in project.behaviors:
        raise UsageError(f"no behaviour `{name}`: {did_you_mean(name, project.behaviors, 'behaviors/ has')}")
    output: Path | None = options.output
    content = _content(options, project.behaviors[name], output.suffix.lower() if output else "")
    if output is None and options.format == "json":
        print_object({"behavior": name, "mermaid": content.decode()})
        return 0
    if output is None:
        print(content.decode(), end="")
        return 0
    write_file(content, output)
    if options.format == "json":
        print_object({"behavior": name, "wrote": str(output)})
    else:
        print(f"wrote {output}")
    return 0


def _content(options: argparse.Namespace, machine: MachineDefinition, ending: str) -> bytes:
    if ending not in (*PICTURES, ".dot"):
        if options.state or options.region:
            raise UsageError("Mermaid shows the whole behaviour: add `-o FILE.svg` for a picture of a part")
        return (mermaid(machine) + "\n").encode()
    diagram = _diagram(options, machine)
    if ending == ".dot":
        return dot_text(diagram).encode()
    dot = shutil.which("dot") if options.layout != "own" else None
    if dot:
        return _by_graphviz(dot, diagram, ending)
    if options.layout == "dot":
        raise UsageError("Graphviz's `dot` is not installed: install it, or leave out --layout dot")
    if ending == ".png":
        raise UsageError("a PNG needs Graphviz: install it, leave out --layout own, or write an .svg")
    return svg(diagram).encode()


def _diagram(options: argparse.Namespace, machine: MachineDefinition) -> Diagram:
    if options.state:
        return neighbourhood(machine, options.state)
    return region(machine, options.region) if options.region else overview(machine)


def _by_graphviz(dot: str, diagram: Diagram, ending: str) -> bytes:
    command = [dot, f"-T{ending[1:]}"]
    try:
        drawn = subprocess.run(command, input=dot_text(diagram).encode(), capture_output=True, timeout=DRAWING)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise UsageError(f"{dot} failed: {error}; use --layout own") from None
    if drawn.returncode:
        said = drawn.stderr.decode(errors="replace").strip().splitlines()
        raise UsageError(f"{dot} failed: {said[0] if said else 'no message'}; use --layout own")
    return drawn.stdout
