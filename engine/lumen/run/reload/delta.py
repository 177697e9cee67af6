"""A project sent between two processes in pieces, of which only new ones are sent and unpacked.

The pieces of a mapping field are its entries, so that none takes long to unpack: unpacking blocks all threads.
"""

import pickle
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any, get_origin

from lumen.language.diagnostics import Places
from lumen.language.projects import Project

PieceKey = tuple[str, str | None]
"""A field of a project, and an entry of it if the field is a mapping; with None as entry it is the field itself."""
Delta = dict[PieceKey, bytes | None]
"""The pieces of a project, packed; None for one that was sent with the previous project."""

LATE = "documents"
"""The field with the places of nodes in the files: it is large, and unpacked only on demand."""
MAPPINGS = frozenset(field.name for field in fields(Project) if get_origin(field.type) is Mapping)
"""The fields that are mappings."""


class DeltaEncoder:
    """A packer of projects; pieces that are the same objects as in the last project cost nothing."""

    def __init__(self) -> None:
        self._sent: dict[PieceKey, Any] = {}

    def pack(self, project: Project) -> Delta:
        """Return a project's pieces, with None for those sent before."""
        before, self._sent = self._sent, dict(_pieces(project))
        known = {piece for piece, value in self._sent.items() if piece in before and before[piece] is value}
        return {p: None if p in known else pickle.dumps(v, pickle.HIGHEST_PROTOCOL) for p, v in self._sent.items()}


class DeltaDecoder:
    """An unpacker for all deltas of one sender, which must arrive in order."""

    def __init__(self) -> None:
        self._packed: dict[PieceKey, bytes] = {}
        self._pieces: dict[PieceKey, Any] = {}

    @property
    def packed(self) -> Delta:
        """All pieces of the last project, packed."""
        return dict(self._packed)

    def unpack(self, parcel: Delta) -> Project:
        """Return the project; pieces that did not change are the objects of the previous project."""
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
    """The places of nodes by file; those of a file are unpacked on first use, and cached."""

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
