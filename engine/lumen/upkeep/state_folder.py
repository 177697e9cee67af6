"""Where this user's programs keep what they need from run to run and what belongs to no project."""

import os
import tempfile
from pathlib import Path


def state_folder() -> Path:
    """Lumen's folder among the user's own files (the XDG Base Directory Specification)."""
    given = os.environ.get("XDG_STATE_HOME") or os.environ.get("LOCALAPPDATA")
    try:
        return Path(given) / "lumen" if given else Path.home() / ".local" / "state" / "lumen"
    except RuntimeError:  # a user without a home
        return Path(tempfile.gettempdir()) / f"lumen-{os.getuid() if hasattr(os, 'getuid') else ''}"
