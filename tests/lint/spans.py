"""Lint marks the subject of its message: the words that it quotes are in the marked text, or are a key above it."""

import re

from lumen.language.diagnostics import Diagnostic
from lumen.project.yaml_reader import parse

QUOTED = re.compile(r"`([^`]+)`")

ELSEWHERE = {
    *("missing-key", "missing-route", "missing-language", "no-time", "no-rules", "incomplete-posture", "asks-nobody"),
    *("shadowed-transition", "shadowed-answer", "angle-out-of-range"),
}
"""A missing thing has no word to mark: its parent's key is marked. The messages of the last ones quote the reason."""


def marked(diagnostic: Diagnostic, files: dict[str, bytes]) -> str:
    """Return the text from the beginning of the place to its end."""
    place = diagnostic.place
    lines = files.get(place.file, b"").decode("utf-8-sig", "replace").split("\n")[place.line - 1 : place.end_line]
    if not lines:
        return ""
    lines[-1] = lines[-1][: place.end_column - 1]
    lines[0] = lines[0][place.column - 1 :]
    return "\n".join(lines)


def spoken_of(diagnostic: Diagnostic, text: str, files: dict[str, bytes]) -> bool:
    """Return whether the words that the message quotes are in the marked text, or are keys that lead to it."""
    words = [word.strip("#.") for word in QUOTED.findall(diagnostic.message)]
    bare = text.strip().strip("\"'.")
    return any(word in text or bare in word or word in keys(diagnostic, files) for word in words)


def keys(diagnostic: Diagnostic, files: dict[str, bytes]) -> set[str]:
    """Return the keys in which the marked node stands, and its own; a state is called by the last two of its path."""
    document, _ = parse(diagnostic.place.file, files[diagnostic.place.file])
    paths = [path for path, span in document.spans.items() if diagnostic.place in span] if document else []
    names = {step for path in paths for step in path if isinstance(step, str)}
    return names | {f"{one}.{other}" for one in names for other in names}


def assert_marks_what_is_spoken_of(diagnostic: Diagnostic, files: dict[str, bytes]) -> None:
    place, text = diagnostic.place, marked(diagnostic, files)
    assert (place.end_line, place.end_column) >= (place.line, place.column)
    if QUOTED.search(diagnostic.message) and diagnostic.code not in ELSEWHERE and text.strip():
        assert spoken_of(diagnostic, text, files), f"{text!r}: {diagnostic}"
