"""The command line: one module for each verb, imported when it is called."""

import argparse
import atexit
import errno
import gc
import importlib
import os
import sys
import time
from collections.abc import Collection, Sequence
from contextlib import suppress

import lumen
from lumen.cli.intermixed import Help, Intermixed
from lumen.cli.streams import complain, finish, hush, open_streams
from lumen.cli.suggesting import Suggesting, parse
from lumen.errors import LumenError, ProjectError
from lumen.upkeep.garbage import gc_paused

STARTED = time.monotonic()

atexit.register(gc.freeze)  # what is left is freed with the process: a last search for garbage would take a tenth of it


def ready() -> float:
    """How long ago this process began [s]."""
    return time.monotonic() - STARTED


VERBS = {
    "new": "start a project of your own",
    "run": "run an exhibition",
    "say": "let the robot of a running exhibition say something",
    "stop": "let the robot of a running exhibition rest, at once",
    "resume": "let a robot that somebody stopped move again",
    "status": "say what a running exhibition is doing",
    "why": "say why something happened in an exhibition",
    "why-not": "say why something did not happen in an exhibition, and what would have made it",
    "goto": "let a running exhibition enter a state",
    "model": "let the language model of a running exhibition answer visitors, or not",
    "reload": "let a running exhibition read its files again, or say which files run",
    "replay": "take the steps of a journal again, with the files that ran then or with others",
    "story": "make a story of a recorded visit, to be kept as a test",
    "diff": "say what differs between two versions of a project, and where a reload would lead",
    "topic": "list, print, measure and send the messages of a running exhibition",
    "record": "record the messages of a running exhibition, for Foxglove and Lichtblick",
    "console": "show a running exhibition in a browser, and steer it from there",
    "doctor": "check an exhibition's bus, and say what is missing on it",
    "fleet": "let many houses take other files, step by step",
    "alerts": "send a test alert to everybody who is told of trouble",
    "lint": "say what is wrong in a project, and where",
    "explain": "say what a code of lint means, and show an example",
    "completion": "print the completion script for bash, zsh or fish",
    "lsp": "answer an editor (Language Server Protocol)",
    "language": "begin another language, and say what is missing in one",
    "schema": "print the JSON Schema of a kind of file, for editors",
    "upgrade": "rewrite a project's files for the vocabulary that this Lumen reads",
    "test": "play the stories, try the sayings, and list those that fail",
    "hear": "explain what a sentence does in a state, row by row",
    "play": "show a motion on the simulated robot",
    "memory": "list the people and things that the robot remembers, and forget somebody",
    "graph": "draw a behaviour (Mermaid)",
    "plot": "draw a controller, its output for some inputs, or a motion",
    "import": "turn a file of another tool into a file of Lumen: a statechart, a motion, a controller",
    "export": "write a behaviour as SCXML, for XState, or as a diagram; the routes as AsyncAPI",
}
MODULES = {"import": "importing", "export": "exporting", "why-not": "why_not"}
"""Modules of verbs that are words of Python, or no words of it."""


def command_line(wanted: Collection[str]) -> Suggesting:
    """What reads the command line. Only the verbs that are wanted know their options: each is imported for that."""
    parser = Suggesting(
        prog="lumen",
        description="Give a humanoid robot its behaviour in YAML.",
        epilog="lumen VERB --help says more.",
        formatter_class=Help,
    )
    parser.add_argument("--version", action="version", version=f"lumen {lumen.__version__}")
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True, parser_class=Intermixed, prog="lumen")
    for verb, summary in VERBS.items():
        command = verbs.add_parser(
            verb, help=summary, description=summary[0].upper() + summary[1:] + ".", formatter_class=Help
        )
        if verb in wanted:
            with gc_paused():
                module = importlib.import_module(f"lumen.cli.{MODULES.get(verb, verb)}")
            module.configure(command)
            command.set_defaults(run=module.run)
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run `lumen` with these arguments: 0 all well, 1 findings or a failed story, 2 could not run."""
    open_streams()
    arguments = sys.argv[1:] if argv is None else list(argv)
    if not arguments:
        command_line(()).print_help()
        return 2
    options = parse(command_line(arguments[:1]), arguments)
    code = _run(options)
    if trouble := finish():
        complain(f"lumen {options.verb}: can't print: {trouble}")
        return 2
    return code


def _run(options: argparse.Namespace) -> int:
    import logging  # not for --help and --version

    logging.basicConfig(format="%(levelname)s: %(message)s", level=logging.WARNING)
    try:
        return int(options.run(options))
    except ProjectError as error:
        from lumen.cli.report import report

        with suppress(OSError):
            return report(error.diagnostics)
        return 1
    except LumenError as error:
        complain(f"lumen {options.verb}: {error}")
        return 2
    except BrokenPipeError:
        hush(sys.stdout)
        return 0
    except KeyboardInterrupt:
        return 130
    except OSError as error:
        if error.errno == errno.ENOSPC:
            hush(sys.stdout)
            complain(f"lumen {options.verb}: can't print: no space left on device")
        elif error.errno == errno.ENAMETOOLONG:
            complain(f"lumen {options.verb}: a name is too long for this system: {str(error.filename)[:40]}…")
        elif "No usable temporary directory" in str(error):
            complain(f"lumen {options.verb}: no folder for temporary files can be written: set TMPDIR to one that can")
        elif not _somewhere():
            complain(f"lumen {options.verb}: the folder that you are in is gone: `cd` to another one")
        else:
            raise
        return 2


def _somewhere() -> bool:
    """Whether the working directory is there: somebody may have deleted it."""
    try:
        return bool(os.getcwd())
    except FileNotFoundError:
        return False


if __name__ == "__main__":
    sys.exit(main())
