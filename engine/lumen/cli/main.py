"""The command line: one module for each verb, imported when it is called."""

import argparse
import atexit
import errno
import gc
import os
import sys
import time
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from typing import Any

import lumen
from lumen.cli.intermixed import Help, Intermixed
from lumen.cli.streams import complain, finish, hush, open_streams
from lumen.cli.suggesting import Suggesting, parse, unusable
from lumen.errors import LumenError, ProjectError
from lumen.feature import Subcommand, distribution_of, found, owner, resolve, table
from lumen.upkeep.garbage import gc_paused

STARTED = time.monotonic()

atexit.register(gc.freeze)  # the process frees what is left; a last garbage collection takes a tenth of a short run


def ready() -> float:
    """Return the time since this process began [s]."""
    return time.monotonic() - STARTED


def subcommands() -> dict[str, Subcommand]:
    """Return all subcommands, in the order in which `lumen --help` lists them."""
    listed: Mapping[str, Subcommand] = table("subcommands")
    order: list[str] = []
    for name, row in listed.items():
        order.insert(order.index(row.after) + 1 if row.after in order else len(order), name)
    return {name: listed[name] for name in order}


def command_line(wanted: Collection[str]) -> Suggesting:
    """Return the parser of the command line, in which only the wanted verbs have options: these verbs are imported.

    The others share a parser without options, because a parser for each would take as long as everything else. Raises
    LumenError if a wanted verb belongs to another installed package and can't be imported.
    """
    bare = Intermixed(prog="lumen", formatter_class=Help)

    def parser_of(**given: Any) -> Suggesting:
        return Intermixed(**given) if given["prog"].rpartition(" ")[2] in wanted else bare

    parser = Suggesting(
        prog="lumen",
        description="Describe the behaviour of a humanoid robot in YAML, and run it.",
        epilog=f"Run `lumen VERB --help` for the options of a verb.{_packages()}",
        formatter_class=Help,
    )
    parser.add_argument("--version", action="version", version=f"lumen {lumen.__version__}")
    made: Any = parser_of  # argparse calls it, but the annotation of argparse requires a class
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True, parser_class=made, prog="lumen")
    for verb, row in subcommands().items():
        command = verbs.add_parser(
            verb, help=row.summary, description=row.summary[0].upper() + row.summary[1:] + ".", formatter_class=Help
        )
        if verb in wanted:
            _configure(command, verb, row)
    return parser


def _packages() -> str:
    named = ", ".join(map(str, dict.fromkeys(found().installed.values())))
    return (f" Installed packages with features: {named}." if named else "") + unusable()


def _configure(command: Suggesting, verb: str, row: Subcommand) -> None:
    try:
        with gc_paused():
            module = resolve(row.module)
        module.configure(command)
        command.set_defaults(run=module.run)
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        from lumen.project.broken_features import blamed  # only if it is needed

        raise blamed(owner("subcommands", verb), row.module, error) from error


def main(argv: Sequence[str] | None = None) -> int:
    """Run `lumen` with these arguments, by default those of the process, and return the exit code.

    It is 0 if all is well, 1 for findings or a failed story, 2 if the command could not run, 130 after Ctrl-C. Unknown
    options and `--help` raise SystemExit.
    """
    open_streams()
    arguments = sys.argv[1:] if argv is None else list(argv)
    verb = next((word for word in arguments if not word.startswith("-")), "")
    try:
        parser = command_line((verb,))
    except LumenError as error:
        complain(f"lumen {verb}: {error}")
        return 2
    except KeyboardInterrupt:  # during the import of a package's manifest, for example
        return 130
    if not arguments:
        parser.print_help()
        return 2
    options = parse(parser, arguments)
    code = _run(options)
    if trouble := finish():
        complain(f"lumen {options.verb}: can't print: {trouble}")
        return 2
    return code


def _run(options: argparse.Namespace) -> int:
    import logging  # not for --help and --version

    logging.basicConfig(format="%(levelname)s: %(message)s", level=logging.WARNING)
    try:
        return _exit_code(options.verb, options.run(options))
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
    except (Exception, SystemExit) as error:
        from lumen.project.broken_features import fault_of_package

        own = isinstance(error, SystemExit) and distribution_of(owner("subcommands", options.verb))
        if own or not (reason := _reason(error) or fault_of_package(error)):
            raise
        complain(f"lumen {options.verb}: {reason}")
        return 2


def _exit_code(verb: str, returned: object) -> int:
    """Return the result of a subcommand. Raises LumenError, with the name of its package, if it is no exit code."""
    if isinstance(returned, int):
        return returned
    from lumen.project.broken_features import faulty

    raise faulty(owner("subcommands", verb), f"`run` of its subcommand returned {returned!r}, which is no exit code")


def _reason(error: BaseException) -> str:
    """Return the reason, with advice, if a fault of this machine prevents the subcommand; empty for any other error."""
    if not isinstance(error, OSError):
        return ""
    if error.errno == errno.ENOSPC:
        hush(sys.stdout)
        return "can't print: no space left on device"
    if error.errno == errno.ENAMETOOLONG:
        return f"a name is too long for this system: {str(error.filename)[:40]}…"
    if "No usable temporary directory" in str(error):
        return "no folder for temporary files is writable: set TMPDIR to one that is"
    if not _somewhere():
        return "the current folder no longer exists: `cd` to another one"
    return ""


def _somewhere() -> bool:
    """Return True if the working directory still exists: another process may have deleted it."""
    try:
        return bool(os.getcwd())
    except FileNotFoundError:
        return False


if __name__ == "__main__":
    sys.exit(main())
