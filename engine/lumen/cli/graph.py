"""`lumen graph`: a behaviour as a Mermaid diagram."""

import argparse
from pathlib import Path

import lumen
from lumen.errors import UsageError
from lumen.formats.mermaid import mermaid
from lumen.language.diagnostics import did_you_mean


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("behavior", nargs="?", help="a behaviour's name; default: the one that runs")
    parser.add_argument("--project", metavar="DIR", help="default: here or above, else the shipped one")
    parser.add_argument("-o", "--output", metavar="FILE", type=Path, help="write it there instead of printing it")


def run(options: argparse.Namespace) -> int:
    project = lumen.load(options.project)
    name = options.behavior or project.behavior
    if name not in project.behaviors:
        raise UsageError(f"no behaviour `{name}`: {did_you_mean(name, project.behaviors, 'behaviors/ has')}")
    diagram = mermaid(project.behaviors[name])
    if options.output is None:
        print(diagram)
        return 0
    try:
        options.output.write_text(diagram + "\n", encoding="utf-8")
    except OSError as error:
        raise UsageError(f"can't write {options.output}: {error.strerror}") from None
    print(f"wrote {options.output}")
    return 0
