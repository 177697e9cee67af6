"""`lumen upgrade`: rewrite a project's files for the vocabulary that this version of Lumen reads."""

import argparse
import json
from collections.abc import Iterator, Sequence
from pathlib import Path

from lumen.cli.fixing import diff, write
from lumen.cli.render.terminal_text import clean, counted
from lumen.cli.terminal import coloured
from lumen.errors import UsageError
from lumen.language.diagnostics import has_errors
from lumen.language.vocabulary import VOCABULARY
from lumen.lint.robot_keys import old_keys, with_robot_keys
from lumen.lint.upgrading import Rewriting, upgraded
from lumen.project.files import read_files
from lumen.project.running_project import own_project
from lumen.run.linting.targets import checked


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen upgrade` to its parser."""
    parser.add_argument(
        "project", nargs="?", metavar="PROJECT", help="the project's folder (default: this folder or one above)"
    )
    parser.add_argument("--diff", action="store_true", help="print what would be written, and write nothing")
    parser.add_argument(
        "--check", action="store_true", help="write nothing; exit code 1 if something must be rewritten"
    )
    parser.add_argument(
        "--keys", action="store_true", help="also add {robot} to keys from 2015, and keep the old keys as aliases"
    )
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Rewrite the files and list the changes; return 1 if errors are left, else 0.

    With --check write nothing, and return 1 if something must be rewritten. With --diff only print the changes, and
    return 0. Raises UsageError if --diff is combined with --check or `--format json`.
    """
    if options.diff and (options.check or options.format != "text"):
        raise UsageError("--diff can't be combined with --check or --format")
    root = own_project(Path(options.project) if options.project else None)
    before = read_files(root)
    after, done = upgraded(before)
    if options.keys:
        after, renamed = with_robot_keys(after)
        done += renamed
    if options.diff:
        print("\n".join(diff(root, before, after, coloured())))
        return 0
    if not options.check:
        write(root, before, after)
    left = None if options.check else has_errors(checked(root, after))
    if options.format == "json":
        rows = [{"file": each.place.file, "line": each.place.line, "why": each.why} for each in done]
        print(json.dumps({"vocabulary": VOCABULARY, "rewritten": rows, "errors": left}, ensure_ascii=False))
    else:
        print("\n".join(_text(done, left)))
        if old := old_keys(after):
            print(f"{counted(len(old), 'key')} from 2015 would reach several robots: run `lumen upgrade --keys`")
    return int(bool(done) if left is None else left)


def _text(done: Sequence[Rewriting], left: bool | None) -> Iterator[str]:
    for each in done:
        yield clean(f"{each.place.file}:{each.place.line}  {each.why}")
    if left is None:
        yield f"{counted(len(done), 'place')} to rewrite for vocabulary {VOCABULARY}"
        return
    yield f"{counted(len(done), 'place')} rewritten; the files now use vocabulary {VOCABULARY}"
    if left:
        yield "the files have errors: run `lumen lint`"
