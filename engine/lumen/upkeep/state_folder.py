"""The folder for data that this user's programs keep between runs and that belongs to no project."""

import os
import tempfile
from pathlib import Path


def state_folder() -> Path:
    """Return Lumen's state folder among the user's own files (the XDG Base Directory Specification)."""
    given = os.environ.get("XDG_STATE_HOME") or os.environ.get("LOCALAPPDATA")
    try:
        return Path(given) / "lumen" if given else Path.home() / ".local" / "state" / "lumen"
    except RuntimeError:  # a user without a home
        return Path(tempfile.gettempdir()) / f"lumen-{os.getuid() if hasattr(os, 'getuid') else ''}"
