"""Intermediate results of lint for each file of a project, kept for the next lint: most files do not change.

The results that a process has memoized (project/memoization.py) are saved in the user's cache under a hash of the
project's place, the engine's own files and Python; time zones and libraries must be the same. Each result is used only
for the exact content from which it was made.
"""

import hashlib
import json
import pickle
from pathlib import Path

from lumen.project.engine_files import surroundings
from lumen.project.looks import Looks, unchanged
from lumen.project.memoization import begin, newly_made, packed, unpack
from lumen.upkeep.own_folders import CacheFolder

MAX_KEPT = 8
"""The number of projects whose memory is stored, some MB each."""
MUCH = 0.2
"""The share of new results from which the memory is saved again; saving takes as long as reading some files."""


def recall_memory(root: Path) -> None:
    """Load the stored memory of a project, if it still holds."""
    content = CacheFolder("memory", MAX_KEPT).read(_name(root)) or b""
    looks, _, memory = content.partition(b"\n")
    begin()
    try:
        if unchanged(json.loads(looks)):
            unpack(memory)
    except Exception:  # the file may contain anything: then all results are computed again
        return


def keep_memory(root: Path) -> None:
    """Save the memory, if at least the share MUCH of its results is new."""
    if newly_made() < MUCH:
        return
    looks = Looks()
    looks.around()
    try:
        content = json.dumps(looks.to_json()).encode() + b"\n" + packed()
    except (RecursionError, pickle.PicklingError):  # some files are nested too deeply for pickle
        return
    if looks.settled():
        CacheFolder("memory", MAX_KEPT).write(_name(root), content)


def _name(root: Path) -> str:
    return hashlib.sha256(surroundings(root).encode("utf-8", "surrogatepass")).hexdigest()
