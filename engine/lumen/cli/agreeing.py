"""Ask the person at this terminal for confirmation before a robot moves."""

import sys

from lumen.errors import UsageError


def agrees(question: str, otherwise: str) -> bool:
    """Ask a question on this terminal; return True for y, yes or ya, and False for anything else or for Ctrl-D.

    Raises UsageError with the text `otherwise` if standard input is not a terminal.
    """
    if sys.stdin is None or not sys.stdin.isatty():
        raise UsageError(otherwise)
    try:
        answer = input(f"{question} [y/N] ")
    except EOFError:
        print()
        return False
    return answer.strip().lower() in ("y", "yes", "ya")
