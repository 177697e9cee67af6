"""The names that an importer knows of a format: it reads them, lists them as lost, or ignores them as meaningless.

Each importer has one table of these, by the place in a file (`<state>`, `[Input1]`, `machine`). A name that no table
has is listed at its place, so that nothing of a file is lost silently. `docs/formats.md` prints the tables.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches


@dataclass(frozen=True)
class Known:
    """The names that one kind of place in a file may hold: attributes, elements, keys, calls.

    `read` are carried over; `lost` are listed, with the reason; `meaningless` change nothing of what a robot does, with
    the reason. `lowercase` says that the format does not tell upper from lower case.
    """

    read: frozenset[str] = frozenset()
    lost: Mapping[str, str] = field(default_factory=dict)
    meaningless: Mapping[str, str] = field(default_factory=dict)
    lowercase: bool = False

    def losses(self, names: Iterable[str]) -> Iterator[tuple[str, str]]:
        """Of these names, each that is not carried over and has a meaning or may have one, with a hint."""
        for name in names:
            plain = name.lower() if self.lowercase else name
            if plain in self.lost:
                yield name, self.lost[plain]
            elif plain not in self.read and plain not in self.meaningless:
                near = get_close_matches(plain, self.read, 1)
                yield name, f"did you mean `{near[0]}`?" if near else ""


FormatTable = Mapping[str, Known]
"""The known names of a format, by the kind of place in a file."""
