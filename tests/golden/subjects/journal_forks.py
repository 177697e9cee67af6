"""Forks of recorded visits: with another event at some moment, and with other files."""

from pathlib import Path

import lumen
from tests.golden.adapters import forked, read_positions, reloaded_to
from tests.golden.kept import bundles, journals
from tests.golden.texts import in_one_line, write

SUITE = "test"
HEARD = lumen.Event("heard", {"result": "no", "lang": "en"})
FALLEN = lumen.Event("fallen", {"direction": "front"})


def record(folder: Path) -> None:
    """Write a file for each fork."""
    museum, tour = journals()["museum"][0], journals()["outage"][0]
    _, asked = read_positions(museum, "heard")[:2]
    (named,) = read_positions(tour, "heard")[:1]
    newer = reloaded_to(journals()["reload"][-1], bundles(""))
    for name, file, position, event, saved in (
        ("as_it_was", museum, asked, None, None),
        ("no_instead", museum, asked, HEARD, None),
        ("fallen", tour, named, FALLEN, None),
        ("newer_files", tour, named, None, newer),
    ):
        was, would, trouble = forked(file, position, bundles(""), event, saved)
        write(folder / f"{name}.txt", [f"{len(was)} entries were; trouble: {trouble}", *map(in_one_line, would)])
