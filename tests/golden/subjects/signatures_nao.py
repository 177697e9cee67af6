"""What the NAO for dm_control offers besides what dm_control's own walkers do."""

from pathlib import Path

from tests.golden.adapters_running import nao
from tests.golden.signatures import described

SUITE = "rest"
KIN = ("Walker", "Entity")
"""What of dm_control it promises to be."""


def record(folder: Path) -> None:
    found = nao()
    lines = [*described("Nao", found, frozenset())]
    kin = ", ".join(dict.fromkeys(one.__name__ for one in found.__mro__ if one.__name__ in KIN))
    (folder / "nao.txt").write_text("\n".join([f"kin: {kin}", *lines]) + "\n", "utf-8")
