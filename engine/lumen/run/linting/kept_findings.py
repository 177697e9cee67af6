"""Earlier findings of lint, reused for files that are the same byte for byte, by the same engine.

They are in the user's cache, under a hash of the project's files, their place, the day (a passage's date may have
passed), the engine's own files and Python. A record of everything else that lint looked at is stored with them: sounds,
models, time zones, the imported libraries. If one of these differs now, the files are checked again; if one changed
just before lint looked at it, nothing is stored.
"""

import hashlib
import json
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lumen.language.diagnostics import Diagnostic, Place, Related, Severity
from lumen.project.engine_files import surroundings
from lumen.project.looks import Looks, unchanged
from lumen.upkeep.own_folders import CacheFolder

MAX_KEPT = 256
"""The number of sets of findings that are stored, a few kB each."""


def known_or_checked(root: Path, files: Mapping[str, bytes]) -> tuple[Diagnostic, ...]:
    """Return all findings in these files: the stored ones if they still hold, else those of a new check."""
    folder, name = CacheFolder("findings", MAX_KEPT), _name(root, files)
    known = _read(folder.read(name))
    if known is not None:
        return known
    from lumen.lint import check_files
    from lumen.run.linting.kept_memory import keep_memory, recall_memory

    recall_memory(root)
    looks = Looks()
    found = check_files(root, files, looks=looks)[1]
    looks.around()
    keep_memory(root)
    if looks.settled() and name == _name(root, files):
        kept = {"looks": looks.to_json(), "findings": [_plain(d) for d in found]}
        folder.write(name, json.dumps(kept).encode())
    return found


def _name(root: Path, files: Mapping[str, bytes]) -> str:
    """Return the name of the cache entry: a hash of the files, the date, and the machine's and engine's properties."""
    about = f"{time.strftime('%Y-%m-%d')} {surroundings(root)}"
    digest = hashlib.sha256(about.encode("utf-8", "surrogatepass"))
    for path, content in sorted(files.items()):
        digest.update(repr((path, type(content).__name__, len(content))).encode("utf-8", "surrogatepass") + content)
    return digest.hexdigest()


def _plain(found: Diagnostic) -> list[Any]:
    related = [[list(each.place), each.message] for each in found.related]
    return [str(found.code), found.message, list(found.place), found.hint, found.severity.value, related]


def _read(content: bytes | None) -> tuple[Diagnostic, ...] | None:
    """Return the stored findings; None if there are none, or if they no longer hold."""
    try:
        kept = json.loads(content or b"null")
        if not unchanged(kept["looks"]):
            return None
        return tuple(
            Diagnostic(
                code, message, Place(*place), hint, Severity(severity), tuple(Related(Place(*p), m) for p, m in related)
            )
            for code, message, place, hint, severity, related in kept["findings"]
        )
    except (ValueError, KeyError, TypeError, AttributeError):  # the file may contain anything: lint checks again
        return None
