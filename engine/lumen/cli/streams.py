"""Handle standard streams that are closed, on a full disk, or a pipe without a reader (`lumen run | head`)."""

import os
import sys
from contextlib import suppress
from io import TextIOWrapper
from typing import TextIO


def open_streams() -> None:
    """Redirect a closed stream (`>&-`) to the null device, and replace characters that a stream can't encode."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 - until the program ends
        elif isinstance(stream := getattr(sys, name), TextIOWrapper):
            stream.reconfigure(errors="replace")


def hush(stream: TextIO) -> None:
    """Redirect a stream to the null device, and discard what is buffered."""
    with suppress(OSError, ValueError):
        number, nowhere = stream.fileno(), os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, number)
        os.close(nowhere)
        stream.flush()


def complain(text: str) -> None:
    """Print a line to standard error; discard it if the stream can't be written."""
    try:
        print(text, file=sys.stderr, flush=True)
    except OSError:
        hush(sys.stderr)


def finish() -> str:
    """Flush standard output. Return the reason if that fails; empty on success, and if a pipe's reader has gone."""
    try:
        if not sys.stdout.closed:  # the language server closes it
            sys.stdout.flush()
    except BrokenPipeError:
        hush(sys.stdout)
    except OSError as error:
        hush(sys.stdout)
        return (error.strerror or str(error)).lower()
    return ""
