"""`lumen completion SHELL`: print the script that makes a shell complete verbs, options and names of the project."""

import argparse
from importlib.resources import files

from lumen.cli.completing import candidates
from lumen.cli.main import command_line
from lumen.cli.project_names import names_of
from lumen.errors import UsageError

SHELLS = ("bash", "zsh", "fish")
WORDS = "words"


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen completion` to its parser."""
    parser.description = (
        "Print a script that lets a shell complete verbs, options, and the names of stories, motions, states and codes."
    )
    what = "`words` is for these scripts: it completes the last word of a command line; each word has a leading dot"
    parser.add_argument("shell", metavar="SHELL", choices=(*SHELLS, WORDS), help=f"{', '.join(SHELLS)}; {what}")
    parser.add_argument("words", nargs="*", metavar="WORD", help=argparse.SUPPRESS)


def run(options: argparse.Namespace) -> int:
    """Print the script of a shell, or the completions of the given words; return 0.

    Raises UsageError if words follow the shell's name.
    """
    if options.shell == WORDS:
        typed = [word.removeprefix(".") for word in options.words]
        for word, says in candidates(command_line(typed[:1]), typed, names_of):
            print(f"{word}\t{' '.join(says.replace('%%', '%').split())}")
    elif options.words:
        raise UsageError(f"too many words: write only `lumen completion {options.shell}`")
    else:
        print(files("lumen.cli").joinpath("shells", f"lumen.{options.shell}").read_text(encoding="utf-8"), end="")
    return 0
