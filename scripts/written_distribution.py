"""Distributions written into a folder as an installer would leave them, and used from there by this process."""

import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from importlib import invalidate_caches
from pathlib import Path
from traceback import walk_stack
from types import CodeType, ModuleType
from typing import Any
from unittest.mock import patch

PATIENCE = 60.0
"""The time that other threads have to leave the functions with caches [s]; only one that hangs needs it."""


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
    """Let this process import modules from that folder, including features, while the context lasts.

    Meanwhile Lumen remembers no file that it read with other features: a section of lumen.yaml is an object of a class
    that is imported anew.
    """
    from lumen.project import memoization  # late: most callers of this module only write a distribution

    before = set(sys.modules)
    sys.path.insert(0, str(folder))
    _forget()
    try:
        with patch.dict(memoization._last, clear=True):
            yield
    finally:
        sys.path.remove(str(folder))
        for name in set(sys.modules) - before:
            if str(getattr(sys.modules[name], "__file__", "")).startswith(f"{folder}/"):
                del sys.modules[name]
        _forget()


def _forget() -> None:
    """Let Lumen find its features again: clear the caches of its functions.

    A thread that an earlier test has left may be inside such a function, and store what it found on the previous import
    path. So the caches are cleared again when no thread is inside one. The process that waits to check files has the
    features of its own start, so it ends. Raises TimeoutError if a thread stays inside.
    """
    invalidate_caches()
    if idle := sys.modules.get("lumen.run.reload.idle_process"):
        idle.end_idle()
    modules = [module for name, module in list(sys.modules.items()) if name.partition(".")[0] == "lumen"]
    functions = [function for module in modules for function in _cached(module)]
    _clear(functions)
    codes = {function.__wrapped__.__code__ for function in functions}
    deadline = time.monotonic() + PATIENCE
    while inside := codes & (_running() | _running()):
        if time.monotonic() > deadline:
            names = ", ".join(sorted(code.co_qualname for code in inside))
            raise TimeoutError(f"after {PATIENCE:g} s, another thread is still in {names}")
        time.sleep(0.001)
    _clear(functions)


def _clear(functions: Sequence[Any]) -> None:
    for function in functions:
        function.cache_clear()


def _running() -> set[CodeType]:
    """Return the code that other threads are executing, with that of all callers."""
    usual = sys.getswitchinterval()
    sys.setswitchinterval(1.0)  # a function that returns meanwhile would hide its callers
    try:
        frames = {thread: frame for thread, frame in sys._current_frames().items() if thread != threading.get_ident()}
        return {each.f_code for frame in frames.values() for each, _ in walk_stack(frame)}
    finally:
        sys.setswitchinterval(usual)


@cache
def _cached(module: ModuleType) -> Sequence[Any]:
    """Return the functions of a module with a cache; a function that the module imported is one of another module."""
    return [value for value in list(vars(module).values()) if hasattr(value, "cache_clear")]
