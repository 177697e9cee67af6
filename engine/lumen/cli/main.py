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
    "say": "make the robot of a running exhibition say something",
    "stop": "make the robot of a running exhibition rest at once",
    "resume": "let a stopped robot move again",
    "status": "show what a running exhibition is doing",
    "why": "explain why something happened in an exhibition",
    "why-not": "explain why something did not happen, and what would have made it happen",
    "goto": "make a running exhibition enter a state",
    "model": "switch the language model of a running exhibition on or off",
    "reload": "reload the files of a running exhibition, or show which files are active",
    "replay": "repeat the steps of a journal, with the files that ran then or with others",
    "story": "turn a recorded visit into a story, to keep as a test",
    "diff": "compare two versions of a project, and preview a reload",
    "topic": "list, print, measure and send the messages of a running exhibition",
    "record": "record the messages of a running exhibition, for Foxglove and Lichtblick",
    "console": "show a running exhibition in a browser, and control it from there",
    "doctor": "check an exhibition's bus, and report what is missing",
    "fleet": "update the robots of many houses, step by step",
    "alerts": "send a test alert to every recipient",
    "lint": "report what is wrong in a project, and where",
    "explain": "explain a lint code, with an example",
    "completion": "print the completion script for bash, zsh or fish",
    "lsp": "run the language server for editors (LSP)",
    "language": "add a language to a project, or list what is missing in one",
    "schema": "print the JSON Schema of a kind of file, for editors",
    "upgrade": "rewrite a project's files for the current vocabulary",
    "test": "play the stories, try the sayings, and list those that fail",
    "hear": "explain how a state reacts to a sentence, row by row",
    "play": "play a motion on the simulated robot",
    "memory": "list what the robot remembers, or forget a visitor",
    "graph": "draw a behaviour as a diagram",
    "plot": "draw a controller, its outputs for given inputs, or a motion",
    "import": "convert another tool's statechart, motion, controller or robot",
    "export": "write a behaviour as SCXML, for XState or as a diagram; the routes as AsyncAPI",
}
MODULES = {"import": "importing", "export": "exporting", "why-not": "why_not"}
"""Modules of verbs that are words of Python, or no words of it."""


def command_line(wanted: Collection[str]) -> Suggesting:
    """What reads the command line. Only the verbs that are wanted know their options: each is imported for that."""
    parser = Suggesting(
        prog="lumen",
        description="Describe the behaviour of a humanoid robot in YAML, and run it.",
        epilog="Run `lumen VERB --help` for the options of a verb.",
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
            complain(f"lumen {options.verb}: no folder for temporary files is writable: set TMPDIR to one that is")
        elif not _somewhere():
            complain(f"lumen {options.verb}: the current folder no longer exists: `cd` to another one")
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
