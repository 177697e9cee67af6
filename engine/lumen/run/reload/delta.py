"""A project sent from one process to another, piece by piece: only what is not there already travels and is unpacked.

The pieces of a field that is a mapping are its entries, so that none takes long to unpack: that keeps all threads
waiting.
"""

import pickle
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any, get_origin

from lumen.language.diagnostics import Places
from lumen.language.projects import Project

PieceKey = tuple[str, str | None]
"""A field of a project, or an entry of one that is a mapping; None in place of its name is the mapping itself."""
Delta = dict[PieceKey, bytes | None]
"""The pieces of a project, packed; None for one that was sent the last time."""

LATE = "documents"
"""What stands where in the files: large, and unpacked only when somebody asks."""
MAPPINGS = frozenset(field.name for field in fields(Project) if get_origin(field.type) is Mapping)


class DeltaEncoder:
    """Packs projects; one whose pieces are the very objects of the last one is soon packed."""

    def __init__(self) -> None:
        self._sent: dict[PieceKey, Any] = {}

    def pack(self, project: Project) -> Delta:
        before, self._sent = self._sent, dict(_pieces(project))
        known = {piece for piece, value in self._sent.items() if piece in before and before[piece] is value}
        return {p: None if p in known else pickle.dumps(v, pickle.HIGHEST_PROTOCOL) for p, v in self._sent.items()}


class DeltaDecoder:
    """Unpacks what one sender sends, all of it and in that order."""

    def __init__(self) -> None:
        self._packed: dict[PieceKey, bytes] = {}
        self._pieces: dict[PieceKey, Any] = {}

    @property
    def packed(self) -> Delta:
        """All pieces of the last project, packed."""
        return dict(self._packed)

    def unpack(self, parcel: Delta) -> Project:
        """The project; its pieces are those of the one before wherever they say the same."""
        packed = {piece: data or self._packed[piece] for piece, data in parcel.items()}
        pieces = {
            piece: self._pieces[piece] if self._packed.get(piece) == data else _unpacked(piece, data)
            for piece, data in packed.items()
        }
        self._packed, self._pieces = packed, pieces
        found: dict[str, Any] = {}
        for (field, entry), value in pieces.items():
            if entry is not None:
                found[field][entry] = value
            else:
                found[field] = {} if field in MAPPINGS else value
        return Project(**{**found, LATE: _Documents(found[LATE])})


class _Documents(Mapping[str, Places]):
    """What stands where in the files, by file; a file's is kept once it was asked for, as it is at each step."""

    def __init__(self, packed: Mapping[str, bytes]) -> None:
        self._packed = packed
        self._asked: dict[str, Places] = {}

    def __getitem__(self, file: str) -> Places:
        found = self._asked.get(file)
        if found is None:
            found = self._asked[file] = pickle.loads(self._packed[file])
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(self._packed)

    def __len__(self) -> int:
        return len(self._packed)


def _pieces(project: Project) -> Iterator[tuple[PieceKey, Any]]:
    for field in fields(project):
        value = getattr(project, field.name)
        yield (field.name, None), None if field.name in MAPPINGS else value
        if field.name in MAPPINGS:
            yield from (((field.name, name), entry) for name, entry in value.items())


def _unpacked(piece: PieceKey, data: bytes) -> Any:
    return data if piece[0] == LATE else pickle.loads(data)
