"""What lint worked out of each file of a project, kept for the next lint of it: most files are as they were.

It is what a process that lives on remembers (project/memoization.py), in the user's own cache, under a hash of where
the project lies, of the engine's own files and of Python; time zones and libraries have to be as they were. Each part
of it counts only for the very content that it was made of.
"""

import hashlib
import json
import pickle
from pathlib import Path

from lumen.project.engine_files import surroundings
from lumen.project.looks import Looks, unchanged
from lumen.project.memoization import begin, newly_made, packed, unpack
from lumen.upkeep.cache_folder import CacheFolder

MAX_KEPT = 8
"""Of how many projects it is kept: some MB each."""
MUCH = 0.2
"""The part that has to be new before it is kept anew, which takes as long as reading some files."""


def recall_memory(root: Path) -> None:
    """Remember what was kept of that project, where it holds."""
    content = CacheFolder("memory", MAX_KEPT).read(_name(root)) or b""
    looks, _, memory = content.partition(b"\n")
    begin()
    try:
        if unchanged(json.loads(looks)):
            unpack(memory)
    except Exception:  # whatever is in the file: it is worked out again
        return


def keep_memory(root: Path) -> None:
    """Keep what is remembered now, where much of it is new."""
    if newly_made() < MUCH:
        return
    looks = Looks()
    looks.around()
    try:
        content = json.dumps(looks.to_json()).encode() + b"\n" + packed()
    except (RecursionError, pickle.PicklingError):  # files that are nested deeper than can be packed
        return
    if looks.settled():
        CacheFolder("memory", MAX_KEPT).write(_name(root), content)


def _name(root: Path) -> str:
    return hashlib.sha256(surroundings(root).encode("utf-8", "surrogatepass")).hexdigest()
