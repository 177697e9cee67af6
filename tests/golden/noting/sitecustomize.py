"""Imported by each Python that starts with this folder on its path: notes which programs it begins.

A look at /proc would miss programs that end soon. The notes are lines of JSON, who begins what, in the file that the
environment names.
"""

import _posixsubprocess
import json
import os
import sys
from typing import Any

NOTES = "GOLDEN_NOTES"

_begin = _posixsubprocess.fork_exec
_fork = os.fork


def _note(child: list[str]) -> None:
    line = json.dumps([sys.orig_argv, child]) + "\n"
    handle = os.open(os.environ[NOTES], os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    os.write(handle, line.encode())
    os.close(handle)


def _noted(arguments: Any, *more: Any) -> int:
    _note([os.fsdecode(one) for one in arguments])
    return _begin(arguments, *more)


def _forked() -> int:
    _note(["a fork"])
    return _fork()


if NOTES in os.environ:
    _posixsubprocess.fork_exec = _noted
    os.fork = _forked
