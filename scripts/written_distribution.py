"""Distributions written into a folder as an installer would leave them, and used from there by this process."""

import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from importlib import invalidate_caches
from pathlib import Path
from types import ModuleType
from typing import Any


def write_distribution(folder: Path, name: str, manifest: str, files: Mapping[str, str], version: str = "1.0") -> None:
    """Write a distribution with these files, and an entry point for the import string `manifest` of a feature."""
    metadata = {
        "METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n",
        "entry_points.txt": f"[lumen.features]\n{name} = {manifest}\n",
        "RECORD": "".join(f"{file},,\n" for file in files),
    }
    described = {f"{name.replace('-', '_')}-{version}.dist-info/{file}": text for file, text in metadata.items()}
    for file, text in {**files, **described}.items():
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


@contextmanager
def on_path(folder: Path) -> Iterator[None]:
    """Let this process import modules from that folder, including features, while the context lasts."""
    before = set(sys.modules)
    sys.path.insert(0, str(folder))
    _forget()
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        for name in set(sys.modules) - before:
            if str(getattr(sys.modules[name], "__file__", "")).startswith(f"{folder}/"):
                del sys.modules[name]
        _forget()


def _forget() -> None:
    """Let Lumen find its features again: clear the caches of its functions.

    The process that waits to check files has the features of its own start, so it ends.
    """
    invalidate_caches()
    if idle := sys.modules.get("lumen.run.reload.idle_process"):
        idle.end_idle()
    for name, module in list(sys.modules.items()):
        if name.partition(".")[0] == "lumen":
            for function in _cached(module):
                function.cache_clear()


@cache
def _cached(module: ModuleType) -> Sequence[Any]:
    """Return the functions of a module with a cache; a function that the module imported is one of another module."""
    return [value for value in vars(module).values() if hasattr(value, "cache_clear")]
