"""Findings about a conversion: what a format can't represent, and faults in a file of another format."""

from collections.abc import Callable

from lumen.language.diagnostics import Diagnostic, NodePath, Place, Severity

MAX_FILE_BYTES = 4_000_000
"""The maximum size of another tool's file [bytes]; those that people draw are a hundredth of that."""

PlaceOfPath = Callable[[NodePath], Place]
"""A function that returns the place of the node at a path of a behaviour's file."""

LOST, CHANGED = "not-carried-over", "carried-over-differently"
CODE_MEANINGS = {
    LOST: "a part that `lumen import` or `lumen export` left out, so the result behaves differently",
    CHANGED: "a part that `lumen import` or `lumen export` wrote in another form, or that only Lumen understands",
}


class ForeignFileError(Exception):
    """Raised if a file can't be read at all; holds the one diagnostic with the reason."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(str(diagnostic))
        self.diagnostic = diagnostic


class ConversionFindings:
    """Collects what was lost or changed in a conversion, each item once.

    A `lost` part is absent from the result, which is an error because the behaviour differs. A `changed` part has
    another form in the result, which is worth checking.
    """

    def __init__(self) -> None:
        self._found: dict[Diagnostic, None] = {}

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All findings, sorted by file and line."""
        return sorted(self._found, key=lambda d: (d.place, d.message))

    def lost(self, place: Place, message: str, hint: str = "") -> None:
        """Report a part that is left out."""
        self._found[Diagnostic(LOST, message, place, hint)] = None

    def changed(self, place: Place, message: str, hint: str = "") -> None:
        """Report a part that has another form in the result."""
        self._found[Diagnostic(CHANGED, message, place, hint, Severity.WARNING)] = None

    def include(self, other: "ConversionFindings") -> None:
        """Add the findings of another part of the conversion."""
        self._found |= other._found


def check_size(file: str, content: bytes) -> None:
    """Raise ForeignFileError if a file is too large to be read."""
    if len(content) > MAX_FILE_BYTES:
        hint = f"the maximum is {MAX_FILE_BYTES // 1_000_000} MB"
        raise broken(Place(file), "too-large", f"the file is too large: {len(content) / 1e6:.0f} MB", hint)


def decoded(file: str, content: bytes) -> str:
    """Return the file's text. Raises ForeignFileError if it is not UTF-8."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise broken(Place(file), "not-utf8", "the file is not UTF-8 text", "save it as UTF-8") from None


def broken(place: Place, code: str, message: str, hint: str = "") -> ForeignFileError:
    """Return the error to raise for a file that can't be read."""
    return ForeignFileError(Diagnostic(code, message, place, hint))


class ExportReport:
    """Collects the parts that an export leaves out or changes, and the words that only Lumen understands.

    Each of these words is reported once, at its first place. `place` returns the place of a node in the behaviour's
    file, and `hint` is the hint about foreign words.
    """

    def __init__(self, place: PlaceOfPath, hint: str = "other tools ignore it") -> None:
        self.place, self.hint = place, hint
        self.findings = ConversionFindings()
        self._foreign: dict[str, list[Place]] = {}

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All findings, sorted by line."""
        for word, places in self._foreign.items():
            times = f", {len(places)} times" if len(places) > 1 else ""
            self.findings.changed(min(places), f"only Lumen understands {word}{times}", self.hint)
        self._foreign.clear()
        return self.findings.diagnostics

    def lost(self, message: str, where: NodePath, hint: str = "") -> None:
        """Report a part that is left out."""
        self.findings.lost(self.place(where), message, hint)

    def changed(self, message: str, where: NodePath, hint: str = "") -> None:
        """Report a part that has another form in the result."""
        self.findings.changed(self.place(where), message, hint)

    def foreign(self, word: str, where: NodePath) -> None:
        """Report a part that only Lumen understands."""
        self._foreign.setdefault(word, []).append(self.place(where))


def dotted(file: str) -> PlaceOfPath:
    """Return a function that gives the places in a behaviour without a file: the dotted paths of its nodes."""
    return lambda where: Place(f"{file} ({'.'.join(map(str, where))})" if where else file)
