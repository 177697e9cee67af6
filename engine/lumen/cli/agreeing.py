"""What is asked of the person at this terminal before a robot moves."""

import sys

from lumen.errors import UsageError


def agrees(question: str, otherwise: str) -> bool:
    """Whether they say yes; Ctrl-D is a no. Raises UsageError with `otherwise` where nobody sits at a terminal."""
    if sys.stdin is None or not sys.stdin.isatty():
        raise UsageError(otherwise)
    try:
        answer = input(f"{question} [y/N] ")
    except EOFError:
        print()
        return False
    return answer.strip().lower() in ("y", "yes", "ya")
