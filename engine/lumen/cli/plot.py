"""`lumen plot`: draw a controller or a motion."""

import argparse
from pathlib import Path

import lumen
from lumen.cli.formats import configure_format, print_object
from lumen.cli.projects import shown_project
from lumen.cli.writing import write_file
from lumen.errors import UsageError
from lumen.fuzzy import Controller
from lumen.language.diagnostics import did_you_mean
from lumen.motion import Motion
from lumen.project.files import on_disk
from lumen.project.formats.plots import PLOT_ENDINGS, PlotSheet, controller_sheet, draw, explained_sheet, motion_sheet


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen plot` to its parser."""
    parser.description = (
        "Draw a fuzzy controller: the membership functions of its variables, and its outputs over its inputs; with"
        " --at, how its rules fire for these inputs, and the result. Or draw a motion: each joint over time, within its"
        " limits."
    )
    parser.add_argument("file", metavar="FILE", help="fuzzy/NAME.yaml or motions/NAME.yaml")
    parser.add_argument("--at", metavar="INPUT=VALUE", nargs="+", default=[], help="a value for each input")
    parser.add_argument(
        "-o", "--output", metavar="FILE", type=Path, help="a .png or .svg (default: NAME.png in this folder)"
    )
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Draw the file as a .png or .svg and print the path of the drawing; return 0.

    Raises UsageError if the file can't be read, `--at` does not fit it, or the drawing can't be written, and
    ProjectError if the file has mistakes.
    """
    path = _found(options.file)
    output = options.output or Path(f"{path.stem}.png")
    if (ending := output.suffix.lower()) not in PLOT_ENDINGS:
        raise UsageError(f"can't draw {output}: the name must end in {' or '.join(PLOT_ENDINGS)}")
    if not output.parent.is_dir():
        raise UsageError(f"can't write {output}: there is no folder {output.parent}")
    sheet = _motion(path, options.at) if path.absolute().parent.name == "motions" else _controller(path, options.at)
    content = draw(sheet, ending)
    write_file(content, output)
    if options.format == "json":
        print_object({"file": options.file, "wrote": str(output.absolute())})
    else:
        print(f"wrote {output.absolute()}")
    return 0


def _found(name: str) -> Path:
    """Return the path of a file in this folder, or else in the project around it.

    Raises UsageError if neither has it.
    """
    if Path(name).is_file():
        return Path(name)
    root = shown_project(None)
    if (file := on_disk(root, name)).is_file():
        return file
    there = [
        str(p.relative_to(root)) for folder in ("fuzzy", "motions") for p in sorted((root / folder).glob("*.yaml"))
    ]
    raise UsageError(f"no file {name}: {did_you_mean(name, there, 'there are')}")


def _controller(path: Path, at: list[str]) -> PlotSheet:
    controller = Controller.load(path)
    if not at:
        return controller_sheet(controller)
    return explained_sheet(controller, controller.explain(dict(map(_given, at))))


def _given(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        return name, float(value)
    except ValueError:
        raise UsageError(f"invalid `--at {text}`: write an input and a number, such as FaceXLoc=80") from None


def _motion(path: Path, at: list[str]) -> PlotSheet:
    if at:
        raise UsageError(f"--at is for controllers, but {path} is a motion: leave it out")
    home = path.absolute().parent.parent
    return motion_sheet(Motion.load(path), lumen.load(home if (home / "lumen.yaml").is_file() else None).body)
