"""Names, signatures, fields and base classes of the public modules. Module paths are left out, for they may move."""

import inspect
from importlib import import_module
from pathlib import Path

from tests.golden.signatures import described, offered

SUITE = "test"
MODULES = (
    "lumen",
    "lumen.bus",
    "lumen.errors",
    "lumen.fuzzy",
    "lumen.motion",
    "lumen.ports",
    "lumen.project",
    "lumen.statechart",
)


def record(folder: Path) -> None:
    names = {name: offered(import_module(name)) for name in MODULES}
    public = frozenset(value for found in names.values() for value in found.values() if inspect.isclass(value))
    for name, found in names.items():
        lines = [line for one, value in found.items() for line in described(one, value, public)]
        (folder / f"{name}.txt").write_text("\n".join(lines) + "\n", "utf-8")
