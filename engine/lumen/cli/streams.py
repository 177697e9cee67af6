"""Standard output and error: closed by the shell, full, or a pipe that nobody reads any more (`lumen run | head`)."""

import os
import sys
from contextlib import suppress
from io import TextIOWrapper
from typing import TextIO


def open_streams() -> None:
    """Let prints go nowhere where the shell has closed a stream (`>&-`), and signs that it can't show be replaced."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 - until the program ends
        elif isinstance(stream := getattr(sys, name), TextIOWrapper):
            stream.reconfigure(errors="replace")


def hush(stream: TextIO) -> None:
    """Let what is printed there from now on, and what waits there, go nowhere."""
    with suppress(OSError, ValueError):
        number, nowhere = stream.fileno(), os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, number)
        os.close(nowhere)
        stream.flush()


def complain(text: str) -> None:
    """Print a line to standard error, if anybody reads it."""
    try:
        print(text, file=sys.stderr, flush=True)
    except OSError:
        hush(sys.stderr)


def finish() -> str:
    """Print what still waits; why that can't be printed, empty where it could or where nobody reads it."""
    try:
        if not sys.stdout.closed:  # as the language server leaves it
            sys.stdout.flush()
    except BrokenPipeError:
        hush(sys.stdout)
    except OSError as error:
        hush(sys.stdout)
        return (error.strerror or str(error)).lower()
    return ""
