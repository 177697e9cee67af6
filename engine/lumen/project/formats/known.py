"""The names of a format that an importer recognises: it reads them, lists them as lost, or ignores them as meaningless.

Each importer has one table of these, by the place in a file (`<state>`, `[Input1]`, `machine`). A name that no table
has is listed at its place, so that nothing in a file is lost silently. `docs/formats.md` prints the tables.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches


@dataclass(frozen=True)
class Known:
    """The names that one kind of place in a file may hold: attributes, elements, keys, calls."""

    read: frozenset[str] = frozenset()
    """The names that are carried over."""
    lost: Mapping[str, str] = field(default_factory=dict)
    """The names that are listed as lost, with a hint."""
    meaningless: Mapping[str, str] = field(default_factory=dict)
    """The names that have no effect on a robot, with the reason."""
    lowercase: bool = False
    """True if the format ignores case; the names above are then in lower case."""

    def losses(self, names: Iterable[str]) -> Iterator[tuple[str, str]]:
        """Yield each of these names that is lost or unknown, with a hint."""
        for name in names:
            plain = name.lower() if self.lowercase else name
            if plain in self.lost:
                yield name, self.lost[plain]
            elif plain not in self.read and plain not in self.meaningless:
                near = get_close_matches(plain, self.read, 1)
                yield name, f"did you mean `{near[0]}`?" if near else ""


FormatTable = Mapping[str, Known]
"""The known names of a format, by the kind of place in a file."""
