"""Build a `SayingSet` from the plain data of a file of sayings, `behaviors/sayings/NAME.yaml`."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.language.sayings import Saying, SayingSet
from lumen.project.document_report import DocumentReport

SAY = "say"


def build_sayings(data: Any, report: DocumentReport, *, name: str) -> SayingSet | None:
    """Return the sayings in the data; None if it is not a map."""
    return SayingSet(name, tuple(_sayings(data))) if isinstance(data, Mapping) else None


def _sayings(data: Mapping[str, Any]) -> Iterator[Saying]:
    for behavior, states in data.items():
        for state, rows in states.items():
            for row, languages in rows.items():
                for language, said in languages.items():
                    for i, one in enumerate(said):
                        body = {SAY: one} if isinstance(one, str) else one
                        slots = {slot: value for slot, value in body.items() if slot != SAY}
                        where = (behavior, state, row, language, i)
                        yield Saying(behavior, state, row, language, body[SAY], slots, where)
