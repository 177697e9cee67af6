"""A parser that allows options before, between and after other words: `export scxml --project here tour`; and help."""

import argparse
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from lumen.cli.suggesting import Suggesting


class Help(argparse.HelpFormatter):
    """Python's help formatter, without importing `shutil` for the terminal's width.

    That import takes as long as reading ten files.
    """

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=_columns() - 2)

    def _expand_help(self, action: argparse.Action) -> str:
        """Return an option's help; a `%` that names no value of argparse, such as `100% sure`, stays as it is."""
        text = self._get_help_string(action) or ""
        with suppress(KeyError, TypeError, ValueError):
            return super()._expand_help(action) if "%(" in text else text.replace("%%", "%")
        return text


def _columns() -> int:
    with suppress(ValueError):
        return int(os.environ.get("COLUMNS", "")) or 80
    try:
        return os.get_terminal_size(1).columns or 80
    except OSError:
        return 80


class Intermixed(Suggesting):
    """A parser that reads the options first, because argparse treats `[NAME]` as missing if an option precedes it.

    Its help ends with examples.
    """

    _mixing = False

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: Any = None
    ) -> tuple[Any, list[str]]:
        """Parse as argparse does, but allow options between the positional arguments, unless there is a `--`."""
        if self._mixing or "--" in (sys.argv[1:] if args is None else args):  # after `--` everything is positional
            return super().parse_known_args(args, namespace)
        self._mixing = True
        try:
            return self.parse_known_intermixed_args(args, namespace)
        finally:
            self._mixing = False

    def format_help(self) -> str:
        """Return Python's help, followed by the examples of the verb's page."""
        from lumen.cli.pages import page  # only --help needs it

        shown = "\n".join(f"  {one.command}\n      {one.says}" for one in page(self.prog.split()[-1]).examples)
        return super().format_help() + (f"\nexamples:\n{shown}\n" if shown else "")
