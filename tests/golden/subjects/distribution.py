"""Which files are in the wheel and in the source archive.

Projects and schemas are listed by their paths, since users name them. The engine moves, so only its public modules
are listed (`lumen.fuzzy`), and of its data files the names without folders; each module must be in both archives.
The lists are those that the builder works through; tests/installing compares them with a wheel that was built.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from hatchling.builders.plugin.interface import BuilderInterface
from hatchling.builders.sdist import SdistBuilder
from hatchling.builders.wheel import WheelBuilder

from tests.golden.command_line import CHECKOUT

SUITE = "test"
ENGINE = {"wheel": "lumen/", "sdist": "engine/lumen/"}
EXHIBITION = "lumen/exhibition/"


def record(folder: Path) -> None:
    """Write the list of each, a name on a line."""
    modules = {str(file.relative_to(CHECKOUT / "engine/lumen")) for file in CHECKOUT.glob("engine/lumen/**/*.py")}
    for kind, engine in ENGINE.items():
        names = files(kind)
        missing = {f"{engine}{module}" for module in modules} - set(names)
        assert not missing, f"not in the {kind}: {', '.join(sorted(missing))}"
        (folder / f"{kind}.txt").write_text("".join(f"{line}\n" for line in _lines(names, engine)), "utf-8")


def files(kind: str) -> list[str]:
    """Return the sorted paths in a wheel (but for its dist-info) or in a source archive."""
    builder: BuilderInterface[Any, Any, Any] = (WheelBuilder if kind == "wheel" else SdistBuilder)(str(CHECKOUT))
    with builder.config.set_build_data({"force_include": {}, "force_include_editable": {}, "artifacts": []}):
        found = {file.distribution_path for file in builder.recurse_included_files()}
    return sorted(name for name in found if "/__pycache__/" not in name)


def _lines(names: Iterable[str], engine: str) -> list[str]:
    lines = []
    for name in names:
        if not name.startswith(engine) or name.startswith(EXHIBITION):
            lines.append(name)
        elif not name.endswith(".py"):
            lines.append(f"{engine}**/{name.rpartition('/')[2]}")
        elif "/" not in name.removeprefix(engine):
            lines.append(name)
    return sorted(lines)
