"""The skills of a project from their manifests: what they are for, who performs them, and their arguments."""

import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from lumen.project.files import read_files
from lumen.project.yaml_reader import parse
from lumen.run.one_robot import one_robot
from lumen.run.replaying.journals import KeptBundles

_MANIFEST = re.compile(r"skills/[^/]+\.yaml")


def skills_of(root: Path, robot: str, hash: str) -> dict[str, Any]:
    """Return the skills of the bundle `hash`, or of the saved files if that bundle was not kept, sorted by name.

    Texts that a manifest has by language are maps from the language to the text.
    """
    robot = one_robot(root, robot)
    files = KeptBundles(root, robot).files(hash) or read_files(root, robot)
    names = sorted(filter(_MANIFEST.fullmatch, files))
    return {"skills": [one for file in names if (one := _skill(file, files[file]))]}


def _skill(file: str, content: bytes) -> dict[str, Any] | None:
    """Return a skill as JSON data, None if its manifest can't be read."""
    document, _ = parse(file, content)
    data = document.data if document else None
    if not isinstance(data, Mapping):
        return None
    by, schema = data.get("performed-by"), data.get("in")
    schema = schema if isinstance(schema, Mapping) else {}
    kind, target = next(iter(by.items())) if isinstance(by, Mapping) and by else ("", "")
    properties = schema.get("properties")
    return {
        "name": PurePosixPath(file).stem,
        "file": file,
        "description": data.get("description", ""),
        "kind": str(kind),
        "target": " ".join(map(str, target)) if isinstance(target, list) else str(target),
        "arguments": properties if isinstance(properties, Mapping) else {},
        "required": [name for name in schema.get("required") or () if isinstance(name, str)],
    }
