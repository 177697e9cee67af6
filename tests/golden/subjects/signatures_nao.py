"""The NAO for dm_control: its own methods, besides those of dm_control's walkers."""

from pathlib import Path

from tests.golden.adapters_running import nao
from tests.golden.signatures import described

SUITE = "rest"
KIN = ("Walker", "Entity")
"""Base classes from dm_control that are promised."""


def record(folder: Path) -> None:
    found = nao()
    lines = [*described("Nao", found, frozenset())]
    kin = ", ".join(dict.fromkeys(one.__name__ for one in found.__mro__ if one.__name__ in KIN))
    (folder / "nao.txt").write_text("\n".join([f"kin: {kin}", *lines]) + "\n", "utf-8")
