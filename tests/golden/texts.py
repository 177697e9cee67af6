"""Lines of text, JSON in one line, and numbers in a form that is the same on each machine."""

import json
import math
import re
from collections.abc import Iterable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

ARITHMETIC = "7c3ee1ac1387"
"""The arithmetic of the machine that recorded, as `arithmetic` returns it."""


def write(file: Path, lines: Iterable[str]) -> None:
    """Write lines into a file, whose folder is made if needed."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8", newline="\n")


def in_one_line(data: Any) -> str:
    """Return JSON data as a line, its keys in the order of the data."""
    return json.dumps(data, ensure_ascii=False, default=repr)


def rounded(value: float, digits: int) -> str:
    """Return a number with this many digits after the point, and never `-0`."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def digest(values: Iterable[str]) -> str:
    """Return a short hash of texts: it changes if one of them does."""
    return sha256("\n".join(values).encode()).hexdigest()[:12]


@cache
def arithmetic() -> str:
    """Return a fingerprint of this machine's exp, sin and numpy; their last bits differ between processors."""
    import numpy as np

    grid = [number / 64 - 8 for number in range(1024)]
    found = [f(value).hex() for f in (math.exp, math.sin, math.cos, math.tanh) for value in grid]
    found += [float(value).hex() for f in (np.exp, np.sin, np.tanh, np.cumsum) for value in f(np.array(grid))]
    found += [float(np.exp(np.array(grid[:count])).sum()).hex() for count in range(1, 1024)]
    return digest(found)


def snapped(lines: list[str], recorded: Path, tolerance: float, pattern: str) -> list[str]:
    """Return the lines, with the recorded number in place of each that is no farther from it than the tolerance.

    Another processor may compute another last bit. `pattern` matches a number; all other text must be equal.
    """
    before = recorded.read_text("utf-8").splitlines() if recorded.exists() else []
    if len(before) != len(lines):
        return lines
    return [_near(old, new, tolerance, pattern) for old, new in zip(before, lines, strict=True)]


def _near(old: str, new: str, tolerance: float, pattern: str) -> str:
    if old == new or re.sub(pattern, "", old) != re.sub(pattern, "", new):
        return new
    numbers = zip(re.findall(pattern, old), re.findall(pattern, new), strict=True)
    return old if all(abs(_number(one) - _number(other)) <= tolerance for one, other in numbers) else new


def _number(text: str) -> float:
    return float.fromhex(text) if "0x" in text else float(text)
