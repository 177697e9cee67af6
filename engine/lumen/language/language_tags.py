"""The codes by which a project names its languages."""

import re

_TAG = re.compile(r"[a-z]{2,3}(-[A-Za-z0-9]+)*")


def is_language_tag(key: object) -> bool:
    """Return True if a key has the form of a language's code: `en`, `pt-BR`."""
    return isinstance(key, str) and _TAG.fullmatch(key) is not None
